//! What errors of the optimality conditions are divided by.
//!
//! ```text
//!     s = mean size of the multipliers / 100,   at least 1,   at most max(1, |f|)
//! ```
//!
//! Large multipliers excuse errors (Waechter & Biegler 2006, equation 5), but only as far as the
//! objective is large, too. That limit is ours: where the feasible set has no interior, multipliers
//! grow without end, and without it any point would pass for an optimum.

/// Multipliers of this average size are considered normal.
const NORMAL_MULTIPLIER: f64 = 100.0;

pub(super) fn error_scale(average: f64, objective: f64) -> f64 {
    (average / NORMAL_MULTIPLIER).clamp(1.0, objective_scale(objective))
}

/// What differences of the objective are relative to.
pub(super) fn objective_scale(objective: f64) -> f64 {
    objective.abs().max(1.0)
}
