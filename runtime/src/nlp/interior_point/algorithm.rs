//! The loop: algorithm A of Waechter & Biegler 2006. Its steps are named where they are
//! taken; A-1, the start, is in [`initialisation`](super::initialisation).

use super::barrier::{Barrier, Terms};
use super::filter::Filter;
use super::formulation::Formulation;
use super::iterate::{Iterate, SearchDirection, Slopes, Values};
use super::kkt::Kkt;
use super::residuals::Residuals;
use super::restoration::Restored;
use super::termination::Target;
use super::tuning::algorithm::MOST_RESTARTS;
use super::tuning::restoration::REQUIRED_DECREASE;
use super::tuning::saddle::CREEPING_STEPS;
use super::tuning::termination::ACCEPTABLE_ERROR;
use super::watchdog::Watchdog;
use crate::nlp::assessment::Assessment;
use crate::nlp::{Counts, Nlp, Options, Progress, Status, Watch};
use std::ops::ControlFlow;

/// What one iteration led to.
pub(super) enum Outcome {
    Continue,
    /// The line search found no acceptable step.
    Blocked,
    Done(Status),
}

/// The state of a solve. It does not own the NLP, so that a restoration phase can be run by
/// another one.
pub(super) struct Algorithm {
    pub(super) formulation: Formulation,
    pub(super) at: Iterate,
    pub(super) values: Values,
    pub(super) slopes: Slopes,
    pub(super) barrier: Barrier,
    pub(super) filter: Filter,
    pub(super) kkt: Kkt,
    pub(super) step: SearchDirection,
    pub(super) options: Options,
    pub(super) counts: Counts,
    pub(super) progress: Progress,
    pub(super) residuals: Residuals,
    /// Iterates in a row whose error is acceptable.
    pub(super) acceptable: usize,
    /// Tiny steps in a row.
    pub(super) tiny_steps: usize,
    /// Accepted steps in a row that were cut down to rounding.
    pub(super) stalled_steps: usize,
    pub(super) watchdog: Watchdog,
    /// How often the filter was emptied at a feasible point.
    pub(super) emptied: usize,
    /// Whether constraints were given the values that they have, because a violation below the
    /// acceptable one could not be mended.
    pub(super) is_relaxed: bool,
    pub(super) target: Target,
    /// Whole regularised steps in a row, and how many of them are looked at.
    pub(super) creeping: usize,
    pub(super) creeping_limit: usize,
    /// How often a saddle was left.
    pub(super) departures: usize,
    /// Whether the iterate is one that could not be left.
    pub(super) is_saddle: bool,
    /// A point near by where the Lagrangian is lower, if the iterate is no minimum though neither
    /// slope nor curvature says so.
    pub(super) descent: Option<Vec<f64>>,
    /// The measures of the scaled program at the iterate that is called solved or acceptable.
    pub(super) assessed: Option<Assessment>,
    /// The last Newton decrement that was looked at, in units of the scaled objective.
    pub(super) decrement: f64,
    /// Whether the derivatives belong to the iterate.
    pub(super) fresh: bool,
    /// The iterate with the least error, if that is acceptable.
    pub(super) best: Option<(Iterate, Residuals)>,
    /// How often in a row the objective has fallen far away from the start, and what it was last.
    pub(super) falls: (usize, f64),
}

impl Algorithm {
    pub(super) fn new(
        nlp: &dyn Nlp,
        formulation: Formulation,
        at: Iterate,
        mu: f64,
        options: Options,
    ) -> Self {
        Algorithm {
            kkt: Kkt::new(nlp, &formulation, options.linear),
            step: SearchDirection::new(&formulation),
            slopes: Slopes::new(nlp, &formulation),
            values: Values::default(),
            barrier: Barrier::new(mu, options.tol),
            filter: Filter::new(0.0),
            counts: Counts::default(),
            progress: Progress::default(),
            residuals: Residuals::default(),
            acceptable: 0,
            tiny_steps: 0,
            stalled_steps: 0,
            watchdog: Watchdog::default(),
            emptied: 0,
            is_relaxed: false,
            target: Target::new(options.tol),
            creeping: 0,
            creeping_limit: CREEPING_STEPS,
            departures: 0,
            is_saddle: false,
            descent: None,
            assessed: None,
            decrement: f64::INFINITY,
            fresh: false,
            best: None,
            falls: (0, f64::INFINITY),
            formulation,
            at,
            options,
        }
    }

    /// Iterates to the end, with restoration phases where the line search is stuck.
    pub(super) fn run(&mut self, nlp: &mut dyn Nlp, watch: &mut Watch) -> Status {
        if self.formulation.has_crossed_bounds() {
            return self.end_unseen(Status::Infeasible, nlp);
        }
        loop {
            match self.iterate(nlp, watch) {
                Outcome::Continue => {}
                Outcome::Done(status) => return status,
                Outcome::Blocked => {
                    if self.residuals.error(0.0) <= ACCEPTABLE_ERROR {
                        return self.stalled(nlp);
                    }
                    if let Some(status) = self.restore_or_stop(nlp, watch) {
                        return status;
                    }
                }
            }
        }
    }

    /// a restoration phase, begun anew from where it is if it gets stuck itself. It ends the
    /// solve if the smallest violation near by is one; if it is none, the filter has become too
    /// strict and is emptied.
    fn restore_or_stop(&mut self, nlp: &mut dyn Nlp, watch: &mut Watch) -> Option<Status> {
        for _ in 0..MOST_RESTARTS {
            match self.restore(nlp, REQUIRED_DECREASE, watch) {
                Restored::Acceptable => return None,
                Restored::Stopped(status) => return Some(status),
                Restored::Blocked => {}
                Restored::Stationary if self.values.largest() > self.options.tol => {
                    return self.relax(nlp).then_some(Status::Infeasible);
                }
                Restored::Stationary => return self.loosen_or_stop(nlp),
            }
        }
        self.loosen_or_stop(nlp)
    }

    /// Where a feasible point leads nowhere, or no restoration gets on: first bounds are moved
    /// outwards by the tolerance, because what they enclose may have no interior, then only the
    /// filter is emptied.
    fn loosen_or_stop(&mut self, nlp: &mut dyn Nlp) -> Option<Status> {
        self.emptied += 1;
        if self.emptied > MOST_RESTARTS {
            return Some(Status::NumericalFailure);
        }
        if self.formulation.widened == 0.0 {
            self.formulation.widen(self.options.tol);
            self.values.terms = Terms::new(&self.formulation, &self.at.y);
        }
        self.begin_anew(nlp);
        None
    }

    /// From here on with new multipliers and an empty filter.
    pub(super) fn begin_anew(&mut self, nlp: &mut dyn Nlp) {
        self.watchdog.end();
        self.best = None;
        self.resume(nlp);
        self.filter.clear();
    }

    /// Accepts the smallest violation near by, if it is acceptable, as none: a smoothed block comes
    /// to rest only in the limit. Then an optimum is no more than acceptable either. `true` if the
    /// violation is too large, or this was done before.
    pub(super) fn relax(&mut self, nlp: &mut dyn Nlp) -> bool {
        if self.is_relaxed || self.values.largest() > ACCEPTABLE_ERROR {
            return true;
        }
        self.is_relaxed = true;
        self.values.relax(&mut self.formulation);
        self.begin_anew(nlp);
        false
    }

    /// One iteration, steps.
    pub(super) fn iterate(&mut self, nlp: &mut dyn Nlp, watch: &mut Watch) -> Outcome {
        let is_finite = self.values.is_finite()
            && (self.fresh
                || self.slopes.evaluate(nlp, &self.formulation, &self.at, &mut self.counts));
        if !is_finite {
            if self.go_back() {
                return Outcome::Continue;
            }
            let place =
                nlp.not_finite(&self.at.y[..self.formulation.variables]).unwrap_or_default();
            return Outcome::Done(Status::NotFinite(place));
        }
        // convergence for the NLP.
        self.fresh = true;
        self.residuals = Residuals::new(&self.formulation, &self.at, &self.values, &self.slopes);
        if let ControlFlow::Break(stop) = watch(&self.report()) {
            return Outcome::Done(stop.into());
        }
        if let Some(status) = self.finished(nlp) {
            return Outcome::Done(status);
        }
        if self.leaves_creeping(nlp) {
            return Outcome::Continue;
        }
        // convergence for the barrier problem; then the next one, with an empty filter.
        if self.barrier.update(&self.residuals) {
            self.filter.clear();
            self.watchdog.end();
            self.tiny_steps = 0;
        }
        // search direction.
        if self.watchdog.is_due() {
            self.kkt.caution = 0.0;
        }
        self.kkt.assemble(&self.formulation, &self.at, &self.slopes, &self.barrier);
        let has_step = self.find_step();
        if !has_step && self.go_back() {
            return Outcome::Continue;
        }
        let has_step = has_step || (self.kkt.fall_back(nlp, &self.formulation) && self.find_step());
        // A-5 to A-8: line search, and the next iterate.
        if has_step { self.take_step(nlp) } else { Outcome::Blocked }
    }

    fn report(&mut self) -> Progress {
        self.progress = Progress {
            iteration: self.counts.iterations,
            objective: self.values.objective,
            primal_infeasibility: self.residuals.primal,
            dual_infeasibility: self.residuals.dual,
            mu: self.barrier.mu,
            ..self.progress
        };
        self.progress
    }

    /// Multipliers of the constraints by least squares at the iterate.
    pub(super) fn estimate_multipliers(&mut self, nlp: &mut dyn Nlp) {
        self.at.lambda.fill(0.0);
        if self.slopes.evaluate(nlp, &self.formulation, &self.at, &mut self.counts) {
            self.kkt.estimate_multipliers(&self.formulation, &mut self.at, &self.slopes);
        }
        self.fresh = false;
    }
}
