//! Kinks that are met because of the values of parameters alone, such as that of `max(a, 0)` or of
//! `max(a*x, 0)` at `a = 0`: an optimum has no derivative by these.

use super::Kink;
use super::bent::{is_bent, replaced};
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph, evaluate};
use crate::model::numbers::{Numbers, numbers};
use crate::model::{Model, Range, Symbol};
use std::collections::{HashMap, HashSet};

/// What is less than this part of its terms is 0.
const ROUNDING: f64 = 1e-14;

/// The parameters whose values are on a kink that they alone move, and that bends what an optimum
/// depends on, as indices into [`Model::params`]; those that these are computed from, too.
pub fn parameters_on_kinks(model: &Model) -> Vec<usize> {
    let phases = model.phases.iter().map(|it| &it.model);
    let mut found: Vec<usize> = phases.chain([model]).flat_map(of_one).collect();
    found.sort_unstable();
    found.dedup();
    found
}

fn of_one(model: &Model) -> HashSet<usize> {
    let mut found = HashSet::new();
    let Ok(numbers) = numbers(model) else { return found };
    let mut graph = model.graph.clone();
    let symbols = model.symbols.len();
    let (tried, mut readers) = replaced(&mut graph, symbols, &roots(model), Kink::or_knot);
    // What is inside of another kink is read by that.
    readers.extend(tried.iter().map(|it| it.e));
    for it in &tried {
        let Some(kink) = Kink::or_knot(&mut graph, it.original, it.original) else { continue };
        let parameters = parameters_of(model, &mut graph, kink.e, &numbers);
        if !parameters.is_empty() && readers.iter().any(|root| is_bent(&mut graph, *root, it)) {
            found.extend(with_sources(model, parameters));
        }
    }
    found
}

/// All that an optimum depends on.
fn roots(model: &Model) -> Vec<ExprId> {
    let both = |range: &Range| [range.lower, range.upper];
    let mut roots = super::roots(model);
    roots.extend(model.interval);
    roots.extend(model.params.iter().flat_map(|it| it.value));
    let links = model.links.iter();
    roots.extend(
        links.flat_map(|it| it.objective.into_iter().chain(it.rows.iter().map(|row| row.value))),
    );
    roots.extend(model.states.iter().flat_map(|it| it.start));
    roots.extend(model.states.iter().flat_map(|it| both(&it.range)));
    roots.extend(model.controls.iter().flat_map(|it| both(&it.range)));
    roots.extend(model.frees.iter().flat_map(|it| both(&it.range)));
    let rows = model.path.iter().chain(&model.boundary);
    roots.extend(rows.flat_map(|it| [it.value, it.range.lower, it.range.upper]));
    roots.extend(model.surfaces.iter().map(|it| it.psi));
    roots.extend(model.jumps.iter().flat_map(|it| it.resets.iter().map(|reset| reset.1)));
    roots
}

/// The parameters that move away from a kink, where their values alone are the reason that it is
/// met: `a*x` is 0 at any `x` where `a` is.
fn parameters_of(model: &Model, graph: &mut Graph, e: ExprId, numbers: &Numbers) -> Vec<usize> {
    let inputs: Vec<(u32, Option<usize>)> =
        graph.inputs_of(&[e]).into_iter().map(|at| (at, parameter(model, at))).collect();
    if inputs.iter().all(|it| it.1.is_some()) {
        let is_met = is_zero(graph, e, numbers);
        return inputs.into_iter().filter_map(|it| it.1.filter(|_| is_met)).collect();
    }
    let is_nothing = |graph: &mut Graph, e: ExprId| {
        let fixed: HashMap<u32, ExprId> = inputs
            .iter()
            .filter(|it| it.1.is_some())
            .map(|it| (it.0, graph.number(numbers.inputs()[it.0 as usize])))
            .collect();
        let value = graph.substitute(&[e], &|at| fixed.get(&at).copied())[0];
        graph.as_number(value) == Some(0.0)
    };
    if !is_nothing(graph, e) {
        return Vec::new();
    }
    let moves = |graph: &mut Graph, at: u32| {
        let slope = derivative(graph, e, at);
        !is_nothing(graph, slope)
    };
    let of_inputs = inputs.iter().filter_map(|&(at, of)| of.filter(|_| moves(graph, at)));
    of_inputs.collect()
}

fn parameter(model: &Model, input: u32) -> Option<usize> {
    match model.symbols[input as usize] {
        Symbol::Param(index) => Some(index),
        _ => None,
    }
}

/// Parameters with all that they are computed from.
fn with_sources(model: &Model, mut open: Vec<usize>) -> HashSet<usize> {
    let mut all = HashSet::new();
    while let Some(at) = open.pop() {
        if all.insert(at) {
            let value = Vec::from_iter(model.params[at].value);
            let inputs = model.graph.inputs_of(&value).into_iter();
            open.extend(inputs.filter_map(|input| parameter(model, input)));
        }
    }
    all
}

/// Whether an expression over parameters is 0 but for rounding.
fn is_zero(graph: &mut Graph, e: ExprId, numbers: &Numbers) -> bool {
    let inputs = graph.inputs_of(&[e]);
    let slopes: Vec<ExprId> = inputs.iter().map(|at| derivative(graph, e, *at)).collect();
    let values = evaluate(graph, &[&[e], &slopes[..]].concat(), numbers.inputs(), &[]);
    let term = |(at, slope): (&u32, &f64)| (slope * numbers.inputs()[*at as usize]).abs();
    let size: f64 = inputs.iter().zip(&values[1..]).map(term).sum();
    values[0].abs() <= ROUNDING * size
}
