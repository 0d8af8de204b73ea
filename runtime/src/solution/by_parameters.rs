//! The sensitivity of the optimal cost: its derivatives by parameters, from the multipliers.
//!
//! They are the partial derivatives of the [Lagrangian](super::lagrangian), of functions, bounds
//! and starts that parameters enter.

use super::lagrangian::{Lagrangian, add_slopes};
use super::minimum;
use crate::nlp::Solution;
use crate::problem::{Bounds, ByParameters, Columns, Function, Problem};
use crate::transcribe::TranscribedNlp;
use crate::transcribe::interval::Signal;
use std::ops::Range;

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
    minimum::set_multipliers_of_fixed(&nlp, &slopes, &mut solution.multipliers);
    let rows = nlp.rows(&solution.v, &solution.multipliers.constraints);
    Lagrangian::new(problem, &nlp, &solution).by_parameters(by, &at_start, &rows)
}

impl Lagrangian<'_> {
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
            let points = self.points_at(path, point);
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
