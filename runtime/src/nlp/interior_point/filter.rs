//! The filter: pairs (violation `theta`, objective `phi`) that a new iterate must improve on
//! (Waechter & Biegler 2006, algorithm A and section 2.3).

use super::tuning::filter::{
    ARMIJO, LARGEST_VIOLATION, OBJECTIVE_MARGIN, ROUNDING, SLOPE_POWER, SMALL_VIOLATION,
    SMALLEST_ALPHA, SMALLEST_STEP, SWITCH_FACTOR, VIOLATION_MARGIN, VIOLATION_POWER,
};

/// Violation, objective and its slope at the point that a line search begins at.
#[derive(Clone, Copy)]
pub(super) struct Reference {
    pub(super) theta: f64,
    pub(super) phi: f64,
    pub(super) slope: f64,
}

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
        Filter {
            entries: Vec::new(),
            largest: LARGEST_VIOLATION * scale,
            small: SMALL_VIOLATION * scale,
        }
    }

    /// Forgets all entries: the barrier problem has changed.
    pub(super) fn clear(&mut self) {
        self.entries.clear();
    }

    pub(super) fn accepts(&self, violation: f64, objective: f64) -> bool {
        violation <= self.largest
            && self
                .entries
                .iter()
                .all(|(theta, phi)| violation < *theta || lies_below(objective, *phi))
    }

    /// Forbids what is not clearly better than this.
    pub(super) fn add(&mut self, violation: f64, objective: f64) {
        let entry =
            ((1.0 - VIOLATION_MARGIN) * violation, objective - OBJECTIVE_MARGIN * violation);
        self.entries.retain(|old| old.0 < entry.0 || old.1 < entry.1);
        self.entries.push(entry);
    }

    /// A step shorter than this is not tried.
    pub(super) fn smallest_step(&self, from: Reference) -> f64 {
        let mut bound = VIOLATION_MARGIN;
        if from.slope < 0.0 {
            bound = bound.min(OBJECTIVE_MARGIN * from.theta / -from.slope);
            if from.theta <= self.small {
                let switch = SWITCH_FACTOR * from.theta.powf(VIOLATION_POWER)
                    / (-from.slope).powf(SLOPE_POWER);
                bound = bound.min(switch);
            }
        }
        (SMALLEST_STEP * bound).max(SMALLEST_ALPHA)
    }

    /// Whether a trial point is good enough; adds the point that the step began at unless the
    /// objective decides.
    pub(super) fn judge(&mut self, from: Reference, alpha: f64, theta: f64, phi: f64) -> bool {
        if !phi.is_finite() || !self.accepts(theta, phi) {
            return false;
        }
        let objective_decides = from.slope < 0.0
            && alpha * (-from.slope).powf(SLOPE_POWER)
                > SWITCH_FACTOR * from.theta.powf(VIOLATION_POWER);
        let armijo = lies_below(phi, from.phi + ARMIJO * alpha * from.slope);
        if objective_decides && from.theta <= self.small {
            return armijo;
        }
        let better = theta <= (1.0 - VIOLATION_MARGIN) * from.theta
            || lies_below(phi, from.phi - OBJECTIVE_MARGIN * from.theta);
        if better && !(objective_decides && armijo) {
            self.add(from.theta, from.phi);
        }
        better
    }
}

/// `a <= b` but for rounding.
fn lies_below(a: f64, b: f64) -> bool {
    a <= b + ROUNDING * b.abs().max(1.0)
}
