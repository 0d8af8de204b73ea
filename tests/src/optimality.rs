//! The optimality conditions of a solution, recomputed independently of whoever found it.
//!
//! ```text
//! gradient f + J' lambda - z_lower + z_upper = 0        for every variable that is not fixed
//! lower <= c <= upper,  lower <= v <= upper
//! lambda > 0 only at an upper bound, lambda < 0 only at a lower bound;  z >= 0, and > 0 only at its bound
//! ```

use fdcc_runtime::homotopy::Outcome;
use fdcc_runtime::nlp::Multipliers;
use fdcc_runtime::problem::{Bounds, Problem};

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
    /// The largest multiplier: a scale for the others.
    pub multiplier: f64,
}

/// All conditions at a solution, with its multipliers.
pub fn residuals(problem: &Problem, outcome: &Outcome) -> Residuals {
    let solution = &outcome.solution;
    let at = Transcribed::new(problem, &outcome.sigma, &solution.v);
    let Multipliers { rows, lower, upper } = &solution.multipliers;
    let bounds = at.row_bounds.iter().zip(&at.rows).chain(at.variable_bounds.iter().zip(&solution.v));
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
        multiplier: largest(rows.iter().chain(lower).chain(upper).map(|value| value.abs())),
    }
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    // Unlike `f64::max`, this does not overlook what is not a number.
    let maximum =
        |largest: f64, value: f64| if largest.is_nan() || value <= largest { largest } else { value };
    values.into_iter().fold(0.0, maximum)
}

fn outside(bounds: &Bounds, value: f64) -> f64 {
    if value.is_nan() { value } else { bounds.violation(value) }
}

fn stationarity(at: &Transcribed, multipliers: &Multipliers) -> Vec<f64> {
    let mut gradient = at.gradient.clone();
    for &(row, variable, slope) in &at.jacobian {
        gradient[variable] += multipliers.rows[row] * slope;
    }
    for (i, value) in gradient.iter_mut().enumerate() {
        *value += multipliers.upper[i] - multipliers.lower[i];
        *value = if at.variable_bounds[i].is_equality() { 0.0 } else { value.abs() };
    }
    gradient
}

/// A positive multiplier belongs to the upper bound, a negative one to the lower; infinite where that bound is not.
fn complementarity(bounds: &Bounds, value: f64, multiplier: f64) -> f64 {
    if bounds.is_equality() || multiplier == 0.0 {
        return 0.0;
    }
    let bound = if multiplier > 0.0 { bounds.upper } else { bounds.lower };
    (multiplier * (bound - value)).abs()
}
