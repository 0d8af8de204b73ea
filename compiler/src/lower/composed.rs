//! Explicit Runge-Kutta schemes, composed: their whole step becomes one function, which explicit
//! Euler then takes.
//!
//! ```text
//! K_j = F(tau + c_j h, x + h sum_{i<j} a_ji K_i, u),     x_{k+1} = x_k + h sum_j b_j K_j
//! ```
//!
//! The integrand of the objective takes the same stages. Derivatives of the step come from the
//! graph like all others, so no stage is an unknown of the nonlinear program.

use crate::expressions::graph::{ExprId, Graph};
use fdcc_runtime::problem::{Layout, Method, Scheme};
use std::collections::HashMap;

/// A scheme with explicit stages: `c_j`, row `j` of `a`, and `b`.
struct Tableau {
    times: &'static [f64],
    stages: &'static [&'static [f64]],
    weights: &'static [f64],
}

/// W. Kutta 1901, "the" Runge-Kutta scheme, of order 4.
const CLASSICAL: Tableau = Tableau {
    times: &[0.0, 0.5, 0.5, 1.0],
    stages: &[&[], &[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]],
    weights: &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0],
};

fn tableau(scheme: Scheme) -> Option<&'static Tableau> {
    match scheme {
        Scheme::RungeKutta4 => Some(&CLASSICAL),
        _ => None,
    }
}

/// The right sides `F` over normalised time, states first, as the increments of a step of the
/// scheme.
pub(super) fn compose(
    graph: &mut Graph,
    method: &Method,
    layout: &Layout,
    rates: Vec<ExprId>,
) -> Vec<ExprId> {
    let Some(tableau) = tableau(method.scheme) else { return rates };
    let h = 1.0 / (method.intervals() * method.steps) as f64;
    let mut stages: Vec<Vec<ExprId>> = Vec::new();
    for (row, time) in tableau.stages.iter().zip(tableau.times) {
        let point = moved(graph, layout, h, *time, row, &stages);
        stages.push(graph.substitute(&rates, &|input| point.get(&input).copied()));
    }
    (0..rates.len()).map(|output| combination(graph, tableau.weights, &stages, output)).collect()
}

/// Time and states of a stage, for the inputs that they replace.
fn moved(
    graph: &mut Graph,
    layout: &Layout,
    h: f64,
    time: f64,
    row: &[f64],
    stages: &[Vec<ExprId>],
) -> HashMap<u32, ExprId> {
    let (now, later) = (graph.input(0), graph.number(time * h));
    let mut point = HashMap::from([(0, graph.add(now, later))]);
    for (state, place) in layout.states().enumerate() {
        let way = combination(graph, row, stages, state);
        let (here, way) = (graph.input(place as u32), graph.scale(h, way));
        point.insert(place as u32, graph.add(here, way));
    }
    point
}

/// A sum of one output over the stages.
fn combination(
    graph: &mut Graph,
    weights: &[f64],
    stages: &[Vec<ExprId>],
    output: usize,
) -> ExprId {
    let terms: Vec<ExprId> = weights
        .iter()
        .zip(stages)
        .map(|(weight, stage)| graph.scale(*weight, stage[output]))
        .collect();
    graph.sum(&terms)
}
