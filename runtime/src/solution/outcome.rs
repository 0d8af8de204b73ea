//! What a solve of a problem ends with: plain data.

use super::modes::Span;
use super::trajectory::Trajectory;
use crate::nlp::Solution;
use crate::problem::Origin;

/// A solved (or not solved) problem.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The last solution; its counts are those of all solves together.
    pub solution: Solution,
    /// The same in the words of the model.
    pub trajectory: Trajectory,
    /// The smoothing width of each surface at the end.
    pub sigma: Vec<f64>,
    /// The modes of each surface.
    pub modes: Vec<Vec<Span>>,
    /// Whether the conic solver was used.
    pub convex: bool,
    /// The worst row, by name and time, if the point is not feasible.
    pub limiting: Option<Limiting>,
    /// Whether it is proved that no point meets the conditions of the transcribed problem; only
    /// with [`Status::Infeasible`](crate::nlp::Status::Infeasible), which by itself says what was
    /// found from one start.
    pub is_impossible: bool,
    /// All solves that led to this end, in their order.
    pub attempts: Vec<Attempt>,
}

/// One solve, told where nothing was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Attempt {
    /// Intervals of its grid.
    pub intervals: usize,
    /// The smoothing width of each surface.
    pub sigma: Vec<f64>,
}

/// The constraint that is violated most.
#[derive(Clone, Debug, PartialEq)]
pub struct Limiting {
    /// Where it stands in the model.
    pub origin: Origin,
    /// Where it is a step of a differential equation: the condition that stands against the
    /// equations most.
    pub condition: Option<Origin>,
    /// The time of its largest violation, if it belongs to one.
    pub time: Option<f64>,
    /// How far it is violated.
    pub violation: f64,
}
