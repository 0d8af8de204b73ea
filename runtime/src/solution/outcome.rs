//! What a solve of a problem ends with: plain data.

use super::modes::Span;
use super::trajectory::Trajectory;
use crate::nlp::Solution;
use crate::problem::Origin;

/// A solved (or not solved) chain of phases.
#[derive(Clone, Debug)]
pub struct ChainOutcome {
    /// The last solution of all phases and links together; its counts are those of all solves.
    pub solution: Solution,
    /// Each phase by itself: its part of the solution, with the status and the objective of the
    /// whole.
    pub phases: Vec<Outcome>,
    /// The smoothing width of each surface at the end, phase by phase.
    pub sigma: Vec<f64>,
    /// See [`Outcome::convex`].
    pub convex: bool,
    /// See [`Outcome::limiting`].
    pub limiting: Option<Limiting>,
    /// See [`Outcome::is_impossible`].
    pub is_impossible: bool,
    /// See [`Outcome::attempts`].
    pub attempts: Vec<Attempt>,
}

impl ChainOutcome {
    /// That of a chain of one phase, from that of the phase.
    pub fn single(outcome: Outcome) -> Self {
        let Outcome { solution, sigma, convex, limiting, is_impossible, attempts, .. } =
            outcome.clone();
        let phases = vec![outcome];
        ChainOutcome { solution, phases, sigma, convex, limiting, is_impossible, attempts }
    }

    /// That of a chain of one phase.
    pub fn into_single(mut self) -> Outcome {
        let ChainOutcome { convex, limiting, is_impossible, attempts, .. } = self;
        let first = self.phases.swap_remove(0);
        Outcome { convex, limiting, is_impossible, attempts, ..first }
    }
}

/// A solved (or not solved) problem of one phase.
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
    /// The phase, 0 if there is one only.
    pub phase: usize,
    /// The time of its largest violation, if it belongs to one.
    pub time: Option<f64>,
    /// How far it is violated.
    pub violation: f64,
    /// The sum over all times.
    pub in_all: f64,
}
