//! Quantities that an answer shows to be far smaller than one of their declared units.
//!
//! What is smaller than a small part of its unit counts as nothing, so that rounding is not taken
//! for a value; an objective of such quantities counts as 0, and every point as its optimum. Where
//! an answer is as small as that, the problem is solved again with the magnitudes of the answer in
//! place of the units: what is rounding falls further, and what is a value stays.

use super::Solution;
use super::report::Options;
use super::tuning::magnitudes::{LEAST, MOST, NO_OBJECTIVE, NOTHING, ROUNDING};
use crate::error::Error;
use crate::model::Model;

/// The answer in its own magnitudes, where these are so small that nothing can be said of `found`,
/// and they are not rounding; else `found`.
pub(super) fn with_own_magnitudes(
    mut found: Solution,
    options: &Options,
) -> Result<Solution, Error> {
    for _ in 0..MOST {
        let Some(model) = smaller(&found) else { break };
        let next = model.compile()?.solve_once(options)?;
        // Where there are several sequences of jumps, one of them may fail in its own magnitudes.
        let is_better = !found.is_certified() || next.objective() <= found.objective();
        let is_nothing = is_better && next.is_certified() && next.objective().abs() < NO_OBJECTIVE;
        if !next.status().is_solved() || !(is_value(&found, &next) || is_nothing) {
            break;
        }
        found = next;
    }
    Ok(found)
}

/// Whether the objective is about as large in other magnitudes.
fn is_value(found: &Solution, next: &Solution) -> bool {
    let factor = (next.objective() / found.objective()).abs();
    (1.0 / ROUNDING..ROUNDING).contains(&factor)
}

/// The model with the magnitudes of what is far smaller than its unit in an answer whose objective
/// counts as 0 and is not.
fn smaller(solution: &Solution) -> Option<Model> {
    let is_small = (f64::MIN_POSITIVE..NO_OBJECTIVE).contains(&solution.objective().abs());
    let (problem, trajectory) = (&solution.problem, &solution.outcome.trajectory);
    let states = problem.states.iter().zip(&trajectory.states);
    let controls = problem.controls.iter().zip(&trajectory.controls);
    let sized = states.chain(controls).filter(|(it, _)| !it.hidden).map(|(it, column)| {
        (it, column.iter().fold(0.0, |most: f64, value| most.max(value.abs())))
    });
    let small = sized.filter(|(it, size)| *size > 0.0 && *size < NOTHING * it.unit);
    let magnitudes: Vec<_> =
        small.map(|(it, size)| (it.name.clone(), size.max(LEAST * it.unit))).collect();
    let is_one = is_small && solution.status().is_solved() && !magnitudes.is_empty();
    is_one.then(|| solution.model().with_magnitudes(magnitudes))
}
