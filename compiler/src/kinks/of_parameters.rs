//! Kinks that parameters alone move, such as that of `max(a, 0)`: where the value of a parameter is
//! on one, an optimum has no derivative by it.

use super::Kink;
use super::bent::{is_bent, replaced};
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph, evaluate};
use crate::model::numbers::{Numbers, numbers};
use crate::model::{Model, Range, Symbol};
use std::collections::HashSet;

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
    let (tried, mut readers) = replaced(&mut graph, model.symbols.len(), &roots(model));
    // What is inside of another kink is read by that.
    readers.extend(tried.iter().map(|it| it.e));
    for it in &tried {
        let Some(kink) = Kink::of(&mut graph, it.original, it.original) else { continue };
        let Some(parameters) = parameters_of(model, &graph, kink.e) else { continue };
        let is_met = is_zero(&mut graph, kink.e, &numbers);
        if is_met && readers.iter().any(|root| is_bent(&mut graph, *root, it)) {
            found.extend(parameters);
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

/// The parameters that move a kink, with all that they are computed from; nothing where something
/// else moves it, too.
fn parameters_of(model: &Model, graph: &Graph, e: ExprId) -> Option<HashSet<usize>> {
    let parameter = |at: u32| match model.symbols[at as usize] {
        Symbol::Param(index) => Some(index),
        _ => None,
    };
    let mut open: Vec<usize> =
        graph.inputs_of(&[e]).into_iter().map(parameter).collect::<Option<_>>()?;
    let mut all = HashSet::new();
    while let Some(at) = open.pop() {
        if all.insert(at) {
            let value = Vec::from_iter(model.params[at].value);
            open.extend(model.graph.inputs_of(&value).into_iter().filter_map(parameter));
        }
    }
    Some(all)
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
