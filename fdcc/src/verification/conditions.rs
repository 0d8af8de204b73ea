//! The conditions of a problem along a replay: bounds and path conditions between the grid points,
//! too, and the ends.
//!
//! A violation counts for the size of the terms of its condition there: what each input moves it by
//! ([`terms`]), and the bound.

use super::Points;
use super::motion::Motion;
use super::terms::{Terms, terms};
use crate::record::{Record, number};
use fdcc_runtime::problem::{Bounds, Columns, Function, Parameter, Problem, Variable};
use fdcc_runtime::simulate::{Simulation, System};

/// `abs`, `min` and `max` in a condition are those of the true system: as narrow as this part of
/// the width with which it was solved.
const NO_WIDTH: f64 = 1e-12;

/// By how much a condition is violated at worst.
///
/// ```
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// let solution = fdcc::Model::from_text("hop", text)?.solve(&fdcc::Options::default())?;
/// let replay = solution.verify()?;
/// assert!(replay.conditions[0].label.contains("x == 0.5") && replay.conditions[0].part < 1e-6);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone)]
pub struct Condition {
    /// Its text.
    pub label: String,
    /// In SI.
    pub violation: f64,
    /// The same as a part of the size of its terms.
    pub part: f64,
    /// Which of the points it is; nothing for a condition on the ends.
    pub point: Option<usize>,
}

/// The conditions of a problem along a replay.
pub(super) struct Conditions<'a> {
    problem: &'a Problem,
    points: &'a Points,
    simulation: &'a Simulation,
    /// The replayed states in the order of the problem.
    states: Vec<&'a [f64]>,
    motions: Vec<Motion>,
    parameters: Vec<f64>,
}

impl<'a> Conditions<'a> {
    /// The integrals of a problem are found by their name.
    pub fn new(
        problem: &'a Problem,
        record: &Record,
        system: &System,
        simulation: &'a Simulation,
        points: &'a Points,
    ) -> Option<Self> {
        let column = |name: &str| system.states.iter().position(|state| state.name == name);
        let states =
            problem.states.iter().map(|it| Some(simulation.states[column(&it.name)?].as_slice()));
        let states: Vec<&[f64]> = states.collect::<Option<_>>()?;
        let variables: Vec<&Variable> = problem.states.iter().collect();
        let motions = Motion::of_states(&variables, |at| states[at].to_vec());
        Some(Conditions {
            problem,
            points,
            simulation,
            states,
            motions,
            parameters: parameters(problem, record),
        })
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
        let states = self.problem.states.iter().zip(&self.states).zip(&self.motions);
        states.map(|((state, column), motion)| {
            let terms = |value: &f64| Terms {
                size: value.abs().max(motion.range),
                rounding: motion.rounding,
            };
            let values = column.iter().skip(1).map(|value| (*value, terms(value)));
            over_time(&state.name, state.bounds, values)
        })
    }

    /// After the start, as a transcription has it.
    fn path(&self) -> impl Iterator<Item = Condition> {
        let (path, last) = (&*self.problem.path, self.points.times.len() - 1);
        let count = self.states.first().map_or(last, |column| column.len().saturating_sub(1));
        let mut inputs = Columns::new(path.layout().point_inputs(), count);
        let (first, length) =
            (self.points.times[0], self.points.times[last] - self.points.times[0]);
        for k in 0..count {
            inputs.column_mut(0)[k] = (self.points.times[k + 1] - first) / length;
            for (at, value) in self.points.row(k + 1).iter().enumerate() {
                inputs.column_mut(1 + self.states.len() + at)[k] = *value;
            }
        }
        for (at, column) in self.states.iter().enumerate() {
            inputs.column_mut(1 + at).copy_from_slice(&column[1..=count]);
        }
        let controls = self.problem.controls.iter().map(|it| Motion::still(it.unit));
        let time = std::iter::once(Motion::default());
        let motions = time.chain(self.motions.iter().copied()).chain(controls).collect();
        let rows =
            self.evaluated(path, &inputs, motions).into_iter().zip(&self.problem.path_bounds);
        rows.enumerate().map(move |(row, (values, bounds))| {
            let at_points = over_time(&path.origin(row).label, *bounds, values.iter().copied());
            self.between(row, *bounds, &values, at_points)
        })
    }

    /// The worst of a path condition between the points, too, where it is worse than at all of
    /// them.
    fn between(
        &self,
        row: usize,
        bounds: Bounds,
        values: &[(f64, Terms)],
        at_points: Condition,
    ) -> Condition {
        let extremes = self.simulation.extremes.get(row).into_iter().flatten();
        let after_start = extremes.filter(|it| it.time > self.points.times[0]);
        let worst = after_start
            .max_by(|a, b| bounds.violation(a.value).total_cmp(&bounds.violation(b.value)));
        let Some(worst) = worst else { return at_points };
        let point = self.points.times.partition_point(|time| *time < worst.time);
        let point = point.min(self.points.times.len() - 1);
        let terms = values.get(point.saturating_sub(1)).map(|it| it.1);
        let (violation, part) =
            (bounds.violation(worst.value), terms.map_or(0.0, |it| it.part(worst.value, &bounds)));
        if (part, violation) > (at_points.part, at_points.violation) {
            return Condition { violation, part, point: Some(point), ..at_points };
        }
        at_points
    }

    fn at_ends(&self) -> impl Iterator<Item = Condition> {
        let boundary = &*self.problem.boundary;
        let mut inputs = Columns::new(boundary.layout().point_inputs(), 1);
        for (at, column) in self.states.iter().enumerate() {
            inputs.column_mut(at)[0] = column[0];
            inputs.column_mut(self.states.len() + at)[0] = column[column.len() - 1];
        }
        let rows = self.evaluated(boundary, &inputs, self.motions.repeat(2)).into_iter().skip(1);
        rows.zip(&self.problem.boundary_bounds).enumerate().map(move |(row, (values, bounds))| {
            Condition { point: None, ..over_time(&boundary.origin(row + 1).label, *bounds, values) }
        })
    }

    /// For each output its values at all points, with the terms of which they are sums.
    fn evaluated(
        &self,
        function: &dyn Function,
        points: &Columns,
        motions: Vec<Motion>,
    ) -> Vec<Vec<(f64, Terms)>> {
        let parameters = self.problem.parameters.iter().map(|it| Motion::still(it.unit));
        let motions: Vec<Motion> = motions.into_iter().chain(parameters).collect();
        terms(function, (points, &self.parameters), &motions)
    }
}

/// Those of the solution, with widths that smooth nothing.
fn parameters(problem: &Problem, record: &Record) -> Vec<f64> {
    let of_solution = |name: &str| {
        let all = [&record.params, &record.free];
        all.iter().find_map(|it| number(it, name))
    };
    let settings = &record.settings;
    let sigma = settings.sigma.filter(|sigma| sigma.is_finite());
    let width = |name: &str| number(&settings.sigmas, name).or(sigma);
    let value = |it: &Parameter| match it
        .name
        .strip_prefix("sigma(")
        .and_then(|name| name.strip_suffix(')'))
    {
        Some(surface) => NO_WIDTH * width(surface).unwrap_or(it.value),
        None => of_solution(&it.name).unwrap_or(it.value),
    };
    problem.parameters.iter().map(value).collect()
}

/// The worst of the points after the start.
fn over_time(
    label: &str,
    bounds: Bounds,
    values: impl IntoIterator<Item = (f64, Terms)>,
) -> Condition {
    let mut worst = Condition { label: label.into(), violation: 0.0, part: 0.0, point: None };
    for (k, (value, terms)) in values.into_iter().enumerate() {
        let violation = bounds.violation(value);
        let part = terms.part(value, &bounds);
        if (part, violation) > (worst.part, worst.violation) {
            worst = Condition { violation, part, point: Some(k + 1), ..worst };
        }
    }
    worst
}

/// The rows of one condition as one, at the place of the first.
fn merged(all: Vec<Condition>) -> Vec<Condition> {
    let mut merged: Vec<Condition> = Vec::new();
    for condition in all {
        match merged.iter_mut().find(|it| it.label == condition.label) {
            Some(known) if known.part < condition.part => *known = condition,
            Some(_) => {}
            None => merged.push(condition),
        }
    }
    merged
}
