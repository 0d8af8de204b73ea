//! A solution in the words of the model: signals over real time.

use super::hamiltonian::Hamiltonian;
use super::lagrangian::{end_multipliers, path_multipliers};
use super::minimum::derivatives;
use crate::linalg::Stages;
use crate::nlp::{Derivatives, Nlp, Solution};
use crate::problem::{Columns, Function, Problem};
use crate::transcribe::interval::Point;
use crate::transcribe::mesh::Mesh;
use crate::transcribe::{TranscribedNlp, interval};

/// Signals on a grid of `N + 1` times; controls and reports hold on the interval that begins at
/// their time.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// `N + 1` times.
    pub time: Vec<f64>,
    /// One column per state, hidden ones included; `N + 1` entries each.
    pub states: Vec<Vec<f64>>,
    /// One column per control, `N` entries each: its mean over the interval.
    pub controls: Vec<Vec<f64>>,
    /// What defines controls that are not constant on each interval.
    pub nodes: Option<ControlNodes>,
    /// One column per state: the derivative of the objective of the model (as written, `maximize`
    /// included) by the state at that time.
    pub costates: Vec<Vec<f64>>,
    /// One column per path constraint, `N` entries each: what the objective changes by with its
    /// bound, per time.
    pub path_multipliers: Vec<Vec<f64>>,
    /// One per condition at the ends: what the objective changes by with its bound.
    pub end_multipliers: Vec<f64>,
    /// The Hamiltonian, and what it has to be.
    pub hamiltonian: Hamiltonian,
    /// One column per report, `N + 1` entries each; the last uses the last control.
    pub report: Vec<Vec<f64>>,
    /// One column per surface: its switching function, `N + 1` entries each.
    pub switching: Vec<Vec<f64>>,
    /// All of `p`, unknowns included.
    pub parameters: Vec<f64>,
}

/// The values between which a control is linear, or through which it is a polynomial on each
/// interval.
#[derive(Clone, Debug, Default)]
pub struct ControlNodes {
    /// Times, ascending.
    pub time: Vec<f64>,
    /// One column per control.
    pub values: Vec<Vec<f64>>,
}

impl Trajectory {
    /// Reads a solution.
    pub fn new(problem: &Problem, nlp: &mut TranscribedNlp, solution: &Solution) -> Self {
        let v = &solution.v;
        let parameters = nlp.parameters_at(v);
        let points = points(nlp, problem, v);
        let time = times(problem, &parameters);
        let duration = time[time.len() - 1] - time[0];
        let derivatives = derivatives(nlp, solution);
        Trajectory {
            states: (0..problem.layout.x).map(|i| points.column(1 + i).to_vec()).collect(),
            controls: controls(nlp, v),
            nodes: nodes(nlp, v, &time),
            report: sample(&*problem.report, &points, &parameters),
            switching: sample(&*problem.switching, &points, &parameters),
            costates: costates(problem, nlp, solution, &derivatives),
            path_multipliers: path_multipliers(problem, nlp, solution, &time),
            end_multipliers: end_multipliers(problem, nlp, solution),
            hamiltonian: Hamiltonian::new(problem, nlp, (solution, &derivatives), duration),
            time,
            parameters,
        }
    }

    /// Adds to the costates at the last time what the links of a chain add to the gradient by the
    /// last state; `slopes` has one number per variable of the phase.
    pub(crate) fn add_costates_of_links(
        &mut self,
        problem: &Problem,
        slopes: &[f64],
        chain: Stages,
    ) {
        let last = chain.state(chain.intervals).start;
        for (costates, slope) in self.costates.iter_mut().zip(&slopes[last..]) {
            *costates.last_mut().expect("a last grid point") += problem.sense * slope;
        }
    }
}

/// Signals along `v` with their rates.
pub(crate) struct Sampled {
    /// `N + 1` times.
    pub time: Vec<f64>,
    /// One column per state, `N + 1` entries each; so are their rates.
    pub states: Vec<Vec<f64>>,
    pub rates: Vec<Vec<f64>>,
    /// One column per control, `N` entries each: its mean over the interval; so are their slopes.
    pub controls: Vec<Vec<f64>>,
    pub slopes: Vec<Vec<f64>>,
    /// All of `p`.
    pub parameters: Vec<f64>,
}

impl Sampled {
    pub fn new(nlp: &TranscribedNlp, v: &[f64]) -> Self {
        let problem = nlp.problem();
        let (points, parameters) = (points(nlp, problem, v), nlp.parameters_at(v));
        let time = times(problem, &parameters);
        let duration = time[time.len() - 1] - time[0];
        let mut rates = sample(&*problem.dynamics, &points, &parameters);
        rates.truncate(problem.layout.x);
        rates.iter_mut().flatten().for_each(|it| *it /= duration);
        Sampled {
            states: (0..problem.layout.x).map(|i| points.column(1 + i).to_vec()).collect(),
            controls: controls(nlp, v),
            slopes: slopes(nlp, v, &time),
            rates,
            time,
            parameters,
        }
    }
}

/// How fast each control changes over each interval, from its first value to its last.
fn slopes(nlp: &TranscribedNlp, v: &[f64], time: &[f64]) -> Vec<Vec<f64>> {
    let [starts, ends] = [&nlp.interval().start, &nlp.interval().end].map(|it| table(nlp, it, v));
    let first = 1 + nlp.problem().layout.x;
    let of = |control: usize| {
        let both = starts.column(first + control).iter().zip(ends.column(first + control));
        both.zip(time.windows(2)).map(|((a, b), pair)| (b - a) / (pair[1] - pair[0])).collect()
    };
    (0..nlp.problem().layout.u).map(of).collect()
}

/// The largest absolute value of each switching function along `v`.
pub(crate) fn switching_function_sizes(nlp: &TranscribedNlp, v: &[f64]) -> Vec<f64> {
    let problem = nlp.problem();
    let psi = sample(&*problem.switching, &points(nlp, problem, v), &nlp.parameters_at(v));
    psi.iter().map(|psi| psi.iter().fold(0.0, |a: f64, value| a.max(value.abs()))).collect()
}

/// A function over normalised time at all grid points.
pub(crate) fn sample(
    function: &dyn Function,
    points: &Columns,
    parameters: &[f64],
) -> Vec<Vec<f64>> {
    let mut values = Columns::new(function.outputs(), points.count());
    function.value(&resized(points, function.layout().point_inputs()), parameters, &mut values);
    (0..function.outputs()).map(|i| values.column(i).to_vec()).collect()
}

/// `[t | x | u]` at all grid points: at the start of each interval, and at the end of the last.
fn points(nlp: &TranscribedNlp, problem: &Problem, v: &[f64]) -> Columns {
    let (stages, layout) = (nlp.chain(), &problem.layout);
    let columns = 1 + layout.x + layout.u;
    let [starts, ends] = [&nlp.interval().start, &nlp.interval().end].map(|it| table(nlp, it, v));
    let mut points = Columns::new(columns, stages.intervals + 1);
    for i in 0..columns {
        let (last, others) = points.column_mut(i).split_last_mut().expect("a last grid point");
        others.copy_from_slice(starts.column(i));
        *last = ends.column(i).last().copied().unwrap_or(0.0);
    }
    points
}

/// `[t | x | u]` at a point of every interval.
fn table(nlp: &TranscribedNlp, point: &Point, v: &[f64]) -> Columns {
    let (stages, layout) = (nlp.chain(), &nlp.problem().layout);
    let mut table = Columns::new(1 + layout.x + layout.u, stages.intervals);
    point.set_times(nlp.mesh(), &mut table);
    point.load(stages, layout, v, &mut table);
    table
}

/// The mean of each control over each interval.
fn controls(nlp: &TranscribedNlp, v: &[f64]) -> Vec<Vec<f64>> {
    let mean = |combination| {
        let mut column = vec![0.0; nlp.chain().intervals];
        interval::add_up(combination, nlp.chain(), v, &mut column);
        column
    };
    nlp.interval().means.iter().map(mean).collect()
}

/// The values that define controls that are not constant on an interval; nothing if they are.
fn nodes(nlp: &TranscribedNlp, v: &[f64], time: &[f64]) -> Option<ControlNodes> {
    let (stages, interval) = (nlp.chain(), nlp.interval());
    let of = |control: usize| {
        let slots = interval.slots.iter().enumerate();
        slots.filter(move |(_, slot)| slot.signal == interval::Signal::Control(control))
    };
    let is_constant = of(0).count() <= 1;
    // Linear controls: the value at the end of an interval is that at the start of the next.
    let is_own = |k: usize, time: f64| {
        time < 1.0 || k + 1 == stages.intervals || interval.carried_controls() == 0
    };
    let all = |control: usize| {
        let places = (0..stages.intervals)
            .flat_map(move |k| of(control).map(move |(place, slot)| (k, place, slot.time)));
        places.filter(move |(k, _, part)| is_own(*k, *part))
    };
    (!is_constant).then(|| ControlNodes {
        time: all(0).map(|(k, _, part)| time[k] + part * (time[k + 1] - time[k])).collect(),
        values: (0..interval.means.len())
            .map(|control| {
                all(control).map(|(k, place, _)| v[stages.state(k).start + place]).collect()
            })
            .collect(),
    })
}

/// Real times of the grid.
pub fn times(problem: &Problem, parameters: &[f64]) -> Vec<f64> {
    let mut ends = Columns::new(2, 1);
    let points = Columns::new(problem.interval.layout().point_inputs(), 1);
    problem.interval.value(&points, parameters, &mut ends);
    let (start, end) = (ends.column(0)[0], ends.column(1)[0]);
    let (intervals, mesh) = (problem.method.intervals(), Mesh::new(&problem.method));
    let uniform = |k: usize| start + (end - start) * k as f64 / intervals as f64;
    let tau = |k: usize| if k == intervals { end } else { start + (end - start) * mesh.at(k, 0.0) };
    let is_uniform = problem.method.grid.times().is_empty();
    (0..=intervals).map(|k| if is_uniform { uniform(k) } else { tau(k) }).collect()
}

/// The first `columns` columns, with zeros for those that are missing.
fn resized(points: &Columns, columns: usize) -> Columns {
    let mut result = Columns::new(columns, points.count());
    for i in 0..columns.min(points.columns()) {
        result.column_mut(i).copy_from_slice(points.column(i));
    }
    result
}

/// `dJ/dx_k`: the gradient by `x_k` of the Lagrangian of all that comes after grid point `k`. That
/// is the part of interval `k` for `k < N`, and the part of the boundary for `k = N`.
/// The derivatives are those at the solution, evaluated last.
fn costates(
    problem: &Problem,
    nlp: &TranscribedNlp,
    solution: &Solution,
    derivatives: &Derivatives,
) -> Vec<Vec<f64>> {
    let stages = nlp.chain();
    let rows = &solution.multipliers.constraints;
    let own = nlp.gradient_from_here_on();
    let states = problem.layout.x;
    let mut costates = vec![vec![0.0; stages.intervals + 1]; states];
    if states == 0 {
        return costates;
    }
    for k in 0..=stages.intervals {
        for (i, variable) in stages.state(k).take(states).enumerate() {
            costates[i][k] = own[variable];
        }
    }
    nlp.jacobian_structure().with_values(&derivatives.jacobian).for_each(
        |(row, variable, value)| {
            let (k, i) = (variable / stages.variable_step(), variable % stages.variable_step());
            let is_state = variable < stages.globals().start && i < states;
            let is_from_here_on = || match row >= stages.coupling().start {
                true => k == stages.intervals,
                false => row / stages.row_step() == k,
            };
            if is_state && is_from_here_on() {
                costates[i][k] += value * rows[row];
            }
        },
    );
    for value in costates.iter_mut().flatten() {
        *value *= problem.sense;
    }
    costates
}
