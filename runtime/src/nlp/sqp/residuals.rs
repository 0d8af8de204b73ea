//! How far an iterate is from satisfying the optimality conditions, measured as the interior point
//! method measures it.
//!
//! ```text
//!     E = max( ||grad f + J' lambda - z_lower + z_upper||_inf / s_d ,  ||violation||_inf ,  ||distance * multiplier||_inf / s_c )
//! ```

use super::point::Point;
use crate::nlp::error_scale::error_scale;
use crate::nlp::{Derivatives, Multipliers, Nlp};
use crate::problem::Bounds;

/// The three parts of the error, scaled.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Residuals {
    pub(super) dual: f64,
    pub(super) primal: f64,
    complementarity: f64,
}

impl Residuals {
    pub(super) fn new(
        nlp: &dyn Nlp,
        at: &Point,
        derivatives: &Derivatives,
        known: &Multipliers,
    ) -> Self {
        let size = |values: &[f64]| values.iter().map(|value| value.abs()).sum::<f64>();
        let (bounds, rows) = (size(&known.lower) + size(&known.upper), size(&known.rows));
        let count = 2 * known.lower.len() + known.rows.len();
        let scale = error_scale((bounds + rows) / count.max(1) as f64, at.objective);
        let violations = nlp.row_bounds().iter().zip(&at.rows);
        Residuals {
            dual: largest(stationarity(nlp, derivatives, known)) / scale,
            primal: largest(violations.map(|(bounds, value)| bounds.violation(*value))),
            complementarity: largest(products(nlp, at, known)) / scale,
        }
    }

    /// `E`
    pub(super) fn error(&self) -> f64 {
        largest([self.dual, self.primal, self.complementarity])
    }
}

/// The gradient of the Lagrangian; fixed variables have none.
fn stationarity(nlp: &dyn Nlp, derivatives: &Derivatives, known: &Multipliers) -> Vec<f64> {
    let mut gradient = derivatives.gradient.clone();
    nlp.jacobian_structure().transposed_multiply_add(
        &derivatives.jacobian,
        &known.rows,
        &mut gradient,
    );
    for (i, (value, bounds)) in gradient.iter_mut().zip(nlp.variable_bounds()).enumerate() {
        *value += known.upper[i] - known.lower[i];
        *value = if bounds.is_equality() { 0.0 } else { *value };
    }
    gradient
}

/// Each multiplier times the distance from its bound.
fn products(nlp: &dyn Nlp, at: &Point, known: &Multipliers) -> Vec<f64> {
    let of_rows = nlp.row_bounds().iter().zip(&at.rows).zip(&known.rows);
    let rows = of_rows.map(|((bounds, value), lambda)| product(bounds, *value, *lambda));
    let of_variables = nlp.variable_bounds().iter().zip(&at.v).enumerate();
    let variables = of_variables.flat_map(|(i, (bounds, value))| {
        [product(bounds, *value, known.upper[i]), product(bounds, *value, -known.lower[i])]
    });
    rows.chain(variables).collect()
}

/// A multiplier above zero belongs to the upper bound, one below to the lower; where that bound is
/// not, it should be zero.
fn product(bounds: &Bounds, value: f64, multiplier: f64) -> f64 {
    if bounds.is_equality() || multiplier == 0.0 {
        return 0.0;
    }
    let bound = if multiplier > 0.0 { bounds.upper } else { bounds.lower };
    if bound.is_finite() { multiplier * (bound - value) } else { multiplier }
}

/// The largest absolute value; what is not a number is larger than all numbers.
pub(super) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |most: f64, value| {
        if most.is_nan() || value.abs() <= most { most } else { value.abs() }
    })
}
