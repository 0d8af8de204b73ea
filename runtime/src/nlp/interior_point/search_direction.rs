//! the search direction, a Newton step of the barrier problem.

use super::algorithm::Algorithm;
use super::error_scaling::objective_scale;
use super::kkt::System;
use super::tuning::algorithm::{LARGEST_MULTIPLIER, NEARLY_FEASIBLE};

impl Algorithm {
    /// The Newton step with the right inertia; `false` if the linear system could not be solved.
    /// Where rows seem to depend on each other the regularised one, if there is one.
    pub(super) fn find_step(&mut self) -> bool {
        let found = self.newton_step(false);
        if found && self.rows_seem_dependent() && !self.newton_step(true) {
            return self.newton_step(false);
        }
        found
    }

    /// Whether a step from a point that is far from feasible leads to multipliers out of
    /// proportion: rows that depend on each other cannot all be met, and rounding may hide that
    /// from the inertia.
    fn rows_seem_dependent(&self) -> bool {
        let most = LARGEST_MULTIPLIER * objective_scale(self.values.objective);
        let mut ahead = self
            .at
            .lambda
            .iter()
            .zip(&self.step.lambda)
            .map(|(lambda, step)| (lambda + step).abs());
        self.values.largest() > NEARLY_FEASIBLE && ahead.any(|lambda| lambda > most)
    }

    fn newton_step(&mut self, are_dependent: bool) -> bool {
        let Algorithm { formulation, at, slopes, kkt, counts, step, values, .. } = self;
        let mu = self.barrier.mu;
        let system = System { formulation, at, slopes, mu };
        kkt.factor_with_inertia(formulation, slopes, mu, are_dependent, counts)
            && kkt.step(&system, &values.residuals, step)
    }
}
