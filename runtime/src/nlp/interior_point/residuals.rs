//! How far an iterate is from satisfying the optimality conditions (Waechter & Biegler 2006,
//! equation 5).
//!
//! ```text
//!     E_mu = max( ||grad L||_inf / s_d,  ||residuals||_inf,
//!                 ||distance * multiplier - mu||_inf / s_c )
//! ```
//!
//! An error this small says little of the objective where multipliers are large, so there is a
//! second one: the violations, weighted with the multipliers,
//!
//! ```text
//!     ( |lambda' residuals| + sum (multiplier * how far its bound was moved) ) / max(1, |f|)
//! ```

use super::error_scaling::{error_scale, objective_scale};
use super::formulation::Formulation;
use super::iterate::{Iterate, Slopes, Values};
use super::vectors::{largest_sum, sum_of_sizes};

/// The three parts of the error, scaled.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Residuals {
    pub(super) dual: f64,
    pub(super) primal: f64,
    /// Largest and smallest product of a distance and its multiplier.
    largest_product: f64,
    smallest_product: f64,
    product_scale: f64,
}

impl Residuals {
    pub(super) fn new(
        formulation: &Formulation,
        at: &Iterate,
        values: &Values,
        slopes: &Slopes,
    ) -> Self {
        let bound_sum = sum_of_sizes(&at.lower) + sum_of_sizes(&at.upper);
        let row_sum = sum_of_sizes(&at.lambda);
        let (bounds, rows) = ((2 * formulation.len()).max(1) as f64, at.lambda.len() as f64);
        let scale = |average: f64| error_scale(average, values.objective);
        let dual = largest_sum([&slopes.lagrangian, &at.upper], &at.lower);
        let (mut most, mut least, mut nothing) = (0.0, f64::INFINITY, 0.0);
        formulation.for_each_bound(&at.y, |i, distance, direction| {
            let product = distance * if direction > 0.0 { at.lower[i] } else { at.upper[i] };
            most = if product > most { product } else { most };
            least = if product < least { product } else { least };
            // Zero, or what is not a number.
            nothing += product * 0.0;
        });
        Residuals {
            dual: dual / scale((bound_sum + row_sum) / (bounds + rows)),
            primal: values.largest(),
            largest_product: most + nothing,
            smallest_product: if least.is_finite() { least } else { 0.0 },
            product_scale: scale(bound_sum / bounds),
        }
    }

    /// `E_mu`
    pub(super) fn error(&self, mu: f64) -> f64 {
        let no_bounds = self.largest_product == 0.0 && self.smallest_product == 0.0;
        let products = if no_bounds {
            0.0
        } else {
            larger(self.largest_product - mu, mu - self.smallest_product)
        };
        larger(larger(self.dual, self.primal), products / self.product_scale)
    }
}

#[cfg(test)]
impl Residuals {
    /// Those of a point that only the gradient of the Lagrangian keeps from being a solution.
    pub(super) fn of_gradient(dual: f64) -> Self {
        Residuals { dual, product_scale: 1.0, ..Residuals::default() }
    }
}

/// What violations are worth to the objective, to first order.
pub(super) fn weighted_violation(formulation: &Formulation, at: &Iterate, values: &Values) -> f64 {
    let violations = at.lambda.iter().zip(&values.residuals);
    let mut moved = 0.0;
    formulation.for_each_bound(&at.y, |i, _, direction| {
        let (bound, z) = if direction > 0.0 {
            (&formulation.lower, &at.lower)
        } else {
            (&formulation.upper, &at.upper)
        };
        moved += formulation.moved(bound[i]) * z[i];
    });
    let rows: f64 = violations.map(|(lambda, residual)| lambda * residual).sum();
    (rows.abs() + moved) / objective_scale(values.objective)
}

/// The larger of two; what is not a number is larger than all numbers.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}
