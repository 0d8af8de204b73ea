//! Nonlinear programs (NLP), and what a solver says about one.
//!
//! ```text
//!     minimise  f(v)    subject to   lower <= c(v) <= upper,   lower <= v <= upper
//! ```
//!
//! Multipliers `lambda` are those of the Lagrangian `f + lambda' c - z_lower' v + z_upper' v`: they
//! are minus the rate at which the optimal objective grows with the right-hand side of a
//! constraint.

mod assessment;
mod conclusion;
pub mod convex;
pub(crate) mod covariance;
mod curvature;
mod implied;
pub mod interior_point;
pub(crate) mod multiplier_estimate;
pub(crate) mod other_multipliers;
pub(crate) mod parametric;
mod scaling;
#[cfg(test)]
mod tests;
mod tuning;

use crate::linalg::{PhaseStages, Stages, Triplets};
use crate::problem::{Bounds, Linear, Origin};
pub use covariance::Covariance;
pub(crate) use scaling::objective_unit;
use std::ops::ControlFlow;
use std::sync::Arc;
pub(crate) use tuning::assessment::NO_OBJECTIVE;

/// First and second derivatives at a point, in the order of the structures of the NLP.
#[derive(Clone, Debug, Default)]
pub struct Derivatives {
    /// Gradient of the objective, dense.
    pub gradient: Vec<f64>,
    /// Jacobian values.
    pub jacobian: Vec<f64>,
    /// Values of the lower triangle of the Lagrangian Hessian.
    pub hessian: Vec<f64>,
}

impl Derivatives {
    /// Zeros of the right sizes.
    pub fn new(nlp: &dyn Nlp) -> Self {
        Derivatives {
            gradient: vec![0.0; nlp.variable_bounds().len()],
            jacobian: vec![0.0; nlp.jacobian_structure().len()],
            hessian: vec![0.0; nlp.hessian_structure().len()],
        }
    }
}

/// Where in the problem a constraint or variable belongs, for messages.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Place {
    /// Where in the model.
    pub origin: Origin,
    /// The phase, 0 if there is one only.
    pub phase: usize,
    /// Grid point of the phase, if it belongs to one.
    pub grid_point: Option<usize>,
}

/// Which variables, and which constraints, are one quantity at different times: they have one
/// nominal magnitude.
#[derive(Clone, Debug)]
pub struct Quantities {
    /// The quantity of each variable.
    pub variables: Vec<usize>,
    /// That of each constraint: below `stepped` it is the step of the variables with the same
    /// number.
    pub constraints: Vec<usize>,
    /// How many quantities of variables may have steps.
    pub stepped: usize,
    /// One of the declared unit of each quantity of variables.
    pub units: Vec<f64>,
}

/// A nonlinear program. Evaluations take `&mut self` for working memory only: equal inputs give
/// equal outputs.
pub trait Nlp {
    /// One per variable.
    fn variable_bounds(&self) -> &[Bounds];
    /// One per constraint.
    fn constraint_bounds(&self) -> &[Bounds];
    /// Structure of the Jacobian of the constraints.
    fn jacobian_structure(&self) -> &Triplets;
    /// Structure of the lower triangle of the Lagrangian Hessian.
    fn hessian_structure(&self) -> &Triplets;
    /// The chain of stages, if the NLP is one.
    fn stages(&self) -> Option<Stages>;
    /// The chains of stages, if the NLP is several that are tied together; else nothing.
    fn phases(&self) -> Vec<PhaseStages> {
        Vec::new()
    }
    /// Which variables and constraints are one quantity of the model.
    fn quantities(&self) -> Arc<Quantities>;
    /// The size of an objective whose terms are this large: at least a small part of its unit.
    fn objective_size(&mut self, terms: f64) -> f64;
    /// How much the objective changes at the guess with the sizes of the variables, where that is
    /// less than 1.
    fn objective_unit(&mut self) -> f64;
    /// Objective and constraints.
    fn values(&mut self, v: &[f64], constraints: &mut [f64]) -> f64;
    /// Gradient, Jacobian and the Hessian of `weight * f + multipliers . c`.
    fn derivatives(&mut self, v: &[f64], weight: f64, multipliers: &[f64], out: &mut Derivatives);
    /// Whether derivatives may jump.
    fn has_kinks(&self) -> bool {
        true
    }
    /// Whether a constraint is known to be linear by its structure.
    fn is_linear(&self, _constraint: usize) -> bool {
        false
    }
    /// Where a constraint comes from.
    fn constraint_place(&self, constraint: usize) -> Place;
    /// Which part of the model is not finite at `v`, if any.
    fn not_finite(&mut self, v: &[f64]) -> Option<Place>;
}

/// How a solve ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Status {
    /// A local optimum to the tolerance asked for.
    Solved,
    /// No further progress, but the error is small enough for most uses.
    Acceptable,
    /// A stationary point of the constraint violation that is not feasible.
    Infeasible,
    /// The objective falls without end along feasible points.
    Unbounded,
    /// Too many iterations.
    IterationLimit,
    /// The caller's time is up.
    TimeLimit,
    /// The caller asked to stop.
    Interrupted,
    /// A function has no finite value or derivative at the best iterate.
    NotFinite(Place),
    /// The linear systems cannot be solved any more.
    NumericalFailure,
}

impl Status {
    /// Whether there is an answer: a solution, or what is good enough for most uses.
    pub fn is_solved(&self) -> bool {
        matches!(self, Status::Solved | Status::Acceptable)
    }
}

/// Why the caller wants to stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The time is up.
    TimeLimit,
    /// A person asked.
    Interrupted,
}

impl From<Stop> for Status {
    fn from(stop: Stop) -> Self {
        match stop {
            Stop::TimeLimit => Status::TimeLimit,
            Stop::Interrupted => Status::Interrupted,
        }
    }
}

/// One line of the iteration table.
#[derive(Clone, Copy, Debug, Default)]
pub struct Progress {
    /// Iteration number.
    pub iteration: usize,
    /// Whether this iteration was part of a restoration phase.
    pub restoration: bool,
    /// Objective, unscaled.
    pub objective: f64,
    /// Largest violation of a constraint.
    pub primal_infeasibility: f64,
    /// Largest component of the gradient of the Lagrangian, scaled.
    pub dual_infeasibility: f64,
    /// Barrier parameter.
    pub mu: f64,
    /// Largest component of the step.
    pub step: f64,
    /// Primal regularisation, 0 if none.
    pub regularization: f64,
    /// Step length of the multipliers.
    pub alpha_dual: f64,
    /// Step length of the variables.
    pub alpha_primal: f64,
    /// Trial points of the line search.
    pub trials: usize,
    /// Whether it is an iteration of the conic solver, of which only the number is known.
    pub is_conic: bool,
}

/// Called once per iteration; it may stop the solve.
pub type Watch<'a> = dyn FnMut(&Progress) -> ControlFlow<Stop> + 'a;

/// Options of a solve.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Tolerance on the scaled optimality error.
    pub tol: f64,
    /// Iteration limit.
    pub max_iter: usize,
    /// Factorisation.
    pub linear: Linear,
    /// Whether this is the solve that is asked for, and not one on the way to it: then what is
    /// called solved meets the measures of the program as it was
    /// written, and is no saddle.
    pub is_final: bool,
}

/// Where a solve begins.
#[derive(Clone, Debug, Default)]
pub struct Start {
    /// Variables.
    pub v: Vec<f64>,
    /// What is known of an earlier, similar solve; `None` for a cold start.
    pub warm: Option<Warm>,
}

/// Where an earlier, similar solve ended.
#[derive(Clone, Debug, Default)]
pub struct Warm {
    /// Its multipliers.
    pub multipliers: Multipliers,
    /// The barrier parameter of the scaled NLP to begin with; nothing where it is to leave as much
    /// room as the start violates rows, which is known when there is an NLP.
    pub mu: Option<f64>,
    /// The width of each smoothed surface, where the model names none; else nothing.
    pub widths: Vec<f64>,
}

impl Warm {
    /// A barrier parameter that leaves room for other conditions to become active.
    pub(crate) const ROOM: f64 = 1e-4;
}

impl Start {
    /// Where another solve of the same size ended.
    pub fn after(solution: &Solution) -> Self {
        let (multipliers, mu) = (solution.multipliers.clone(), Some(solution.mu));
        let warm = Warm { multipliers, mu, widths: Vec::new() };
        Start { v: solution.v.clone(), warm: Some(warm) }
    }

    /// The same for an NLP that is not quite the same: other conditions may be active at its
    /// solution, and the barrier leaves them room to become so.
    pub fn near(solution: &Solution) -> Self {
        Start::after(solution).with_room()
    }

    /// The same with room for other conditions to become active.
    pub(crate) fn with_room(mut self) -> Self {
        self.warm.iter_mut().for_each(|warm| warm.mu = warm.mu.map(|mu| mu.max(Warm::ROOM)));
        self
    }
}

/// Multipliers of all constraints.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Multipliers {
    /// One per constraint.
    pub constraints: Vec<f64>,
    /// One per variable: lower bounds, not negative.
    pub lower: Vec<f64>,
    /// One per variable: upper bounds, not negative.
    pub upper: Vec<f64>,
}

impl Multipliers {
    /// Zeros of the right sizes.
    pub fn zeros(nlp: &dyn Nlp) -> Self {
        let bounds = vec![0.0; nlp.variable_bounds().len()];
        Multipliers {
            constraints: vec![0.0; nlp.constraint_bounds().len()],
            lower: bounds.clone(),
            upper: bounds,
        }
    }
}

/// Work done, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Iterations, restoration included.
    pub iterations: usize,
    /// Factorisations.
    pub factorizations: usize,
    /// Factorisations with a primal regularisation.
    pub regularizations: usize,
    /// Evaluations of objective and constraints.
    pub values: usize,
    /// Evaluations of all derivatives.
    pub derivatives: usize,
    /// Restoration phases.
    pub restorations: usize,
}

impl Counts {
    /// Adds the work of another solve.
    pub fn add(&mut self, other: &Counts) {
        self.iterations += other.iterations;
        self.factorizations += other.factorizations;
        self.regularizations += other.regularizations;
        self.values += other.values;
        self.derivatives += other.derivatives;
        self.restorations += other.restorations;
    }
}

/// What a solver found.
#[derive(Clone, Debug)]
pub struct Solution {
    /// How it ended.
    pub status: Status,
    /// Variables: the best iterate, whatever the status.
    pub v: Vec<f64>,
    /// Multipliers.
    pub multipliers: Multipliers,
    /// The barrier parameter of the scaled NLP at the end; 0 where there was none.
    pub mu: f64,
    /// Objective.
    pub objective: f64,
    /// Scaled optimality error.
    pub kkt_error: f64,
    /// What the multipliers say the objective can still gain, relative to its size, in the program
    /// as it was written; infinite on the way to another solve.
    pub improvement: f64,
    /// Largest violation of a constraint or bound.
    pub constraint_violation: f64,
    /// Whether the optimum is known to be global.
    pub global: bool,
    /// Whether a direction along which the objective falls to second order was found at the end,
    /// and could not be followed.
    pub is_saddle: bool,
    /// A point near by where the Lagrangian is lower, though neither slope nor curvature says so:
    /// another solve may begin there.
    pub descent: Option<Vec<f64>>,
    /// Work done.
    pub counts: Counts,
}

impl Solution {
    /// The same without variables and multipliers, which are as many as all phases have.
    pub fn without_vectors(&self) -> Self {
        Solution {
            status: self.status.clone(),
            v: Vec::new(),
            multipliers: Multipliers::default(),
            descent: None,
            ..*self
        }
    }
}

/// By how much each constraint is violated at `v`.
pub fn violations(nlp: &mut dyn Nlp, v: &[f64]) -> Vec<f64> {
    let mut rows = vec![0.0; nlp.constraint_bounds().len()];
    nlp.values(v, &mut rows);
    let all = nlp.constraint_bounds().iter().zip(&rows);
    all.map(|(bounds, value)| bounds.violation(*value)).collect()
}

/// Largest violation of constraints and bounds at `v`.
pub fn constraint_violation(nlp: &mut dyn Nlp, v: &[f64]) -> f64 {
    objective_and_violation(nlp, v).1
}

/// The objective at `v`, and the largest violation of constraints and bounds there.
fn objective_and_violation(nlp: &mut dyn Nlp, v: &[f64]) -> (f64, f64) {
    let mut rows = vec![0.0; nlp.constraint_bounds().len()];
    let objective = nlp.values(v, &mut rows);
    let each = |bounds: &[Bounds], values: &[f64]| {
        bounds.iter().zip(values).map(|(it, value)| it.violation(*value)).fold(0.0, f64::max)
    };
    (objective, each(nlp.constraint_bounds(), &rows).max(each(nlp.variable_bounds(), v)))
}
