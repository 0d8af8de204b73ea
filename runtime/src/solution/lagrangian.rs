//! The Lagrangian of a solution. By the envelope theorem the derivatives of the optimum by what the
//! optimiser does not choose are its partial derivatives, multipliers held:
//!
//! ```text
//!     dJ/dq = d/dq [ f + sum_i lambda_i (c_i - b_i) - z_lower' (v - l) + z_upper' (v - u) ]
//! ```
//!
//! where `b_i` is the bound at which row `i` is. By time it is the
//! [Hamiltonian](super::hamiltonian); by parameters, see [`mod@super::by_parameters`].

use crate::nlp::Solution;
use crate::problem::{Columns, Function, Problem};
use crate::transcribe::TranscribedNlp;
use crate::transcribe::interval::{Node, Point};

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

/// A solution with its multipliers.
pub(super) struct Lagrangian<'a> {
    pub(super) problem: &'a Problem,
    pub(super) nlp: &'a TranscribedNlp<'a>,
    pub(super) solution: &'a Solution,
    /// The variables: those of the solution, or others in their place.
    pub(super) v: &'a [f64],
    /// All of `p`, with the unknowns of the solution.
    pub(super) parameters: Vec<f64>,
}

impl<'a> Lagrangian<'a> {
    pub(super) fn new(
        problem: &'a Problem,
        nlp: &'a TranscribedNlp,
        solution: &'a Solution,
    ) -> Self {
        let (v, parameters) = (&solution.v, nlp.parameters_at(&solution.v));
        Lagrangian { problem, nlp, solution, v, parameters }
    }

    /// With other signals and the same multipliers.
    pub(super) fn at<'b>(&'b self, v: &'b [f64]) -> Lagrangian<'b> {
        let &Lagrangian { problem, nlp, solution, .. } = self;
        Lagrangian { problem, nlp, solution, v, parameters: self.parameters.clone() }
    }

    /// `[x(start), x(end)]`
    pub(super) fn ends(&self, boundary: &dyn Function) -> Columns {
        let (stages, states) = (self.nlp.chain(), self.problem.layout.x);
        let mut points = Columns::new(boundary.layout().point_inputs(), 1);
        let ends = stages.state(0).take(states).chain(stages.state(stages.intervals).take(states));
        for (i, variable) in ends.enumerate() {
            points.column_mut(i)[0] = self.v[variable];
        }
        points
    }

    /// `[tau | x | u]` of a node in all intervals.
    pub(super) fn points(&self, function: &dyn Function, node: &Node) -> Columns {
        self.points_at(function, &node.point)
    }

    /// The same at any point.
    pub(super) fn points_at(&self, function: &dyn Function, point: &Point) -> Columns {
        let stages = self.nlp.chain();
        let mut points = Columns::new(function.layout().point_inputs(), stages.intervals);
        point.set_times(self.nlp.mesh(), &mut points);
        point.load(stages, function.layout(), self.v, &mut points);
        points
    }

    /// What an output of the right side at a node counts in the Lagrangian, per length of each
    /// interval.
    pub(super) fn weights(&self, node: &Node, output: usize) -> impl Iterator<Item = f64> {
        let stages = self.nlp.chain();
        let is_state = output < self.problem.layout.x;
        let (row, factor, weight) = (node.row + output, node.factor, node.weight);
        let rows = &self.solution.multipliers.constraints;
        let own = move |k: usize| {
            if is_state { -factor * rows[k * stages.row_step() + row] } else { weight }
        };
        (0..stages.intervals).map(own)
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
