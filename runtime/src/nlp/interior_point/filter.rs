//! The filter: pairs (violation, barrier objective) that a new iterate must improve on, and the line search that asks it
//! (Waechter & Biegler 2006, algorithm A and sections 2.3, 2.4).

use super::barrier::Barrier;
use super::iterate::{Iterate, Slopes, Step, Values};
use super::kkt::{Kkt, System};
use super::space::Space;
use crate::nlp::{Counts, Nlp};

const VIOLATION_MARGIN: f64 = 1e-5;
const OBJECTIVE_MARGIN: f64 = 1e-8;
const ARMIJO: f64 = 1e-4;
const SWITCH_FACTOR: f64 = 1.0;
const VIOLATION_POWER: f64 = 1.1;
const SLOPE_POWER: f64 = 2.3;
const SMALLEST_STEP: f64 = 0.05;
const LARGEST_VIOLATION: f64 = 1e4;
const SMALL_VIOLATION: f64 = 1e-4;
const MOST_CORRECTIONS: usize = 4;
const CORRECTION_DECREASE: f64 = 0.99;

/// Forbidden regions, and the scale of the violation at the start.
#[derive(Clone, Debug)]
pub(super) struct Filter {
    entries: Vec<(f64, f64)>,
    largest: f64,
    small: f64,
}

impl Filter {
    pub(super) fn new(first_violation: f64) -> Self {
        let scale = first_violation.max(1.0);
        Filter { entries: Vec::new(), largest: LARGEST_VIOLATION * scale, small: SMALL_VIOLATION * scale }
    }

    /// Forgets all entries: the barrier problem has changed.
    pub(super) fn clear(&mut self) {
        self.entries.clear();
    }

    pub(super) fn accepts(&self, violation: f64, objective: f64) -> bool {
        violation <= self.largest
            && self.entries.iter().all(|(theta, phi)| violation < *theta || lies_below(objective, *phi))
    }

    /// Forbids what is not clearly better than this.
    pub(super) fn add(&mut self, violation: f64, objective: f64) {
        let entry = ((1.0 - VIOLATION_MARGIN) * violation, objective - OBJECTIVE_MARGIN * violation);
        self.entries.retain(|old| old.0 < entry.0 || old.1 < entry.1);
        self.entries.push(entry);
    }
}

/// `a <= b` but for rounding.
fn lies_below(a: f64, b: f64) -> bool {
    a <= b + 10.0 * f64::EPSILON * b.abs().max(1.0)
}

/// What a line search works with.
pub(super) struct Search<'a> {
    pub(super) nlp: &'a mut dyn Nlp,
    pub(super) space: &'a Space,
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

/// Violation, barrier objective and slope at the iterate.
#[derive(Clone, Copy)]
pub(super) struct Reference {
    theta: f64,
    phi: f64,
    slope: f64,
}

impl Search<'_> {
    /// Backtracks from the longest step; `None` where the step has become too short.
    pub(super) fn run(&mut self, filter: &mut Filter, step: &mut Step, longest: f64) -> Option<Accepted> {
        let from = self.reference(step);
        let smallest = self.smallest_step(filter, from);
        let (mut alpha, mut trials) = (longest, 0);
        while alpha >= smallest || trials == 0 {
            trials += 1;
            let trial = self.trial(step, alpha);
            if let Some((y, values)) = &trial
                && self.accept(filter, from, alpha, y, values)
            {
                return trial.map(|(y, values)| Accepted { y, values, alpha, trials });
            }
            if let Some((_, values)) = trial
                && trials == 1
                && values.violation() >= from.theta
                && let Some(accepted) = self.correct(filter, from, step, alpha, values)
            {
                return Some(accepted);
            }
            alpha *= 0.5;
        }
        None
    }

    /// What a step from here is compared with.
    pub(super) fn reference(&self, step: &Step) -> Reference {
        Reference {
            theta: self.values.violation(),
            phi: self.barrier.value(self.space, self.values, &self.at.y),
            slope: self.barrier.slope(self.space, self.at, self.slopes, step),
        }
    }

    /// The longest step, whether it is acceptable or not; `true` with it if it is acceptable to an earlier point.
    pub(super) fn full(
        &mut self,
        filter: &mut Filter,
        step: &Step,
        longest: f64,
        from: Reference,
        alpha: f64,
    ) -> Option<(Accepted, bool)> {
        let (y, values) = self.trial(step, longest)?;
        let acceptable = self.accept(filter, from, alpha, &y, &values);
        Some((Accepted { y, values, alpha: longest, trials: 1 }, acceptable))
    }

    fn trial(&mut self, step: &Step, alpha: f64) -> Option<(Vec<f64>, Values)> {
        let y: Vec<f64> = self.at.y.iter().zip(&step.y).map(|(y, d)| y + alpha * d).collect();
        let mut values = Values::default();
        values.evaluate(self.nlp, self.space, &y, self.counts).then_some((y, values))
    }

    fn smallest_step(&self, filter: &Filter, from: Reference) -> f64 {
        let mut bound = VIOLATION_MARGIN;
        if from.slope < 0.0 {
            bound = bound.min(OBJECTIVE_MARGIN * from.theta / -from.slope);
            if from.theta <= filter.small {
                let switch =
                    SWITCH_FACTOR * from.theta.powf(VIOLATION_POWER) / (-from.slope).powf(SLOPE_POWER);
                bound = bound.min(switch);
            }
        }
        (SMALLEST_STEP * bound).max(1e-14)
    }

    /// Whether a trial point is good enough; adds to the filter unless the objective decides.
    fn accept(&self, filter: &mut Filter, from: Reference, alpha: f64, y: &[f64], values: &Values) -> bool {
        let theta = values.violation();
        let phi = self.barrier.value(self.space, values, y);
        if !phi.is_finite() || !filter.accepts(theta, phi) {
            return false;
        }
        let objective_decides = from.slope < 0.0
            && alpha * (-from.slope).powf(SLOPE_POWER) > SWITCH_FACTOR * from.theta.powf(VIOLATION_POWER);
        let armijo = lies_below(phi, from.phi + ARMIJO * alpha * from.slope);
        if objective_decides && from.theta <= filter.small {
            return armijo;
        }
        let better = theta <= (1.0 - VIOLATION_MARGIN) * from.theta
            || lies_below(phi, from.phi - OBJECTIVE_MARGIN * from.theta);
        if better && !(objective_decides && armijo) {
            filter.add(from.theta, from.phi);
        }
        better
    }

    /// Second-order correction: the same matrix against the residuals of the trial point (section 2.4).
    fn correct(
        &mut self,
        filter: &mut Filter,
        from: Reference,
        step: &mut Step,
        alpha: f64,
        first: Values,
    ) -> Option<Accepted> {
        let mut corrected = step.clone();
        let mut residuals: Vec<f64> = self.values.residuals.iter().map(|value| alpha * value).collect();
        let (mut last, mut theta) = (first, from.theta);
        let mut alpha = alpha;
        for trials in 1..=MOST_CORRECTIONS {
            let factor = if trials == 1 { 1.0 } else { alpha };
            for (target, residual) in residuals.iter_mut().zip(&last.residuals) {
                *target = factor * *target + residual;
            }
            let (space, at, slopes, mu) = (self.space, self.at, self.slopes, self.barrier.mu);
            let system = System { nlp: &*self.nlp, space, at, slopes, mu };
            if !self.kkt.step(&system, &residuals, &mut corrected) {
                return None;
            }
            alpha = self.barrier.longest_steps(space, at, &corrected).0;
            let (y, values) = self.trial(&corrected, alpha)?;
            if self.accept(filter, from, alpha, &y, &values) {
                *step = corrected;
                return Some(Accepted { y, values, alpha, trials: 1 + trials });
            }
            if values.violation() > CORRECTION_DECREASE * theta {
                return None;
            }
            theta = values.violation();
            last = values;
        }
        None
    }
}
