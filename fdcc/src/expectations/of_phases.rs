//! Expectations of a model with phases: over the ends of all phases, their integrals and sums.

use super::{Expectation, Expected, sides};
use crate::solve::Solution;
use fdcc_compiler::chain_expectations;
use fdcc_runtime::problem::{Columns, Function};
use fdcc_runtime::solution::{integrals, sums_over_rows};
use std::sync::Arc;

pub(super) fn evaluate(solution: &Solution) -> Vec<Expectation> {
    let expectations = chain_expectations(solution.model().meaning());
    let inputs: Vec<f64> = solution.phases().iter().flat_map(ends).collect();
    let shared = solution.problem.parameters.len();
    let mut parameters = solution.outcome.trajectory.parameters[..shared].to_vec();
    let totals = expectations.integrands.iter().zip(&expectations.sums);
    for (phase, (integrands, sums)) in solution.phases().iter().zip(totals) {
        parameters.extend(integrals_of(phase, integrands));
        let known = &phase.outcome.trajectory.parameters;
        parameters.extend(sums_over_rows(&phase.problem, &phase.outcome.solution, known, sums));
    }
    let mut values = Columns::new(expectations.function.outputs(), 1);
    expectations.function.value(&Columns::of_point(&inputs), &parameters, &mut values);
    let checked = |(at, expected): (usize, &fdcc_compiler::Expected)| Expectation {
        origin: expected.origin.clone(),
        outcome: Expected::Compared(sides(expected, at, &values)),
    };
    expectations.list.iter().enumerate().map(checked).collect()
}

/// States and controls at the start of a phase, then at its end; hidden states left out.
fn ends(phase: &Solution) -> Vec<f64> {
    let trajectory = &phase.outcome.trajectory;
    let states = trajectory.states.iter().zip(&phase.problem.states);
    let shown: Vec<&Vec<f64>> =
        states.filter(|(_, state)| !state.hidden).map(|(column, _)| column).collect();
    let all = || shown.iter().copied().chain(&trajectory.controls);
    let first = all().map(|column| column[0]);
    first.chain(all().map(|column| column[column.len() - 1])).collect()
}

fn integrals_of(phase: &Solution, integrands: &Arc<dyn Function>) -> Vec<f64> {
    let parameters = &phase.outcome.trajectory.parameters;
    integrals(&phase.problem, &phase.outcome.solution, parameters, &**integrands)
}
