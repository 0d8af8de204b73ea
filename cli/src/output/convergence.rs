//! How a solve went: a row for each iteration.

use fdcc_runtime::nlp::Progress;
use fdcc_runtime::solve::Level;
use serde::Serialize;

/// Columns with an entry for each iteration.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Convergence {
    pub iteration: Vec<usize>,
    pub objective: Vec<f64>,
    pub constraint_violation: Vec<f64>,
    /// The part of the optimality error that multipliers leave.
    pub dual_infeasibility: Vec<f64>,
    /// The largest width of smoothing; 0 where nothing is smoothed.
    pub sigma: Vec<f64>,
    #[serde(rename = "N")]
    pub n: Vec<usize>,
}

impl Convergence {
    /// Whether nothing was written down.
    pub fn is_empty(&self) -> bool {
        self.iteration.is_empty()
    }

    /// One more iteration.
    pub fn push(&mut self, progress: &Progress, level: Level) {
        self.iteration.push(progress.iteration);
        self.objective.push(progress.objective);
        self.constraint_violation.push(progress.primal_infeasibility);
        self.dual_infeasibility.push(progress.dual_infeasibility);
        self.sigma.push(level.sigma.iter().copied().fold(0.0, f64::max));
        self.n.push(level.intervals);
    }
}
