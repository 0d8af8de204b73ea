//! The conditions of a problem along a replay: bounds and path conditions between the grid points,
//! too, and the ends.
//!
//! A violation counts for the size of the terms of its condition there: what each input moves it by
//! ([`terms`]), and the bound.

use super::motion::Motion;
use super::points::Points;
use super::terms::{Inputs, Terms, terms};
use super::tuning::conditions::NO_WIDTH;
use crate::record::{Record, number};
use fdcc_runtime::problem::{Bounds, Columns, Function, Parameter, Problem, Variable};
use fdcc_runtime::simulate::{Event, EventKind, Extreme, Simulation, System};
use std::collections::HashMap;

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
    /// When it is; nothing for a condition on the ends, or one that holds.
    pub time: Option<f64>,
    /// The state of the system there, integrals last; the last one if there is no time.
    pub state: Vec<f64>,
}

/// The worst of a condition at the points.
struct Worst {
    violation: f64,
    part: f64,
    /// Nothing where none is violated.
    point: Option<usize>,
}

/// The conditions of a problem along a replay.
pub(super) struct Conditions<'a> {
    problem: &'a Problem,
    points: &'a Points<'a>,
    simulation: &'a Simulation,
    /// Where the states of the problem are among those of the system.
    columns: Vec<usize>,
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
        points: &'a Points<'a>,
    ) -> Option<Self> {
        let column = |it: &Variable| system.states.iter().position(|state| state.name == it.name);
        let columns: Vec<usize> = problem.states.iter().map(column).collect::<Option<_>>()?;
        let states = columns.iter().map(|at| simulation.states[*at].as_slice()).collect();
        let variables: Vec<&Variable> = problem.states.iter().collect();
        let motions = Motion::of_states(&variables, |at| simulation.states[columns[at]].clone());
        Some(Conditions {
            problem,
            points,
            simulation,
            columns,
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
            all.extend(self.ending_at(self.points.times.len() - 1, false));
        }
        merged(all)
    }

    fn bounds(&self) -> impl Iterator<Item = Condition> {
        let states = self.problem.states.iter().zip(&self.states).zip(&self.motions).enumerate();
        states.map(|(at, ((state, column), motion))| {
            let with_terms = |value: f64| {
                (value, Terms { size: value.abs().max(motion.range), rounding: motion.rounding })
            };
            let values = column.iter().skip(1).map(|value| with_terms(*value));
            let at_points = self.condition(&state.name, worst_of(state.bounds, values));
            self.beside_jumps(self.columns[at], state.bounds, &with_terms, at_points)
        })
    }

    /// The worst of a bound beside jumps, too, where it is worse than at all points: just before a
    /// jump and just behind it.
    fn beside_jumps(
        &self,
        column: usize,
        bounds: Bounds,
        with_terms: &dyn Fn(f64) -> (f64, Terms),
        at_points: Condition,
    ) -> Condition {
        let is_jump = |it: &&Event| matches!(it.kind, EventKind::Jump(_));
        let jumps = self.simulation.events.iter().filter(is_jump);
        let jumps = jumps.filter(|it| it.time > self.points.times[0]);
        let sides = jumps.flat_map(|it| [(it.time, &it.before), (it.time, &it.after)]);
        let conditions = sides.map(|(time, state)| {
            let worst = worst_of(bounds, [with_terms(state[column])]);
            let Worst { violation, part, .. } = worst;
            let (time, state) = (Some(time), state.clone());
            Condition { label: at_points.label.clone(), violation, part, time, state }
        });
        let worst = conditions.max_by(|a, b| a.part.total_cmp(&b.part));
        match worst {
            Some(it) if (it.part, it.violation) > (at_points.part, at_points.violation) => it,
            _ => at_points,
        }
    }

    /// After the start, as a transcription has it.
    fn path(&self) -> impl Iterator<Item = Condition> {
        let (path, last) = (&*self.problem.path, self.points.times.len() - 1);
        let count = self.states.first().map_or(last, |column| column.len().saturating_sub(1));
        let mut inputs = Columns::new(path.layout().point_inputs(), count);
        for k in 0..count {
            self.set(&mut inputs, k, self.points.times[k + 1], k + 1);
        }
        for (at, column) in self.states.iter().enumerate() {
            inputs.column_mut(1 + at).copy_from_slice(&column[1..=count]);
        }
        let rows = self.of_path(&inputs).into_iter().zip(&self.problem.path_bounds).enumerate();
        rows.map(move |(row, (values, bounds))| {
            let worst = worst_of(*bounds, values);
            self.between(row, self.condition(&path.origin(row).label, worst))
        })
    }

    /// Time and controls of an input of the path conditions, in the interval of a point.
    fn set(&self, inputs: &mut Columns, k: usize, time: f64, point: usize) {
        let (first, last) = (self.points.times[0], self.points.times[self.points.times.len() - 1]);
        inputs.column_mut(0)[k] = (time - first) / (last - first);
        for (at, value) in self.points.control(point, time).into_iter().enumerate() {
            inputs.column_mut(1 + self.states.len() + at)[k] = value;
        }
    }

    fn of_path(&self, inputs: &Columns) -> Vec<Vec<(f64, Terms)>> {
        let controls = self.problem.controls.iter().map(|it| Motion::still(it.unit));
        let time = std::iter::once(Motion::default());
        let motions = time.chain(self.motions.iter().copied()).chain(controls).collect();
        self.evaluated(&*self.problem.path, inputs, motions, &self.problem.path_bounds)
    }

    /// The worst of a path condition between the points, too, where it is worse than at all of
    /// them.
    fn between(&self, row: usize, at_points: Condition) -> Condition {
        let extremes = self.simulation.extremes.get(row).into_iter().flatten();
        let after_start = extremes.filter(|it| it.time > self.points.times[0]);
        let conditions = after_start.map(|it| self.at(row, it, &at_points));
        let worst = conditions.max_by(|a, b| a.violation.total_cmp(&b.violation));
        match worst {
            Some(it) if (it.part, it.violation) > (at_points.part, at_points.violation) => it,
            _ => at_points,
        }
    }

    /// A path condition where the replay has an extreme of it.
    fn at(&self, row: usize, extreme: &Extreme, at_points: &Condition) -> Condition {
        let bounds = self.problem.path_bounds[row];
        let point = self.points.times.partition_point(|time| *time < extreme.time);
        let mut inputs = Columns::new(self.problem.path.layout().point_inputs(), 1);
        self.set(&mut inputs, 0, extreme.time, point.min(self.points.times.len() - 1));
        for (at, column) in self.columns.iter().enumerate() {
            inputs.column_mut(1 + at)[0] = extreme.state[*column];
        }
        // What is no violation at the state itself is rounding, and has no terms to compare with.
        let (value, terms) = self.of_path(&inputs)[row][0];
        let is_any = bounds.violation(value) > 0.0;
        let (violation, part) = match is_any {
            true => (bounds.violation(extreme.value), terms.part(extreme.value, &bounds)),
            false => (0.0, 0.0),
        };
        Condition {
            violation,
            part,
            time: Some(extreme.time),
            state: extreme.state.clone(),
            ..at_points.clone()
        }
    }

    /// A condition along the motion.
    fn condition(&self, label: &str, worst: Worst) -> Condition {
        let Worst { violation, part, point } = worst;
        let at = |point| self.simulation.states.iter().map(|column| column[point]).collect();
        let state = point.map_or_else(|| self.simulation.end.clone(), at);
        let time = point.map(|point| self.simulation.time[point]);
        Condition { label: label.into(), violation, part, time, state }
    }

    /// The conditions on the first point and another one, with the time of that if it is asked for.
    pub fn ending_at(&self, point: usize, has_time: bool) -> impl Iterator<Item = Condition> {
        let boundary = &*self.problem.boundary;
        let mut inputs = Columns::new(boundary.layout().point_inputs(), 1);
        for (at, column) in self.states.iter().enumerate() {
            inputs.column_mut(at)[0] = column[0];
            inputs.column_mut(self.states.len() + at)[0] = column[point];
        }
        // The first output is the objective.
        let bounds = [&[Bounds::FREE], &*self.problem.boundary_bounds].concat();
        let rows = self.evaluated(boundary, &inputs, self.motions.repeat(2), &bounds).into_iter();
        rows.zip(bounds).enumerate().skip(1).map(move |(row, (values, bounds))| {
            let worst = worst_of(bounds, values);
            let point = worst.point.filter(|_| has_time).map(|_| point);
            let worst = Worst { point, ..worst };
            self.condition(&boundary.origin(row).label, worst)
        })
    }

    /// For each output its values at all points, with the terms of which they are sums.
    fn evaluated(
        &self,
        function: &dyn Function,
        points: &Columns,
        motions: Vec<Motion>,
        bounds: &[Bounds],
    ) -> Vec<Vec<(f64, Terms)>> {
        let parameters = self.problem.parameters.iter().map(|it| Motion::still(it.unit));
        let motions: Vec<Motion> = motions.into_iter().chain(parameters).collect();
        let inputs = Inputs { points, parameters: &self.parameters, motions: &motions };
        terms(function, &inputs, bounds)
    }
}

/// Those of the solution, with widths that smooth nothing.
pub(super) fn parameters(problem: &Problem, record: &Record) -> Vec<f64> {
    // The first of a name, as elsewhere.
    let known = record.params.iter().chain(&record.free).rev();
    let known: HashMap<&str, f64> = known.filter(|it| it.1.is_finite()).copied().collect();
    let settings = &record.settings;
    let sigma = settings.sigma.filter(|sigma| sigma.is_finite());
    let width = |name: &str| number(&settings.sigmas, name).or(sigma);
    let value = |it: &Parameter| match it
        .name
        .strip_prefix("sigma(")
        .and_then(|name| name.strip_suffix(')'))
    {
        Some(surface) => NO_WIDTH * width(surface).unwrap_or(it.value),
        None => known.get(it.name.as_str()).copied().unwrap_or(it.value),
    };
    problem.parameters.iter().map(value).collect()
}

/// The worst of the points after the start.
fn worst_of(bounds: Bounds, values: impl IntoIterator<Item = (f64, Terms)>) -> Worst {
    let mut worst = Worst { violation: 0.0, part: 0.0, point: None };
    for (k, (value, terms)) in values.into_iter().enumerate() {
        let violation = bounds.violation(value);
        let part = terms.part(value, &bounds);
        if (part, violation) > (worst.part, worst.violation) {
            worst = Worst { violation, part, point: Some(k + 1) };
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
