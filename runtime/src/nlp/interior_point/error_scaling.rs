//! The scaling of the KKT error: `s_d` and `s_c` of Waechter & Biegler 2006, equation 5.
//!
//! ```text
//!     s = mean size of the multipliers / 100,   at least 1,   at most max(1, |f|)
//! ```
//!
//! Where multipliers are large on average the error is divided by their size, but only as far as
//! the objective is large, too. That limit is ours: where the feasible set has no interior,
//! multipliers grow without end, and without it any point would pass for an optimum.

use super::tuning::error_scaling::NORMAL_MULTIPLIER;

pub(super) fn error_scale(average: f64, objective: f64) -> f64 {
    (average / NORMAL_MULTIPLIER).clamp(1.0, objective_scale(objective))
}

/// What differences of the objective are relative to.
pub(super) fn objective_scale(objective: f64) -> f64 {
    objective.abs().max(1.0)
}
