//! A solution in the words of the model: signals over real time.

use crate::linalg::Stages;
use crate::nlp::{Derivatives, Nlp, Solution};
use crate::problem::{Columns, Function, Problem};
use crate::transcribe::TranscribedNlp;

/// Signals on a grid of `N + 1` times; controls and reports hold on the interval that begins at their time.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// `N + 1` times.
    pub time: Vec<f64>,
    /// One column per state, hidden ones included; `N + 1` entries each.
    pub states: Vec<Vec<f64>>,
    /// One column per control, `N` entries each.
    pub controls: Vec<Vec<f64>>,
    /// One column per state: the derivative of the objective of the model (as written, `maximize` included) by the
    /// state at that time.
    pub costates: Vec<Vec<f64>>,
    /// One column per report, `N + 1` entries each; the last uses the last control.
    pub report: Vec<Vec<f64>>,
    /// One column per surface: its switching function, `N + 1` entries each.
    pub guards: Vec<Vec<f64>>,
    /// All of `p`, unknowns included.
    pub parameters: Vec<f64>,
}

impl Trajectory {
    /// Reads a solution.
    pub fn new(problem: &Problem, nlp: &mut TranscribedNlp, solution: &Solution) -> Self {
        let (stages, v) = (nlp.chain(), &solution.v);
        let parameters = nlp.parameters_at(v);
        let signals = Signals::new(stages, v);
        let points = signals.points();
        Trajectory {
            time: times(problem, &parameters, stages.intervals),
            report: sample(&*problem.report, &points, &parameters),
            guards: sample(&*problem.guards, &points, &parameters),
            costates: costates(problem, nlp, solution),
            states: signals.states,
            controls: signals.controls,
            parameters,
        }
    }
}

/// The switching functions at all grid points.
pub(crate) fn guards(problem: &Problem, stages: Stages, v: &[f64], parameters: &[f64]) -> Vec<Vec<f64>> {
    sample(&*problem.guards, &Signals::new(stages, v).points(), parameters)
}

/// A function over normalised time at all grid points.
fn sample(function: &dyn Function, points: &Columns, parameters: &[f64]) -> Vec<Vec<f64>> {
    let mut values = Columns::new(function.outputs(), points.count());
    function.value(&resized(points, function.layout().point_inputs()), parameters, &mut values);
    (0..function.outputs()).map(|i| values.column(i).to_vec()).collect()
}

/// States and controls by column.
struct Signals {
    states: Vec<Vec<f64>>,
    controls: Vec<Vec<f64>>,
    intervals: usize,
}

impl Signals {
    fn new(stages: Stages, v: &[f64]) -> Self {
        let column =
            |first: usize, count: usize| (0..count).map(|k| v[first + k * stages.variable_step()]).collect();
        let states = (0..stages.states).map(|i| column(i, stages.intervals + 1)).collect();
        let controls = (0..stages.controls).map(|i| column(stages.states + i, stages.intervals)).collect();
        Signals { states, controls, intervals: stages.intervals }
    }

    /// `[t | x | u]` at all grid points; the last takes the last control.
    fn points(&self) -> Columns {
        let (states, controls, intervals) = (&self.states, &self.controls, self.intervals);
        let mut points = Columns::new(1 + states.len() + controls.len(), intervals + 1);
        for k in 0..=intervals {
            points.column_mut(0)[k] = k as f64 / intervals as f64;
        }
        for (i, state) in states.iter().enumerate() {
            points.column_mut(1 + i).copy_from_slice(state);
        }
        for (i, control) in controls.iter().enumerate() {
            let column = points.column_mut(1 + states.len() + i);
            column[..intervals].copy_from_slice(control);
            column[intervals] = control.last().copied().unwrap_or(0.0);
        }
        points
    }
}

/// Real times of the grid.
pub fn times(problem: &Problem, parameters: &[f64], intervals: usize) -> Vec<f64> {
    let mut ends = Columns::new(2, 1);
    let points = Columns::new(problem.interval.layout().point_inputs(), 1);
    problem.interval.value(&points, parameters, &mut ends);
    let (start, end) = (ends.column(0)[0], ends.column(1)[0]);
    (0..=intervals).map(|k| start + (end - start) * k as f64 / intervals as f64).collect()
}

/// The first `columns` columns, with zeros for those that are missing.
fn resized(points: &Columns, columns: usize) -> Columns {
    let mut result = Columns::new(columns, points.count());
    for i in 0..columns.min(points.columns()) {
        result.column_mut(i).copy_from_slice(points.column(i));
    }
    result
}

/// `dJ/dx_k`: the gradient by `x_k` of the Lagrangian of all that comes after grid point `k`. That is the part of
/// interval `k` for `k < N`, and the part of the boundary for `k = N`.
fn costates(problem: &Problem, nlp: &mut TranscribedNlp, solution: &Solution) -> Vec<Vec<f64>> {
    let stages = nlp.chain();
    let rows = &solution.multipliers.rows;
    let mut derivatives = Derivatives::new(nlp);
    nlp.derivatives(&solution.v, 1.0, rows, &mut derivatives);
    let own = nlp.gradient_from_here_on();
    let mut costates = vec![vec![0.0; stages.intervals + 1]; stages.states];
    for k in 0..=stages.intervals {
        for (i, variable) in stages.state(k).enumerate() {
            costates[i][k] = own[variable];
        }
    }
    for ((row, variable), value) in nlp.jacobian_structure().entries().zip(&derivatives.jacobian) {
        let (k, i) = (variable / stages.variable_step(), variable % stages.variable_step());
        if variable >= stages.globals().start || i >= stages.states {
            continue;
        }
        let from_here_on =
            if row >= stages.coupling().start { k == stages.intervals } else { row / stages.row_step() == k };
        if from_here_on {
            costates[i][k] += value * rows[row];
        }
    }
    for value in costates.iter_mut().flatten() {
        *value *= problem.sense;
    }
    costates
}
