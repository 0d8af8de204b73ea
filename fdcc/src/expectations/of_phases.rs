//! Expectations of a model with phases: over the ends of all phases, their integrals and sums.

use super::{Expectation, Expected, of_phase, sides};
use crate::solve::{Phases, Solution};
use fdcc_compiler::{chain_expectations, integrands};
use fdcc_runtime::problem::Columns;
use fdcc_runtime::solution::sums_over_rows;

pub(super) fn evaluate(solution: &Solution) -> Vec<Expectation> {
    let expectations = chain_expectations(solution.model().meaning());
    let inputs: Vec<f64> = solution.phases().iter().flat_map(ends).collect();
    let shared = solution.problem.parameters.len();
    let mut parameters = solution.outcome.trajectory.parameters[..shared].to_vec();
    for (phase, sums) in solution.phases().iter().zip(&expectations.sums) {
        parameters.extend(integrals_of(phase));
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

/// Its integrals; of one whose switches were located, over all that it was divided into.
fn integrals_of(phase: &Solution) -> Vec<f64> {
    let Some(Phases { model, chain, outcome }) = &phase.between_jumps else {
        let integrands = integrands(phase.model().meaning());
        return of_phase(&phase.problem, &phase.outcome, &*integrands);
    };
    let own = model.phases.iter().zip(&chain.phases).zip(&outcome.phases);
    let own = own
        .map(|((phase, problem), outcome)| of_phase(problem, outcome, &*integrands(&phase.model)));
    let add = |sum: Vec<f64>, more: Vec<f64>| sum.iter().zip(more).map(|(a, b)| a + b).collect();
    own.reduce(add).unwrap_or_default()
}
