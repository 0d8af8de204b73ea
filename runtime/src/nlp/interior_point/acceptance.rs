//! a step is searched, and taken.

use super::algorithm::{Algorithm, Outcome};
use super::iterate::Values;
use super::line_search::{Accepted, Search};
use super::tuning::algorithm::{MOST_TINY_STEPS, TINY_STEP};
use super::tuning::barrier::WHOLE;
use super::tuning::termination::ACCEPTABLE_ERROR;
use super::vectors::{add_scaled, largest};
use crate::nlp::{Nlp, Status};

impl Algorithm {
    /// backtracking line search, or watchdog steps without one.
    pub(super) fn take_step(&mut self, nlp: &mut dyn Nlp) -> Outcome {
        let formulation = &self.formulation;
        let (longest, dual) = self.barrier.longest_steps(formulation, &self.at, &self.step);
        if self.is_tiny() {
            return self.accept_tiny(nlp, longest, dual);
        }
        let mut search = Search {
            nlp,
            formulation,
            barrier: &self.barrier,
            kkt: &mut self.kkt,
            at: &self.at,
            values: &self.values,
            slopes: &self.slopes,
            counts: &mut self.counts,
        };
        let accepted = if self.watchdog.is_due() {
            let reference = search.reference(&self.step);
            self.watchdog.begin(self.at.clone(), self.values.clone(), reference, longest);
            search.full(&mut self.filter, &self.step, longest, reference, longest)
        } else if let Some(saved) = &self.watchdog.saved {
            search.full(&mut self.filter, &self.step, longest, saved.reference, saved.alpha)
        } else {
            let accepted = search.run(&mut self.filter, &mut self.step, longest);
            let Some(accepted) = accepted else { return Outcome::Blocked };
            Some((accepted, true))
        };
        self.tiny_steps = 0;
        self.settle(accepted, longest, dual)
    }

    /// takes an accepted step or a watchdog step, or goes back to where the watchdog began.
    fn settle(&mut self, accepted: Option<(Accepted, bool)>, longest: f64, dual: f64) -> Outcome {
        match accepted {
            Some((accepted, acceptable)) if acceptable || self.watchdog.take_step() => {
                if acceptable && self.watchdog.end().is_none() {
                    self.watchdog.note(accepted.alpha / longest, self.kkt.caution > 0.0);
                    self.kkt.judge(accepted.alpha / longest);
                }
                self.progress.trials = accepted.trials;
                self.stalled_steps =
                    if self.is_negligible(accepted.alpha) { self.stalled_steps + 1 } else { 0 };
                self.move_to(accepted.y, accepted.values, accepted.alpha, dual);
                if self.stalled_steps > MOST_TINY_STEPS {
                    self.stalled_steps = 0;
                    self.watchdog.end();
                    return Outcome::Blocked;
                }
            }
            _ => {
                self.go_back();
            }
        }
        Outcome::Continue
    }

    /// Back to where watchdog steps began; `false` if there were none.
    pub(super) fn go_back(&mut self) -> bool {
        let Some(saved) = self.watchdog.end() else { return false };
        (self.at, self.values, self.fresh) = (saved.at, saved.values, false);
        self.counts.iterations += 1;
        true
    }

    fn is_tiny(&self) -> bool {
        self.is_negligible(1.0) && self.residuals.primal < ACCEPTABLE_ERROR
    }

    /// Whether this fraction of the step is rounding.
    fn is_negligible(&self, alpha: f64) -> bool {
        let small = |(d, y): (&f64, &f64)| alpha * d.abs() <= TINY_STEP * (1.0 + y.abs());
        self.step.y.iter().zip(&self.at.y).all(small)
    }

    /// A step that is rounding is taken without a search, and lowers the barrier parameter; when
    /// that is as low as it gets and the multipliers have settled as well, nothing more can be
    /// gained.
    fn accept_tiny(&mut self, nlp: &mut dyn Nlp, alpha: f64, dual: f64) -> Outcome {
        self.tiny_steps = if self.barrier.lower() { 0 } else { self.tiny_steps + 1 };
        if self.tiny_steps > MOST_TINY_STEPS {
            let error = self.residuals.error(0.0);
            let is_small = error <= ACCEPTABLE_ERROR;
            return Outcome::Done(if is_small {
                self.stalled(nlp)
            } else {
                Status::NumericalFailure
            });
        }
        let y: Vec<f64> = self.at.y.iter().zip(&self.step.y).map(|(y, d)| y + alpha * d).collect();
        let mut values = Values::default();
        if !values.evaluate(nlp, &self.formulation, &y, &mut self.counts) {
            return Outcome::Blocked;
        }
        self.move_to(y, values, alpha, dual);
        Outcome::Continue
    }

    fn move_to(&mut self, y: Vec<f64>, values: Values, alpha: f64, dual: f64) {
        self.at.y = y;
        self.values = values;
        add_scaled(&mut self.at.lambda, &self.step.lambda, alpha);
        add_scaled(&mut self.at.lower, &self.step.lower, dual);
        add_scaled(&mut self.at.upper, &self.step.upper, dual);
        let is_newton = self.kkt.regularization == 0.0 && self.watchdog.saved.is_none();
        let is_creeping = !self.kkt.is_newton() && self.watchdog.saved.is_none();
        self.creeping = if is_creeping && alpha >= WHOLE { self.creeping + 1 } else { 0 };
        self.barrier.note(alpha, is_newton);
        self.barrier.correct_multipliers(&self.formulation, &mut self.at);
        self.counts.iterations += 1;
        self.fresh = false;
        self.progress.step = largest(&self.step.y);
        self.progress.regularization = self.kkt.regularization;
        self.progress.alpha_primal = alpha;
        self.progress.alpha_dual = dual;
    }
}
