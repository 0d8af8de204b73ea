//! What is said where a solve failed because the function of a smoothed surface has to be 0 at the
//! end: friction alone brings it near, and never there.

use crate::output::units::Units;
use crate::solved::Solved;
use fdcc::Solution;
use fdcc_runtime::nlp::Status;
use fdcc_runtime::problem::{Bounds, Columns, Problem};
use fdcc_runtime::solution::Trajectory;

/// Only a condition makes the function of a surface this small, relative to its layer.
const NOTHING: f64 = 1e-4;
/// What is proposed instead of 0.
const ENOUGH: f64 = 0.01;

/// One line for each surface that has to be 0 at the end.
pub(super) fn lines(solved: &Solved) -> Vec<String> {
    match solved.solution.phases() {
        [] => of(&solved.solution, &solved.document.units),
        phases => phases.iter().flat_map(|phase| of(phase, &solved.document.units)).collect(),
    }
}

fn of(solution: &Solution, units: &Units) -> Vec<String> {
    let (problem, outcome) = (&solution.problem, &solution.outcome);
    let is_lost = matches!(
        outcome.solution.status,
        Status::NumericalFailure | Status::IterationLimit | Status::Infeasible
    );
    // What is met to rounding does not stand in the way.
    let is_open = is_lost && outcome.solution.constraint_violation > problem.method.tol;
    let Some(ends) = is_open.then(|| misses(problem, &outcome.trajectory)) else {
        return Vec::new();
    };
    // What stands against the equations most may be another condition: then that is in the way.
    let limiting = outcome.limiting.as_ref().and_then(|it| it.condition.as_ref());
    let is_in_the_way = |row: usize| limiting.is_none_or(|it| *it == problem.boundary.origin(row));
    let surfaces = problem.surfaces.iter().zip(&outcome.trajectory.switching).zip(&outcome.sigma);
    let asked = surfaces.filter(|((_, psi), sigma)| {
        let last = psi.last().map_or(0.0, |value| value.abs());
        last > 0.0
            && last <= NOTHING * **sigma
            && ends
                .iter()
                .any(|(row, miss)| (miss - last).abs() <= 1e-6 * last && is_in_the_way(*row))
    });
    asked.map(|((surface, _), sigma)| line(&surface.name, *sigma, units)).collect()
}

fn line(name: &str, sigma: f64, units: &Units) -> String {
    // As it is written, with the unit in brackets.
    let enough = units.width(name, ENOUGH * sigma);
    let enough = match enough.split_once(' ') {
        Some((number, unit)) => format!("{number} [{unit}]"),
        None => enough,
    };
    format!(
        " rest  `{name}` has to be 0 at the end, but while it is smoothed friction brings it near \
         and never there: write `end abs({name}) <= {}` instead",
        enough
    )
}

/// The outputs of the boundary that are equations, each with how much it is missed by.
fn misses(problem: &Problem, trajectory: &Trajectory) -> Vec<(usize, f64)> {
    let states = &trajectory.states;
    let mut points = Columns::new(2 * states.len(), 1);
    let ends = states
        .iter()
        .map(|state| state[0])
        .chain(states.iter().map(|state| state[state.len() - 1]));
    ends.enumerate().for_each(|(i, value)| points.column_mut(i)[0] = value);
    let mut values = Columns::new(problem.boundary.outputs(), 1);
    problem.boundary.value(&points, &trajectory.parameters, &mut values);
    let rows =
        problem.boundary_bounds.iter().enumerate().filter(|(_, bounds)| bounds.is_equality());
    let miss = |row: usize, bounds: &Bounds| (values.column(row)[0] - bounds.lower).abs();
    rows.map(|(row, bounds)| (row + 1, miss(row + 1, bounds))).collect()
}
