//! The optimality conditions of a solution, recomputed independently of whoever found it.
//!
//! ```text
//! gradient f + J' lambda - z_lower + z_upper = 0        for every variable that is not fixed
//! lower <= c <= upper,  lower <= v <= upper
//! lambda > 0 only at an upper bound, lambda < 0 only at a lower bound
//! z >= 0, and > 0 only at its bound
//! ```

use fdcc_runtime::nlp::Multipliers;
use fdcc_runtime::problem::{Bounds, Problem};
use fdcc_runtime::solve::Outcome;

use crate::transcribed::Transcribed;

/// The largest violation of each condition.
#[derive(Clone, Copy, Debug, Default)]
pub struct Residuals {
    /// Of the gradient of the Lagrangian.
    pub stationarity: f64,
    /// How far a row or variable is outside its bounds.
    pub feasibility: f64,
    /// Multiplier times distance from its bound.
    pub complementarity: f64,
    /// How far a multiplier of a variable is below zero.
    pub signs: f64,
    /// Difference from the objective that the solution claims.
    pub objective: f64,
    /// What violations are worth to the objective, to first order.
    pub weighted_violation: f64,
}

impl Residuals {
    /// The largest of all, relative to the objective where that is more than 1; never to
    /// multipliers, which may be of any size where there is no optimum.
    pub fn error(&self, objective: f64) -> f64 {
        let scale = objective.abs().max(1.0);
        largest([
            self.stationarity / scale,
            self.feasibility,
            self.complementarity / scale,
            self.signs,
        ])
    }
}

/// All conditions at a solution, with its multipliers.
pub fn residuals(problem: &Problem, outcome: &Outcome) -> Residuals {
    let solution = &outcome.solution;
    let at = Transcribed::new(problem, &outcome.sigma, &solution.v);
    let Multipliers { constraints: rows, lower, upper } = &solution.multipliers;
    let bounds =
        at.row_bounds.iter().zip(&at.rows).chain(at.variable_bounds.iter().zip(&solution.v));
    let of_rows = at.row_bounds.iter().zip(&at.rows).zip(rows);
    let of_variables = at.variable_bounds.iter().zip(&solution.v);
    let from_bounds = of_variables.zip(lower.iter().zip(upper));
    Residuals {
        stationarity: largest(stationarity(&at, &solution.multipliers)),
        feasibility: largest(bounds.map(|(bounds, value)| outside(bounds, *value))),
        complementarity: largest(
            of_rows.map(|((bounds, row), lambda)| complementarity(bounds, *row, *lambda)),
        )
        .max(largest(from_bounds.map(|((bounds, v), (lower, upper))| {
            complementarity(bounds, *v, *upper).max(complementarity(bounds, *v, -lower))
        }))),
        signs: largest(lower.iter().chain(upper).map(|z| (-z).max(0.0))),
        objective: (at.objective - solution.objective).abs(),
        weighted_violation: weighted_violation(&at, &solution.v, &solution.multipliers).abs(),
    }
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    // Unlike `f64::max`, this does not overlook what is not a number.
    let maximum = |largest: f64, value: f64| {
        if largest.is_nan() || value <= largest { largest } else { value }
    };
    values.into_iter().fold(0.0, maximum)
}

fn outside(bounds: &Bounds, value: f64) -> f64 {
    if value.is_nan() { value } else { bounds.violation(value) }
}

fn stationarity(at: &Transcribed, multipliers: &Multipliers) -> Vec<f64> {
    let mut gradient = at.gradient.clone();
    for &(row, variable, slope) in &at.jacobian {
        gradient[variable] += multipliers.constraints[row] * slope;
    }
    for (i, value) in gradient.iter_mut().enumerate() {
        *value += multipliers.upper[i] - multipliers.lower[i];
        *value = if at.variable_bounds[i].is_equality() { 0.0 } else { value.abs() };
    }
    gradient
}

/// The sum of all multipliers times violations.
fn weighted_violation(at: &Transcribed, v: &[f64], multipliers: &Multipliers) -> f64 {
    let excess = |bounds: &Bounds, value: f64| {
        (value - bounds.upper).max(0.0) - (bounds.lower - value).max(0.0)
    };
    let of_rows = at.row_bounds.iter().zip(&at.rows).zip(&multipliers.constraints);
    let rows: f64 = of_rows.map(|((bounds, row), lambda)| excess(bounds, *row) * lambda).sum();
    let both = multipliers.upper.iter().zip(&multipliers.lower).map(|(upper, lower)| upper - lower);
    let of_variables = at.variable_bounds.iter().zip(v).zip(both);
    rows + of_variables.map(|((bounds, v), z)| excess(bounds, *v) * z).sum::<f64>()
}

/// A positive multiplier belongs to the upper bound, a negative one to the lower; infinite where
/// that bound is not.
fn complementarity(bounds: &Bounds, value: f64, multiplier: f64) -> f64 {
    if bounds.is_equality() || multiplier == 0.0 {
        return 0.0;
    }
    let bound = if multiplier > 0.0 { bounds.upper } else { bounds.lower };
    (multiplier * (bound - value)).abs()
}
