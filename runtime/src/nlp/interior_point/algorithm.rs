//! The loop: algorithm A of Waechter & Biegler 2006. Its steps are named where they are
//! taken; A-1, the start, is in [`initialization`](super::initialization).

use super::barrier::{Barrier, Terms};
use super::error_scaling::objective_scale;
use super::filter::Filter;
use super::formulation::Formulation;
use super::iterate::{Iterate, Slopes, Step, Values};
use super::kkt::{Kkt, System};
use super::line_search::{Accepted, Search};
use super::residuals::Residuals;
use super::restoration::Restored;
use super::termination::Target;
use super::tuning::algorithm::{
    LARGEST_MULTIPLIER, MOST_RESTARTS, MOST_TINY_STEPS, NEARLY_FEASIBLE, TINY_STEP,
};
use super::tuning::restoration::REQUIRED_DECREASE;
use super::tuning::termination::ACCEPTABLE_ERROR;
use super::vectors::{add_scaled, largest};
use super::watchdog::Watchdog;
use crate::nlp::{Counts, Nlp, Options, Progress, Status, Stop, Watch};
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
    pub(super) step: Step,
    pub(super) options: Options,
    pub(super) counts: Counts,
    pub(super) progress: Progress,
    pub(super) residuals: Residuals,
    pub(super) acceptable: usize,
    pub(super) tiny_steps: usize,
    /// Accepted steps in a row that were cut down to rounding.
    pub(super) stalled_steps: usize,
    pub(super) watchdog: Watchdog,
    /// How often the filter was emptied at a feasible point.
    pub(super) emptied: usize,
    /// Whether rows were given the values that they have, because a violation below the acceptable
    /// one could not be mended.
    pub(super) is_relaxed: bool,
    pub(super) target: Target,
    /// How often a saddle was left.
    pub(super) departures: usize,
    /// Whether the iterate is one that could not be left.
    pub(super) is_saddle: bool,
    /// A point near by where the Lagrangian is lower, if the iterate is no minimum though neither
    /// slope nor curvature says so.
    pub(super) descent: Option<Vec<f64>>,
    /// The last Newton decrement that was looked at, in units of the scaled objective.
    pub(super) decrement: f64,
    /// Whether the derivatives belong to the iterate.
    pub(super) fresh: bool,
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
            step: Step::new(&formulation),
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
            departures: 0,
            is_saddle: false,
            descent: None,
            decrement: f64::INFINITY,
            fresh: false,
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
            return Outcome::Done(if stop == Stop::TimeLimit {
                Status::TimeLimit
            } else {
                Status::Interrupted
            });
        }
        if let Some(status) = self.finished(nlp) {
            return Outcome::Done(status);
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

    /// The Newton step with the right inertia; `false` if the linear system could not be solved.
    /// Where rows seem to depend on each other the regularised one, if there is one.
    fn find_step(&mut self) -> bool {
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

    /// backtracking line search, or watchdog steps without one.
    fn take_step(&mut self, nlp: &mut dyn Nlp) -> Outcome {
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
    fn go_back(&mut self) -> bool {
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
        self.barrier.note(alpha, is_newton);
        self.barrier.correct_multipliers(&self.formulation, &mut self.at);
        self.counts.iterations += 1;
        self.fresh = false;
        self.progress.step = largest(&self.step.y);
        self.progress.regularization = self.kkt.regularization;
        self.progress.alpha_primal = alpha;
        self.progress.alpha_dual = dual;
    }

    /// Row multipliers by least squares at the iterate.
    pub(super) fn estimate_multipliers(&mut self, nlp: &mut dyn Nlp) {
        self.at.lambda.fill(0.0);
        if self.slopes.evaluate(nlp, &self.formulation, &self.at, &mut self.counts) {
            self.kkt.estimate_multipliers(&self.formulation, &mut self.at, &self.slopes);
        }
        self.fresh = false;
    }
}
