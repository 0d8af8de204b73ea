//! The line search that asks the filter about pairs (violation, barrier objective) (Waechter &
//! Biegler 2006, algorithm A and section 2.4).

use super::barrier::Barrier;
use super::filter::{Filter, Reference};
use super::formulation::Formulation;
use super::iterate::{Iterate, SearchDirection, Slopes, Values};
use super::kkt::{Kkt, System};
use super::tuning::line_search::{CORRECTION_DECREASE, MOST_CORRECTIONS};
use crate::nlp::{Counts, Nlp};

/// What a line search works with.
pub(super) struct Search<'a> {
    pub(super) nlp: &'a mut dyn Nlp,
    pub(super) formulation: &'a Formulation,
    pub(super) barrier: &'a Barrier,
    pub(super) kkt: &'a mut Kkt,
    pub(super) at: &'a Iterate,
    pub(super) values: &'a Values,
    pub(super) slopes: &'a Slopes,
    pub(super) counts: &'a mut Counts,
}

/// An accepted trial point: `step` may have been corrected.
pub(super) struct Accepted {
    pub(super) y: Vec<f64>,
    pub(super) values: Values,
    pub(super) alpha: f64,
    pub(super) trials: usize,
}

impl Search<'_> {
    /// backtracks from the longest step; `None` where the step has become too
    /// short.
    pub(super) fn run(
        &mut self,
        filter: &mut Filter,
        step: &mut SearchDirection,
        longest: f64,
    ) -> Option<Accepted> {
        let from = self.reference(step);
        let smallest = filter.smallest_step(from);
        let (mut alpha, mut trials) = (longest, 0);
        while alpha >= smallest || trials == 0 {
            trials += 1;
            //
            let trial = self.trial(step, alpha);
            // the filter.
            if let Some((_, values)) = &trial
                && self.accept(filter, from, alpha, values)
            {
                return trial.map(|(y, values)| Accepted { y, values, alpha, trials });
            }
            //
            if let Some((_, values)) = trial
                && trials == 1
                && values.violation >= from.theta
                && let Some(accepted) = self.correct(filter, from, step, alpha, values)
            {
                return Some(accepted);
            }
            //
            alpha *= 0.5;
        }
        None
    }

    /// What a step from here is compared with.
    pub(super) fn reference(&self, step: &SearchDirection) -> Reference {
        Reference {
            theta: self.values.violation,
            phi: self.barrier.value(self.values),
            slope: Barrier::slope(self.formulation, self.slopes, self.kkt.barrier_gradient(), step),
        }
    }

    /// The longest step, whether it is acceptable or not; `true` with it if it is acceptable to an
    /// earlier point.
    pub(super) fn full(
        &mut self,
        filter: &mut Filter,
        step: &SearchDirection,
        longest: f64,
        from: Reference,
        alpha: f64,
    ) -> Option<(Accepted, bool)> {
        let (y, values) = self.trial(step, longest)?;
        let acceptable = self.accept(filter, from, alpha, &values);
        Some((Accepted { y, values, alpha: longest, trials: 1 }, acceptable))
    }

    fn trial(&mut self, step: &SearchDirection, alpha: f64) -> Option<(Vec<f64>, Values)> {
        let y: Vec<f64> = self.at.y.iter().zip(&step.y).map(|(y, d)| y + alpha * d).collect();
        let mut values = Values::default();
        values.evaluate(self.nlp, self.formulation, &y, self.counts).then_some((y, values))
    }

    /// Whether a trial point is good enough.
    fn accept(&self, filter: &mut Filter, from: Reference, alpha: f64, values: &Values) -> bool {
        filter.judge(from, alpha, values.violation, self.barrier.value(values))
    }

    /// Second-order correction: the same matrix against the residuals of the trial point (section
    /// 2.4).
    fn correct(
        &mut self,
        filter: &mut Filter,
        from: Reference,
        step: &mut SearchDirection,
        alpha: f64,
        first: Values,
    ) -> Option<Accepted> {
        let mut corrected = step.clone();
        let mut residuals: Vec<f64> =
            self.values.residuals.iter().map(|value| alpha * value).collect();
        let (mut last, mut theta) = (first, from.theta);
        let mut alpha = alpha;
        for trials in 1..=MOST_CORRECTIONS {
            let factor = if trials == 1 { 1.0 } else { alpha };
            for (target, residual) in residuals.iter_mut().zip(&last.residuals) {
                *target = factor * *target + residual;
            }
            let (formulation, at, slopes, mu) =
                (self.formulation, self.at, self.slopes, self.barrier.mu);
            let system = System { formulation, at, slopes, mu };
            if !self.kkt.step(&system, &residuals, &mut corrected) {
                return None;
            }
            alpha = self.barrier.longest_steps(formulation, at, &corrected).0;
            let (y, values) = self.trial(&corrected, alpha)?;
            if self.accept(filter, from, alpha, &values) {
                *step = corrected;
                return Some(Accepted { y, values, alpha, trials: 1 + trials });
            }
            if values.violation > CORRECTION_DECREASE * theta {
                return None;
            }
            theta = values.violation;
            last = values;
        }
        None
    }
}
