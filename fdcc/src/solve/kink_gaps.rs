//! By how much what stands for kinks is larger than it has to be, and what that costs.

use super::Solution;
use super::shown::path_conditions;
use super::tuning::kinks::{LEAST, LOOSE, NOTHING, PRICE, ROUNDING, TIGHT};
use fdcc_compiler::is_kink;
use fdcc_runtime::problem::{Columns, Problem, Variable};
use fdcc_runtime::solution::Trajectory;

/// An unknown that stands for a kink, with the other of its conditions; over time their integrals.
struct Gap {
    /// The lesser of `q` and `q + e`.
    least: f64,
    /// The larger of both.
    largest: f64,
    /// `e^2`, and more than nothing.
    square: f64,
    /// The part of the larger that the lesser may be.
    limit: f64,
    /// What is nothing, beside rounding.
    nothing: f64,
}

impl Gap {
    /// For a time of this `duration`. On a kink throughout both conditions are 0, and no price is
    /// high.
    fn new(limit: f64, (unit, duration): (f64, f64)) -> Self {
        let (square, nothing) = ((LEAST * unit).powi(2) * duration, ROUNDING * unit * duration);
        Gap { least: 0.0, largest: 0.0, square, limit, nothing }
    }

    fn add(&mut self, q: f64, row: f64, duration: f64) {
        self.least += q.min(row).max(0.0) * duration;
        self.largest += q.abs().max(row.abs()) * duration;
        self.square += (row - q).powi(2) * duration;
    }

    fn is_none(&self) -> bool {
        self.least <= (self.limit * self.largest).max(self.nothing)
    }
}

/// Those of all phases.
fn gaps(found: &Solution) -> Vec<Gap> {
    let gaps = |it: &Solution| gaps_of(&it.problem, &it.outcome.trajectory);
    pieces(found).iter().flat_map(gaps).collect()
}

fn gaps_of(problem: &Problem, trajectory: &Trajectory) -> Vec<Gap> {
    let rows = path_conditions(problem, trajectory);
    let limit = if trajectory.nodes.is_some() { LOOSE } else { TIGHT };
    let gap = |(control, unknown): (&Variable, &Vec<f64>)| {
        let row = rows.iter().find(|it| is_kink(&it.name) && it.name == control.name)?;
        let time = &trajectory.time;
        let mut gap = Gap::new(limit, (control.unit, time[time.len() - 1] - time[0]));
        for ((q, row), pair) in unknown.iter().zip(&row.values[1..]).zip(time.windows(2)) {
            gap.add(*q, *row, pair[1] - pair[0]);
        }
        Some(gap)
    };
    let along = problem.controls.iter().zip(&trajectory.controls).filter_map(gap);
    along.chain(gaps_of_ends(problem, trajectory)).collect()
}

fn gaps_of_ends(problem: &Problem, trajectory: &Trajectory) -> Vec<Gap> {
    let unknowns = problem.unknowns.iter().map(|it| it.parameter);
    let unknowns = unknowns.filter(|at| is_kink(&problem.parameters[*at].name));
    let unknowns: Vec<usize> = unknowns.collect();
    if unknowns.is_empty() {
        return Vec::new();
    }
    let boundary = &*problem.boundary;
    let (layout, count) = (boundary.layout(), boundary.layout().x / 2);
    let mut ends = Columns::new(layout.point_inputs(), 1);
    for (at, column) in trajectory.states.iter().take(count).enumerate() {
        let first = layout.states().start + at;
        ends.column_mut(first)[0] = column[0];
        ends.column_mut(first + count)[0] = column[column.len() - 1];
    }
    let mut values = Columns::new(boundary.outputs(), 1);
    boundary.value(&ends, &trajectory.parameters, &mut values);
    let gap = |at: usize| {
        let parameter = &problem.parameters[at];
        let row =
            (1..boundary.outputs()).find(|row| *boundary.origin(*row).label == *parameter.name)?;
        let mut gap = Gap::new(TIGHT, (parameter.unit, 1.0));
        gap.add(trajectory.parameters[at], values.column(row)[0], 1.0);
        Some(gap)
    };
    unknowns.into_iter().filter_map(gap).collect()
}

/// Whether one of the two conditions on each unknown that stands for a kink is an equality: at all
/// times, or on average where controls are known by their means on intervals only.
pub(super) fn is_tight(problem: &Problem, trajectory: &Trajectory) -> bool {
    gaps_of(problem, trajectory).iter().all(Gap::is_none)
}

/// Whether that is so in all phases.
pub(super) fn are_tight(found: &Solution) -> bool {
    gaps(found).iter().all(Gap::is_none)
}

/// So high that what an answer gains by gaps counts little beside what they cost.
pub(super) fn first_price(found: &Solution) -> f64 {
    let size = size_of_objective(found);
    let size = if size > NOTHING { size } else { 1.0 };
    let squares = gaps(found).iter().map(|it| it.square).sum::<f64>();
    let price = PRICE * size / squares;
    if found.status().is_solved() && price.is_finite() { price } else { PRICE }
}

/// The size of the objective, or of what is integrated to it.
pub(super) fn size_of_objective(found: &Solution) -> f64 {
    let scale = |it: &Solution| {
        let time = it.time();
        it.outcome.trajectory.hamiltonian.scale * (time[time.len() - 1] - time[0])
    };
    pieces(found).iter().map(scale).fold(found.objective().abs(), f64::max)
}

/// The solutions of all phases; itself where there are none.
fn pieces(found: &Solution) -> &[Solution] {
    if found.parts.is_empty() { std::slice::from_ref(found) } else { &found.parts }
}
