//! The conditions of a problem along a replay: bounds and path conditions between the grid points, too, and the ends.

use crate::output::saved::Saved;
use crate::verification::Points;
use fdcc_runtime::problem::{Bounds, Columns, Function, Problem};
use fdcc_runtime::simulate::{Simulation, System};

/// Narrower than anything that matters: `abs`, `min` and `max` in a condition are those of the true system.
const NO_WIDTH: f64 = 1e-12;

/// By how much a condition is violated at worst.
#[derive(Clone)]
pub struct Condition {
    pub label: String,
    pub violation: f64,
    /// Which of the points it is; nothing for a condition on the ends.
    pub point: Option<usize>,
}

/// The conditions of a problem along a replay.
pub struct Conditions<'a> {
    problem: &'a Problem,
    points: &'a Points,
    simulation: &'a Simulation,
    /// The replayed states in the order of the problem.
    states: Vec<&'a [f64]>,
    parameters: Vec<f64>,
}

impl<'a> Conditions<'a> {
    /// The integrals of a problem are found by their name.
    pub fn new(
        problem: &'a Problem,
        saved: &Saved,
        system: &System,
        simulation: &'a Simulation,
        points: &'a Points,
    ) -> Option<Self> {
        let column = |name: &str| system.states.iter().position(|state| state.name == name);
        let states = problem.states.iter().map(|it| Some(simulation.states[column(&it.name)?].as_slice()));
        let value = |name: &str| {
            let values = [&saved.params, &saved.free];
            values.iter().find_map(|it| it.get(name).copied().flatten())
        };
        let parameters = problem.parameters.iter().map(|it| value(&it.name).unwrap_or(it.value));
        let mut parameters: Vec<f64> = parameters.collect();
        let chosen = problem.parameters.iter().position(|it| it.name.starts_with("sigma("));
        parameters.iter_mut().skip(chosen.unwrap_or(usize::MAX)).for_each(|width| *width = NO_WIDTH);
        Some(Conditions { problem, points, simulation, states: states.collect::<Option<_>>()?, parameters })
    }

    /// Bounds that are violated, all path conditions, and the ends if the replay came so far.
    pub fn all(&self, is_whole: bool) -> Vec<Condition> {
        let mut all: Vec<Condition> = self.bounds().filter(|it| it.violation > 0.0).collect();
        all.extend(self.path());
        if is_whole {
            all.extend(self.at_ends());
        }
        merged(all)
    }

    fn bounds(&self) -> impl Iterator<Item = Condition> {
        let states = self.problem.states.iter().zip(&self.states);
        states.map(|(state, column)| over_time(&state.name, state.bounds, &column[1.min(column.len())..]))
    }

    /// After the start, as a transcription has it.
    fn path(&self) -> impl Iterator<Item = Condition> {
        let (path, last) = (&*self.problem.path, self.points.times.len() - 1);
        let count = self.states.first().map_or(last, |column| column.len().saturating_sub(1));
        let mut inputs = Columns::new(path.layout().point_inputs(), count);
        let (first, length) = (self.points.times[0], self.points.times[last] - self.points.times[0]);
        for k in 0..count {
            inputs.column_mut(0)[k] = (self.points.times[k + 1] - first) / length;
            for (at, value) in self.points.row(k + 1).iter().enumerate() {
                inputs.column_mut(1 + self.states.len() + at)[k] = *value;
            }
        }
        for (at, column) in self.states.iter().enumerate() {
            inputs.column_mut(1 + at).copy_from_slice(&column[1..=count]);
        }
        let values = evaluated(path, &inputs, &self.parameters);
        let rows = self.problem.path_bounds.iter().enumerate();
        rows.map(move |(row, bounds)| {
            let at_points = over_time(&path.origin(row).label, *bounds, values.column(row));
            self.between(row, *bounds, at_points)
        })
    }

    /// The worst of a path condition between the points, too, where it is worse than at all of them.
    fn between(&self, row: usize, bounds: Bounds, at_points: Condition) -> Condition {
        let extremes = self.simulation.extremes.get(row).into_iter().flatten();
        let after_start = extremes.filter(|it| it.time > self.points.times[0]);
        let worst =
            after_start.max_by(|a, b| bounds.violation(a.value).total_cmp(&bounds.violation(b.value)));
        match worst.filter(|it| bounds.violation(it.value) > at_points.violation) {
            Some(worst) => {
                let point = self.points.times.partition_point(|time| *time < worst.time);
                let last = self.points.times.len() - 1;
                let violation = bounds.violation(worst.value);
                Condition { violation, point: Some(point.min(last)), ..at_points }
            }
            None => at_points,
        }
    }

    fn at_ends(&self) -> impl Iterator<Item = Condition> {
        let boundary = &*self.problem.boundary;
        let mut inputs = Columns::new(boundary.layout().point_inputs(), 1);
        for (at, column) in self.states.iter().enumerate() {
            inputs.column_mut(at)[0] = column[0];
            inputs.column_mut(self.states.len() + at)[0] = column[column.len() - 1];
        }
        let values = evaluated(boundary, &inputs, &self.parameters);
        let rows = self.problem.boundary_bounds.iter().enumerate();
        rows.map(move |(row, bounds)| Condition {
            label: boundary.origin(row + 1).label.to_string(),
            violation: bounds.violation(values.column(row + 1)[0]),
            point: None,
        })
    }
}

/// The worst of the points after the start.
fn over_time(label: &str, bounds: Bounds, values: &[f64]) -> Condition {
    let mut worst = Condition { label: label.into(), violation: 0.0, point: None };
    for (k, value) in values.iter().enumerate() {
        let violation = bounds.violation(*value);
        if violation > worst.violation {
            worst = Condition { violation, point: Some(k + 1), ..worst };
        }
    }
    worst
}

/// The rows of one condition as one, at the place of the first.
fn merged(all: Vec<Condition>) -> Vec<Condition> {
    let mut merged: Vec<Condition> = Vec::new();
    for condition in all {
        match merged.iter_mut().find(|it| it.label == condition.label) {
            Some(known) if known.violation < condition.violation => *known = condition,
            Some(_) => {}
            None => merged.push(condition),
        }
    }
    merged
}

fn evaluated(function: &dyn Function, points: &Columns, parameters: &[f64]) -> Columns {
    let mut values = Columns::new(function.outputs(), points.count());
    function.value(points, parameters, &mut values);
    values
}
