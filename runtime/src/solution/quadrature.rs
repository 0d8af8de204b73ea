//! Integrals along a solution, by the nodes and weights of its own scheme:
//!
//! ```text
//!     integral  =  h sum_k sum_j b_j L(node j of interval k)
//! ```
//!
//! So an `integral(...)` outside the objective has the value that it would have in the objective.

use crate::nlp::Solution;
use crate::problem::{Columns, Function, Measurements, Problem};
use crate::transcribe::TranscribedNlp;

/// Sums over rows of measured data along a solution.
pub fn sums_over_rows(
    problem: &Problem,
    solution: &Solution,
    parameters: &[f64],
    sums: &[Measurements],
) -> Vec<f64> {
    let nlp = TranscribedNlp::new(problem);
    sums.iter().map(|sum| nlp.sum_over_rows(sum, parameters, &solution.v)).collect()
}

/// The terms of such sums in the time of the problem, each with the number of its row.
pub fn terms_of_rows(
    problem: &Problem,
    solution: &Solution,
    parameters: &[f64],
    sums: &[&Measurements],
) -> Vec<Vec<(usize, f64)>> {
    let nlp = TranscribedNlp::new(problem);
    sums.iter().map(|sum| nlp.terms_of_rows(sum, parameters, &solution.v)).collect()
}

/// The integrals over normalised time of all outputs of a function of `[tau | x | u | p]`.
pub fn integrals(
    problem: &Problem,
    solution: &Solution,
    parameters: &[f64],
    integrands: &dyn Function,
) -> Vec<f64> {
    let nlp = TranscribedNlp::new(problem);
    let stages = nlp.chain();
    let mut sums = vec![0.0; integrands.outputs()];
    for node in &nlp.interval().nodes {
        let mut points = Columns::new(integrands.layout().point_inputs(), stages.intervals);
        node.point.set_times(nlp.mesh(), &mut points);
        node.point.load(stages, integrands.layout(), &solution.v, &mut points);
        let mut values = Columns::new(integrands.outputs(), stages.intervals);
        integrands.value(&points, parameters, &mut values);
        for (output, sum) in sums.iter_mut().enumerate() {
            let terms = values.column(output).iter().enumerate();
            let sum_of_all = terms.map(|(k, value)| nlp.mesh().relative(k) * value).sum::<f64>();
            *sum += node.weight / stages.intervals as f64 * sum_of_all;
        }
    }
    sums
}
