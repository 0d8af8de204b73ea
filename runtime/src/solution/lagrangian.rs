//! Derivatives of the optimum by what the optimiser does not choose: by time, which is the
//! Hamiltonian, and by parameters.
//!
//! By the envelope theorem they are the partial derivatives of the Lagrangian at the solution,
//! multipliers held:
//!
//! ```text
//!     dJ/dq = d/dq [ f + sum_i lambda_i (c_i - b_i) - z_lower' (v - l) + z_upper' (v - u) ]
//! ```
//!
//! where `b_i` is the bound at which row `i` is. By the length of interval `k`, over that of the
//! time, this is its Hamiltonian
//!
//! ```text
//!     H_k = sum_j b_j L(node j) - sum_j lambda_j . F(node j)  ~  L + p . f,        p = dJ/dx
//! ```
//!
//! in which nothing is approximated beyond the transcription: the mean of `H_k` is exactly the
//! derivative by the final time.

use super::minimum;
use crate::nlp::Solution;
use crate::problem::{Bounds, ByParameters, Columns, Function, Problem};
use crate::transcribe::TranscribedNlp;
use crate::transcribe::interval::{Node, Signal};
use std::ops::Range;

/// Over the whole time, terms that are not larger than this times the tolerance are none.
const NOISE: f64 = 100.0;
/// An unknown with a larger multiplier is at its bound.
const AT_BOUND: f64 = 1e-4;

/// The derivative of the optimal objective of the model by each parameter, those included that are
/// computed from it. `p` holds the parameters, widths and unknowns of the solution.
pub fn by_parameters(
    problem: &Problem,
    solution: &Solution,
    p: &[f64],
    by: &ByParameters,
) -> Vec<f64> {
    by_parameters_of_part(problem, solution, p, by, &[])
}

/// The same where links add slopes to the gradient of the Lagrangian, one per variable.
pub(crate) fn by_parameters_of_part(
    problem: &Problem,
    solution: &Solution,
    p: &[f64],
    by: &ByParameters,
    linked: &[f64],
) -> Vec<f64> {
    let mut nlp = TranscribedNlp::new(problem);
    p.iter().enumerate().for_each(|(index, value)| nlp.set_parameter(index, *value));
    // What a start that is given as a number counts.
    let slopes = minimum::slopes(&mut nlp, solution);
    let mut at_start = slopes[nlp.chain().state(0)].to_vec();
    at_start.iter_mut().zip(linked).for_each(|(slope, more)| *slope += more);
    let mut solution = solution.clone();
    minimum::add_multipliers_of_fixed(&nlp, &slopes, &mut solution.multipliers.lower);
    let rows = nlp.rows(&solution.v, &solution.multipliers.constraints);
    Lagrangian::new(problem, &nlp, &solution).by_parameters(by, &at_start, &rows)
}

/// What the objective of the model changes by with the bound of each path constraint, per time: one
/// column per row, `N` entries each.
pub(crate) fn path_multipliers(
    problem: &Problem,
    nlp: &TranscribedNlp,
    solution: &Solution,
    time: &[f64],
) -> Vec<Vec<f64>> {
    let (chain, rows) = (nlp.chain(), &solution.multipliers.constraints);
    let count = problem.path_bounds.len();
    let density = |row: usize, k: usize| {
        let sum: f64 = chain.local(k).skip(row).step_by(count).map(|at| rows[at]).sum();
        -problem.sense * sum / (time[k + 1] - time[k])
    };
    (0..count).map(|row| (0..chain.intervals).map(|k| density(row, k)).collect()).collect()
}

/// What the objective of the model changes by with the bound of each condition at the ends.
pub(crate) fn end_multipliers(
    problem: &Problem,
    nlp: &TranscribedNlp,
    solution: &Solution,
) -> Vec<f64> {
    let rows = &solution.multipliers.constraints[nlp.chain().coupling()];
    rows.iter().map(|lambda| -problem.sense * lambda).collect()
}

/// The Hamiltonian of each interval, and what it has to be.
#[derive(Clone, Debug, Default)]
pub struct Hamiltonian {
    /// One for each interval, of the objective of the model.
    pub values: Vec<f64>,
    /// The mean size of the terms that it is a sum of, or of noise where that is more: what
    /// deviations are to be compared with.
    pub size: f64,
    /// Whether it has to be constant: time itself does not matter.
    pub is_constant: bool,
    /// What it has to be at the last time, where that is unknown: minus what the objective and the
    /// conditions at the ends gain by it.
    pub expected: Option<f64>,
    /// One for each control: the part of the time on which it does not minimise the Hamiltonian, by
    /// the sign of the slope.
    pub violations: Vec<f64>,
    /// What a pause on a surface would gain, per time, where one is possible: above 0 it is no
    /// optimum.
    pub pause: Option<f64>,
    /// Whether all its terms together are no more than the tolerance of the solver: then nothing
    /// can be said of it.
    pub is_noise: bool,
}

impl Hamiltonian {
    /// Of a solution over this time.
    pub fn new(
        problem: &Problem,
        nlp: &mut TranscribedNlp,
        solution: &Solution,
        duration: f64,
    ) -> Self {
        let lagrangian = Lagrangian::new(problem, nlp, solution);
        let ((values, size), expected) = (lagrangian.hamiltonian(duration), lagrangian.expected());
        let noise = NOISE * problem.method.tol / duration.abs();
        let is_noise = size <= noise;
        let size = size.max(noise);
        let violations = match is_noise {
            true => vec![0.0; problem.layout.u],
            false => minimum::violations(&problem.controls, nlp, solution, (duration, size)),
        };
        let is_constant = problem.is_autonomous;
        Hamiltonian { values, size, is_constant, expected, violations, pause: None, is_noise }
    }

    /// The mean difference from what it has to be, over all intervals; nothing where it may be
    /// anything.
    pub fn deviation(&self) -> Option<f64> {
        let target = self.target()?;
        let sum: f64 = self.values.iter().map(|value| (value - target).abs()).sum();
        Some(sum / self.values.len().max(1) as f64)
    }

    /// What it has to be, as far as that is known; nothing where it may be anything.
    pub(crate) fn target(&self) -> Option<f64> {
        let mean = self.values.iter().sum::<f64>() / self.values.len().max(1) as f64;
        (self.is_constant && !self.is_noise).then_some(self.expected.unwrap_or(mean))
    }
}

/// A solution with its multipliers.
pub(crate) struct Lagrangian<'a> {
    problem: &'a Problem,
    nlp: &'a TranscribedNlp<'a>,
    solution: &'a Solution,
    parameters: Vec<f64>,
}

impl<'a> Lagrangian<'a> {
    pub(crate) fn new(
        problem: &'a Problem,
        nlp: &'a TranscribedNlp,
        solution: &'a Solution,
    ) -> Self {
        Lagrangian { problem, nlp, solution, parameters: nlp.parameters_at(&solution.v) }
    }

    /// One for each interval, of the objective of the model; and the mean size of its terms.
    fn hamiltonian(&self, duration: f64) -> (Vec<f64>, f64) {
        let (mut sums, mut sizes) = (vec![0.0; self.nlp.chain().intervals], 0.0);
        for node in &self.nlp.interval().nodes {
            let dynamics = &*self.problem.dynamics;
            let mut values = Columns::new(dynamics.outputs(), sums.len());
            dynamics.value(&self.points(dynamics, node), &self.parameters, &mut values);
            for output in 0..dynamics.outputs() {
                let weights = self.weights(node, output);
                for (sum, (weight, value)) in
                    sums.iter_mut().zip(weights.zip(values.column(output)))
                {
                    *sum += weight * value;
                    sizes += (weight * value).abs();
                }
            }
        }
        sums.iter_mut().for_each(|sum| *sum *= self.problem.sense / duration);
        let count = duration.abs() * sums.len() as f64;
        (sums, sizes / count)
    }

    /// Where the last time is an unknown between its bounds, the Lagrangian does not change with
    /// it.
    fn expected(&self) -> Option<f64> {
        let (problem, stages) = (self.problem, self.nlp.chain());
        let unknown = problem.last_time?;
        let variable = stages.globals().start + unknown;
        let multipliers = &self.solution.multipliers;
        let boundary = &*problem.boundary;
        let place = boundary.layout().parameters().start + problem.unknowns[unknown].parameter;
        let (points, rows) = (self.ends(boundary), &multipliers.constraints[stages.coupling()]);
        let mut slopes = vec![0.0; boundary.layout().p];
        add_slopes(boundary, &points, &self.parameters, &mut slopes, |output| {
            vec![output.checked_sub(1).map_or(1.0, |row| rows[row])]
        });
        let at_bound = multipliers.lower[variable].max(multipliers.upper[variable]);
        let gain = slopes[place - boundary.layout().parameters().start];
        (at_bound <= AT_BOUND * (1.0 + gain.abs())).then_some(-problem.sense * gain)
    }

    /// `[x(start), x(end)]`
    fn ends(&self, boundary: &dyn Function) -> Columns {
        let (stages, states) = (self.nlp.chain(), self.problem.layout.x);
        let mut points = Columns::new(boundary.layout().point_inputs(), 1);
        let ends = stages.state(0).take(states).chain(stages.state(stages.intervals).take(states));
        for (i, variable) in ends.enumerate() {
            points.column_mut(i)[0] = self.solution.v[variable];
        }
        points
    }

    /// `[tau | x | u]` of a node in all intervals.
    fn points(&self, function: &dyn Function, node: &Node) -> Columns {
        let stages = self.nlp.chain();
        let mut points = Columns::new(function.layout().point_inputs(), stages.intervals);
        node.point.set_times(self.nlp.mesh(), &mut points);
        node.point.load(stages, function.layout(), &self.solution.v, &mut points);
        points
    }

    /// What an output of the right side at a node counts in the Lagrangian, per length of each
    /// interval.
    fn weights(&self, node: &Node, output: usize) -> impl Iterator<Item = f64> {
        let stages = self.nlp.chain();
        let is_state = output < self.problem.layout.x;
        let (row, factor, weight) = (node.row + output, node.factor, node.weight);
        let rows = &self.solution.multipliers.constraints;
        let own = move |k: usize| {
            if is_state { -factor * rows[k * stages.row_step() + row] } else { weight }
        };
        (0..stages.intervals).map(own)
    }

    /// By each parameter, those included that are computed from it.
    fn by_parameters(
        &self,
        by: &ByParameters,
        at_start: &[f64],
        rows: &[(Columns, Vec<f64>)],
    ) -> Vec<f64> {
        let mut sums = vec![0.0; by.parameters];
        self.add_dynamics(by, &mut sums);
        self.add_path(by, &mut sums);
        self.add_boundary(by, &mut sums);
        for (function, (points, weights)) in by.measurements.iter().zip(rows) {
            add_slopes(&**function, points, &self.parameters, &mut sums, |_| weights.clone());
        }
        self.add_given(by, at_start, &mut sums);
        sums.iter().map(|sum| self.problem.sense * sum).collect()
    }

    fn add_dynamics(&self, by: &ByParameters, sums: &mut [f64]) {
        let step = 1.0 / self.nlp.chain().intervals as f64;
        for node in &self.nlp.interval().nodes {
            let points = self.points(&*by.dynamics, node);
            add_slopes(&*by.dynamics, &points, &self.parameters, sums, |output| {
                let weights = self.weights(node, output).enumerate();
                weights.map(|(k, weight)| weight * step * self.nlp.mesh().relative(k)).collect()
            });
        }
    }

    fn add_path(&self, by: &ByParameters, sums: &mut [f64]) {
        let (stages, path) = (self.nlp.chain(), &*by.path);
        let rows = &self.solution.multipliers.constraints;
        for (at, point) in self.nlp.interval().path.iter().enumerate() {
            let mut points = Columns::new(path.layout().point_inputs(), stages.intervals);
            point.set_times(self.nlp.mesh(), &mut points);
            point.load(stages, path.layout(), &self.solution.v, &mut points);
            let first = at * path.outputs();
            add_slopes(path, &points, &self.parameters, sums, |output| {
                (0..stages.intervals)
                    .map(|k| rows[stages.local(k).start + first + output])
                    .collect()
            });
        }
    }

    fn add_boundary(&self, by: &ByParameters, sums: &mut [f64]) {
        let (stages, boundary) = (self.nlp.chain(), &*by.boundary);
        let rows = &self.solution.multipliers.constraints[stages.coupling()];
        add_slopes(boundary, &self.ends(boundary), &self.parameters, sums, |output| {
            vec![output.checked_sub(1).map_or(1.0, |row| rows[row])]
        });
    }

    /// Bounds and starts, and parameters that follow from others.
    fn add_given(&self, by: &ByParameters, at_start: &[f64], sums: &mut [f64]) {
        add_given(&*by.given, &self.weights_of_given(by, at_start), &self.parameters, sums);
    }

    /// The variables that are values of a signal.
    fn variables_of(&self, signal: Signal) -> Vec<usize> {
        let stages = self.nlp.chain();
        let slots =
            self.nlp.interval().slots.iter().enumerate().filter(|(_, slot)| slot.signal == signal);
        let places = slots.flat_map(|(place, _)| {
            let count = stages.intervals + usize::from(place < stages.states);
            (0..count).map(move |k| place + k * stages.variable_step())
        });
        places.collect()
    }

    /// What each of the numbers that the parameters give counts in the Lagrangian.
    fn weights_of_given(&self, by: &ByParameters, at_start: &[f64]) -> Vec<f64> {
        let (problem, stages) = (self.problem, self.nlp.chain());
        let multipliers = &self.solution.multipliers;
        let mut weights = vec![0.0; by.parameters];
        let starts = problem.start.iter().zip(at_start);
        weights.extend(starts.map(|(start, slope)| start.map_or(0.0, |_| *slope)));
        let signals = (0..problem.layout.x)
            .map(Signal::State)
            .chain((0..problem.layout.u).map(Signal::Control));
        let signals = signals.map(|signal| self.variables_of(signal));
        let unknown = |parameter: usize| {
            let at = problem.unknowns.iter().position(|it| it.parameter == parameter);
            at.map(|at| stages.globals().start + at).into_iter().collect()
        };
        let unknowns = (by.parameters..by.parameters + by.unknowns).map(unknown);
        for variables in signals.chain(unknowns) {
            let sum = |of: &[f64]| variables.iter().map(|at| of[*at]).sum::<f64>();
            weights.extend([sum(&multipliers.lower), -sum(&multipliers.upper)]);
        }
        let paths = problem.path_bounds.len();
        let every = |range: Range<usize>, row: usize| range.skip(row).step_by(paths.max(1));
        for row in 0..paths {
            let all = (0..stages.intervals).flat_map(|k| every(stages.local(k), row));
            weights.extend(at_bounds(
                all.map(|at| multipliers.constraints[at]),
                &problem.path_bounds[row],
            ));
        }
        for (row, bounds) in stages.coupling().zip(&problem.boundary_bounds) {
            weights.extend(at_bounds([multipliers.constraints[row]], bounds));
        }
        weights
    }
}

/// What lower and upper bound of rows count: a multiplier below zero belongs to the lower one.
pub(crate) fn at_bounds(multipliers: impl IntoIterator<Item = f64>, bounds: &Bounds) -> [f64; 2] {
    multipliers.into_iter().fold([0.0; 2], |[lower, upper], lambda| {
        let is_lower = lambda < 0.0 && bounds.lower > f64::NEG_INFINITY;
        if is_lower { [lower - lambda, upper] } else { [lower, upper - lambda] }
    })
}

/// Adds what is given counts, and that parameters follow from others: these are the first outputs.
pub(crate) fn add_given(
    given: &dyn Function,
    weights: &[f64],
    parameters: &[f64],
    sums: &mut [f64],
) {
    let points = Columns::new(given.layout().point_inputs(), 1);
    let parameters = &parameters[..given.layout().p];
    add_slopes(given, &points, parameters, sums, |output| vec![weights[output]]);
    let direct = sums.to_vec();
    // A parameter may follow from another that follows from a third, and so on.
    for _ in 0..direct.len() {
        let known = sums.to_vec();
        sums.copy_from_slice(&direct);
        add_slopes(given, &points, parameters, sums, |output| {
            vec![known.get(output).copied().unwrap_or(0.0)]
        });
        if known == sums {
            break;
        }
    }
}

/// Adds the Jacobian by the first entries of `p`, each output with its weights at all points.
pub(crate) fn add_slopes(
    function: &dyn Function,
    points: &Columns,
    parameters: &[f64],
    sums: &mut [f64],
    weights: impl Fn(usize) -> Vec<f64>,
) {
    let entries = &function.jacobian_pattern().entries;
    let mut values = Columns::new(function.outputs(), points.count());
    let mut slopes = Columns::new(entries.len(), points.count());
    function.jacobian(points, parameters, &mut values, &mut slopes);
    let first = function.layout().parameters().start;
    for (column, &(output, input)) in entries.iter().enumerate() {
        let Some(place) = (input as usize).checked_sub(first) else { continue };
        let terms = weights(output as usize).into_iter().zip(slopes.column(column));
        sums[place] += terms.map(|(weight, slope)| weight * slope).sum::<f64>();
    }
}
