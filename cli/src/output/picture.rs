//! What a picture of a solution needs besides its numbers: the units in which people see them, the
//! bounds, and the text that was solved.

use super::named::Named;
use super::units::{Shown, Units};
use fdcc::Solution;
use fdcc_runtime::problem::{Bounds, Columns, Problem, Variable};
use fdcc_runtime::solution::{Outcome, Trajectory};
use serde::Serialize;

/// What a path condition bounds, and by what.
#[derive(Clone, Debug, Serialize)]
pub struct PathCondition {
    bounds: [f64; 2],
    /// One for each grid point, with the control before it; none at the first.
    values: Vec<f64>,
}

/// Values just before a time.
#[derive(Clone, Debug, Serialize)]
pub struct Before {
    time: f64,
    values: Named<f64>,
}

/// A part of the document of a solve.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Picture {
    /// The unit that the model declares for each name, and how many of SI it is; absent where the
    /// model has none.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub display_units: Named<Shown>,
    /// Lower and upper bound of each state and control that has one.
    pub bounds: Named<[f64; 2]>,
    /// The value of each path condition, and its lower and upper bound.
    #[serde(skip_serializing_if = "Named::is_empty")]
    pub path: Named<PathCondition>,
    /// The costates just before each jump and each switch that was located; the grid has those
    /// after them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub costates_before: Vec<Before>,
    /// The text of the model.
    pub source: String,
}

impl Picture {
    /// That of a solution.
    pub fn new(found: &Solution, units: &Units) -> Self {
        let problem = &found.problem;
        let shown = problem.states.iter().filter(|state| !state.hidden);
        Picture {
            display_units: units.shown(),
            bounds: shown.chain(&problem.controls).filter_map(bounds).collect(),
            path: path(found),
            costates_before: costates_before(found),
            source: found.model().source().text.to_string(),
        }
    }
}

fn bounds(variable: &Variable) -> Option<(String, [f64; 2])> {
    let is_bounded = variable.bounds.lower.is_finite() || variable.bounds.upper.is_finite();
    is_bounded.then(|| (variable.name.clone(), pair(&variable.bounds)))
}

fn pair(bounds: &Bounds) -> [f64; 2] {
    [bounds.lower, bounds.upper]
}

/// The path conditions at the grid points after the first, each with the control before it.
fn path(found: &Solution) -> Named<PathCondition> {
    let (problem, trajectory) = (&found.problem, &found.outcome.trajectory);
    let (path, time) = (&*problem.path, &trajectory.time);
    // What phases share has none, and the functions of one of them.
    if problem.path_bounds.is_empty() {
        return Named::default();
    }
    let [Some(first), Some(last)] = [time.first(), time.last()] else { return Named::default() };
    let mut inputs = Columns::new(path.layout().point_inputs(), time.len() - 1);
    for (tau, time) in inputs.column_mut(0).iter_mut().zip(&time[1..]) {
        *tau = (time - first) / (last - first);
    }
    for (at, column) in trajectory.states.iter().take(problem.layout.x).enumerate() {
        inputs.column_mut(1 + at).copy_from_slice(&column[1..]);
    }
    for (at, column) in trajectory.controls.iter().enumerate() {
        inputs.column_mut(1 + problem.layout.x + at).copy_from_slice(column);
    }
    let mut values = Columns::new(path.outputs(), time.len() - 1);
    path.value(&inputs, &trajectory.parameters, &mut values);
    let condition = |(row, bounds): (usize, &Bounds)| {
        let values = std::iter::once(f64::NAN).chain(values.column(row).iter().copied()).collect();
        (path.origin(row).label.to_string(), PathCondition { bounds: pair(bounds), values })
    };
    problem.path_bounds.iter().enumerate().map(condition).collect()
}

/// The last costates of each piece of time but the last.
fn costates_before(found: &Solution) -> Vec<Before> {
    let Some(between) = &found.between_jumps else { return Vec::new() };
    let is_shown = |name: &str| found.problem.states.iter().any(|it| it.name == name && !it.hidden);
    let pieces = between.chain.phases.iter().zip(&between.outcome.phases);
    let before = |(piece, outcome): (&Problem, &Outcome)| {
        let Trajectory { time, costates, .. } = &outcome.trajectory;
        let values = piece.states.iter().zip(costates).filter(|(state, _)| is_shown(&state.name));
        let last =
            |(state, column): (&Variable, &Vec<f64>)| Some((state.name.clone(), *column.last()?));
        Some(Before { time: *time.last()?, values: values.filter_map(last).collect() })
    };
    let count = between.outcome.phases.len().saturating_sub(1);
    pieces.take(count).filter_map(before).collect()
}
