//! The objective taken apart: `J = M(x(start), x(end), p) + sum_k c_k integral(e_k)`.
//!
//! Where `c_k` depends on parameters alone the integral is running cost, `sum_k c_k e_k`. Where an
//! integral enters otherwise, or stands in a condition, it becomes one more state `q' = e_k,
//! q(start) = 0`.

use super::boundary::is_fixed;
use super::origin;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Model, Symbol};
use fdcc_runtime::problem::Origin;

/// The parts of the objective of the minimisation problem.
pub(crate) struct Objective {
    /// `M`, with the integrals that became states.
    pub mayer: ExprId,
    /// The integrand of the running cost.
    pub running: Option<ExprId>,
    /// The integrals that became states.
    pub hidden: Vec<usize>,
    /// Where it stands.
    pub origin: Origin,
}

/// Takes the objective apart.
pub(crate) fn split(model: &Model, graph: &mut Graph) -> Objective {
    let zero = graph.number(0.0);
    let (origin, value) = match &model.objective {
        Some((place, value)) => (origin(place), graph.scale(model.sense, *value)),
        None => (Origin::default(), zero),
    };
    let rows: Vec<ExprId> = model.boundary.iter().map(|row| row.value).collect();
    let mut in_rows = integrals_in(model, graph, &rows);
    let linked = (0..model.integrals.len()).filter(|&at| model.integrals[at].is_linked);
    in_rows.extend(linked.filter(|at| !in_rows.contains(at)).collect::<Vec<_>>());
    let mut split = Objective { mayer: value, running: None, hidden: in_rows, origin };
    let mut running = Vec::new();
    for at in integrals_in(model, graph, &[value]) {
        let input = model.input_of(Symbol::Integral(at)).expect("it was found among the inputs");
        let factor = derivative(graph, value, input);
        if is_fixed(model, graph, factor) {
            running.push((input, graph.mul(factor, model.integrals[at].integrand)));
        } else if !split.hidden.contains(&at) {
            split.hidden.push(at);
        }
    }
    if !running.is_empty() {
        let terms: Vec<ExprId> = running.iter().map(|term| term.1).collect();
        split.running = Some(graph.sum(&terms));
        let without = |input: u32| running.iter().any(|term| term.0 == input).then_some(zero);
        split.mayer = graph.substitute(&[value], &without)[0];
    }
    split.hidden.sort_unstable();
    split
}

/// The integrals that some expressions read.
pub(crate) fn integrals_in(model: &Model, graph: &Graph, roots: &[ExprId]) -> Vec<usize> {
    let inputs = graph.inputs_of(roots);
    let integral = |input: u32| match model.symbols[input as usize] {
        Symbol::Integral(index) => Some(index),
        _ => None,
    };
    inputs.into_iter().filter_map(integral).collect()
}
