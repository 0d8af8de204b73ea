//! Multipliers at a point that is nearly a solution, of which nothing else is known.
//!
//! They are those that make the gradient of the Lagrangian smallest in the variables that are at no
//! bound,
//!
//! ```text
//!     minimise  1/2 sum of w_i (g + J' lambda)_i^2      <=>      [ 1/W   J' ] [ r      ]   [ -g ]
//!                                                                [ J     -D ] [ lambda ] = [  0 ]
//! ```
//!
//! where rows that are at no bound have a `D` so large that they have none. What is left in a
//! variable at a bound is the multiplier of that bound.

use super::tuning::multiplier_estimate::{NEAR, SHIFT, WEIGHTLESS};
use super::{Derivatives, Multipliers, Nlp};
use crate::linalg::sparse_ldl::SparseLdl;
use crate::linalg::{Factor, Inertia};
use crate::problem::Bounds;

/// The multipliers at `v`; `None` where there is no number.
pub(crate) fn multipliers(nlp: &mut dyn Nlp, v: &[f64]) -> Option<Multipliers> {
    let mut known = Multipliers::zeros(nlp);
    let (mut derivatives, mut rows) = (Derivatives::new(nlp), known.constraints.clone());
    nlp.derivatives(v, 1.0, &known.constraints, &mut derivatives);
    nlp.values(v, &mut rows);
    let fixed: Vec<bool> = nlp.variable_bounds().iter().map(Bounds::is_equality).collect();
    let mut factor =
        SparseLdl::new(nlp.hessian_structure(), nlp.jacobian_structure(), &fixed, rows.len());
    let sigma: Vec<f64> = pairs(nlp.variable_bounds(), v, |side| side.map_or(1.0, |_| WEIGHTLESS));
    let d: Vec<f64> =
        pairs(nlp.constraint_bounds(), &rows, |side| side.map_or(WEIGHTLESS, |_| SHIFT));
    let flat = vec![0.0; derivatives.hessian.len()];
    if factor.factor(&flat, &derivatives.jacobian, &sigma, &d) != Inertia::Correct {
        return None;
    }
    let mut right: Vec<f64> = derivatives.gradient.iter().map(|g| -g).collect();
    right.resize(v.len() + rows.len(), 0.0);
    factor.solve(&mut right);
    known.constraints.copy_from_slice(&right[v.len()..]);
    let mut left = derivatives.gradient;
    nlp.jacobian_structure().transposed_multiply_add(
        &derivatives.jacobian,
        &known.constraints,
        &mut left,
    );
    let sides = pairs(nlp.variable_bounds(), v, |side| side);
    for (i, side) in sides.into_iter().enumerate() {
        match side {
            Some(Side::Lower) => known.lower[i] = left[i].max(0.0),
            Some(Side::Upper) => known.upper[i] = (-left[i]).max(0.0),
            None => {}
        }
    }
    known.constraints.iter().chain(&left).all(|value| value.is_finite()).then_some(known)
}

/// The bound that something is at.
#[derive(Clone, Copy)]
enum Side {
    Lower,
    Upper,
}

fn pairs<T>(bounds: &[Bounds], values: &[f64], of_side: impl Fn(Option<Side>) -> T) -> Vec<T> {
    bounds.iter().zip(values).map(|(bounds, value)| of_side(side(bounds, *value))).collect()
}

/// What is beyond its bound is at it, and so is an equality wherever it is: a start need not be
/// feasible.
fn side(bounds: &Bounds, value: f64) -> Option<Side> {
    let near = NEAR * value.abs().max(1.0);
    match (value <= bounds.lower + near, value >= bounds.upper - near) {
        _ if bounds.is_equality() => Some(Side::Lower),
        (true, _) => Some(Side::Lower),
        (_, true) => Some(Side::Upper),
        _ => None,
    }
}
