//! When an iteration ends, and with which word.
//!
//! The error of the scaled optimality conditions says when to look at the measures of the program
//! as it was written ([`Assessment`]). Where these are not met the target of the
//! error is lowered. Where they are, a point is a solution unless its reduced Hessian has a
//! negative eigenvalue, along which it is left.

use super::algorithm::Algorithm;
use super::iterate::SearchDirection;
use super::kkt::System;
use super::residuals::weighted_violation;
use super::saddle::Departure;
use super::tuning::termination::{
    ACCEPTABLE_ERROR, ACCEPTABLE_ITERATIONS, DIVERGED, FALLEN, FALLS, FASTEST, LEAST_FALL,
    LEAST_TARGET, MOST_WEIGHTED_VIOLATION, PATIENCE, SLOWEST,
};
use super::vectors::largest;
use crate::nlp::assessment::Assessment;
use crate::nlp::{Multipliers, Nlp, Status};

/// The error at which the measures are looked at.
#[derive(Clone, Copy)]
pub(super) struct Target {
    pub(super) error: f64,
    /// The iteration at which it was lowered first.
    lowered: Option<usize>,
}

impl Target {
    pub(super) fn new(error: f64) -> Self {
        Target { error, lowered: None }
    }
}

impl Algorithm {
    /// The status, if this is the end.
    pub(super) fn finished(&mut self, nlp: &mut dyn Nlp) -> Option<Status> {
        let error = self.residuals.error(0.0);
        self.note_best(error);
        // Watchdog steps say nothing of the point that they began at.
        if self.watchdog.saved.is_none() {
            self.acceptable = if error <= ACCEPTABLE_ERROR { self.acceptable + 1 } else { 0 };
        }
        if error <= self.target.error && self.is_weighted_violation_small() {
            self.concluded(nlp)
        } else if self.is_out_of_patience() {
            Some(self.stalled(nlp))
        } else if self.acceptable >= ACCEPTABLE_ITERATIONS {
            Some(self.settled(nlp))
        } else if self.watchdog.saved.is_none() && self.has_diverged(nlp) {
            Some(Status::Unbounded)
        } else if self.counts.iterations >= self.options.max_iter {
            self.return_to_best();
            Some(Status::IterationLimit)
        } else {
            None
        }
    }

    /// Where a direction is flat, steps along it spoil what was found before.
    fn note_best(&mut self, error: f64) {
        let least = self.best.as_ref().map_or(ACCEPTABLE_ERROR, |it| it.1.error(0.0));
        if error < least {
            self.best = Some((self.at.clone(), self.residuals));
        }
    }

    fn return_to_best(&mut self) {
        if let Some((at, residuals)) = self.best.take() {
            (self.at, self.residuals) = (at, residuals);
        }
    }

    /// The status where the error has been acceptable for long; if that is at a saddle, to which
    /// regularised steps are slow, with a point beside it.
    fn settled(&mut self, nlp: &mut dyn Nlp) -> Status {
        if self.options.is_final && !self.is_relaxed {
            let found = self.assessment(nlp);
            self.descent = self.descent_by_curvature(nlp, &found);
        }
        Status::Acceptable
    }

    /// What the measures say at a point where the error is as small as asked for; nothing where the
    /// iteration goes on.
    fn concluded(&mut self, nlp: &mut dyn Nlp) -> Option<Status> {
        if self.is_relaxed {
            return Some(Status::Acceptable);
        }
        if !self.options.is_final {
            return Some(Status::Solved);
        }
        let found = self.assessment(nlp);
        match self.departure(nlp, &found) {
            Departure::Taken => return None,
            Departure::Impossible => return Some(Status::Acceptable),
            Departure::NotNeeded if self.hides_curvature(nlp, &found) => {
                // Where rounding is larger than what it hides, nobody knows.
                return if self.can_lower_target(&found) { None } else { Some(Status::Acceptable) };
            }
            Departure::NotNeeded => {}
        }
        let found = self.with_decrement(nlp, found);
        if found.is_enough(self.options.tol) || !self.can_lower_target(&found) {
            return Some(self.word(nlp, &found));
        }
        None
    }

    /// The status where nothing more can be gained.
    pub(super) fn stalled(&mut self, nlp: &mut dyn Nlp) -> Status {
        if !self.options.is_final || self.is_relaxed || self.is_saddle {
            return Status::Acceptable;
        }
        let found = self.assessment(nlp);
        let found = self.with_decrement(nlp, found);
        self.word(nlp, &found)
    }

    fn word(&mut self, nlp: &mut dyn Nlp, found: &Assessment) -> Status {
        self.assessed = Some(*found);
        self.descent = self.descent_from_kink(nlp, found);
        if !found.is_convincing(self.options.tol) {
            return Status::Acceptable;
        }
        self.descent = self.descent.take().or_else(|| self.descent_of_higher_order(nlp, found));
        Status::Solved
    }

    /// With the Newton decrement where that is what matters.
    fn with_decrement(&mut self, nlp: &dyn Nlp, found: Assessment) -> Assessment {
        if !found.is_only_steep(self.options.tol) {
            return found;
        }
        self.decrement = self.newton_decrement(nlp, &found).unwrap_or(f64::INFINITY);
        found.with_decrement(self.decrement)
    }

    /// What Newton's step gains in the quadratic model; nothing where the model has no minimum.
    fn newton_decrement(&mut self, nlp: &dyn Nlp, found: &Assessment) -> Option<f64> {
        let least = self.least_curvature(nlp, found);
        let Algorithm { formulation, at, slopes, kkt, barrier, counts, values, .. } = self;
        let (mu, mut step) = (barrier.mu, SearchDirection::new(formulation));
        kkt.assemble(formulation, at, slopes, barrier);
        let system = System { formulation, at, slopes, mu };
        let is_found = kkt.factor_barely(formulation, slopes, mu, least, counts)
            && kkt.step(&system, &values.residuals, &mut step);
        is_found.then(|| kkt.slope(&step).abs())
    }

    pub(super) fn assessment(&self, nlp: &mut dyn Nlp) -> Assessment {
        let variables = self.formulation.variables;
        let multipliers = Multipliers {
            constraints: self.at.lambda.clone(),
            lower: self.at.lower[..variables].to_vec(),
            upper: self.at.upper[..variables].to_vec(),
        };
        Assessment::new(nlp, &self.at.y[..variables], &multipliers)
    }

    /// Lowers the target as far as the measures are missed; `false` where it is as low as it gets.
    fn can_lower_target(&mut self, found: &Assessment) -> bool {
        let missed = found.missed(self.options.tol).clamp(FASTEST, SLOWEST);
        let error = missed * self.target.error;
        if error.is_nan() || error < LEAST_TARGET * self.options.tol {
            return false;
        }
        let lowered = self.target.lowered.or(Some(self.counts.iterations));
        self.target = Target { error, lowered };
        self.barrier.aim_at(error);
        true
    }

    fn is_out_of_patience(&self) -> bool {
        self.target.lowered.is_some_and(|at| self.counts.iterations > at + PATIENCE)
    }

    /// Whether violations change the objective so little that it can be believed.
    fn is_weighted_violation_small(&self) -> bool {
        weighted_violation(&self.formulation, &self.at, &self.values)
            <= MOST_WEIGHTED_VIOLATION * self.options.tol
    }

    /// Whether the objective falls by a part of itself again and again where variables are far
    /// away: that these are large says nothing, as their optimum may be there. Or where it is so
    /// low as it gets at no finite answer: exponential functions fall before variables are far.
    fn has_diverged(&mut self, nlp: &dyn Nlp) -> bool {
        let largest = largest(&self.at.y[..self.formulation.variables]);
        let (falls, before) = self.falls;
        let objective = self.values.objective;
        let is_far = self.residuals.primal <= self.options.tol * largest.max(1.0)
            && (objective < -FALLEN
                || largest > DIVERGED && largest > DIVERGED * farthest_bound(nlp));
        let is_falling = is_far && objective < before - LEAST_FALL * before.abs();
        self.falls = (if is_falling { falls + 1 } else { 0 }, objective);
        self.falls.0 >= FALLS
    }
}

/// The largest finite bound of a variable, at least 1.
fn farthest_bound(nlp: &dyn Nlp) -> f64 {
    let ends = nlp.variable_bounds().iter().flat_map(|it| [it.lower.abs(), it.upper.abs()]);
    ends.filter(|end| end.is_finite()).fold(1.0, f64::max)
}
