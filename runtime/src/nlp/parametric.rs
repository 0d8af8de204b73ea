//! How the solution of a nonlinear program moves with a parameter: the derivative of its optimality
//! conditions, with the multipliers (Fiacco, Introduction to sensitivity and stability analysis in
//! nonlinear programming, 1983, section 3.2).
//!
//! ```text
//!     [ H + Sigma   J' ] [ dv/dp      ]      d [ grad L ]
//!     [ J           -D ] [ dlambda/dp ] = - -- [ c - b  ]
//!                                           dp
//! ```
//!
//! Active bounds and inequalities are the springs of a [`System`]; variables that are fixed move
//! with their bounds. The right side is a central difference of exact derivatives of two programs
//! whose parameter differs.

use super::assessment::magnitudes;
use super::covariance::System;
use super::tuning::covariance::NOT_MOVED;
use super::{Derivatives, Nlp, Solution};
use crate::problem::Bounds;

/// The derivative of every variable, where the two programs differ by `change` of the parameter;
/// nothing where the solution is no strict minimum, or their shapes are others.
pub(crate) fn moved(
    nlp: &mut dyn Nlp,
    solution: &Solution,
    [below, above]: [&mut dyn Nlp; 2],
    change: f64,
) -> Option<Vec<f64>> {
    let system = System::new(nlp, solution, 0..0, (&[], 0.0));
    let mut system = system.with_all_bounds(nlp, solution);
    let own = nlp.variable_bounds().to_vec();
    let is_same = |it: &dyn Nlp| {
        it.variable_bounds().len() == own.len()
            && it.constraint_bounds().len() == nlp.constraint_bounds().len()
            && it.jacobian_structure().len() == nlp.jacobian_structure().len()
    };
    if !is_same(below) || !is_same(above) {
        return None;
    }
    let bounds = [below.variable_bounds(), above.variable_bounds()];
    let of_bounds = bounds_moved(solution, bounds, change);
    let [low, high] = [below, above].map(|it| Conditions::new(it, &own, solution));
    let slope = |(high, low): (&f64, &f64)| (low - high) / change;
    let mut right: Vec<f64> = high.gradient.iter().zip(&low.gradient).map(slope).collect();
    right.extend(high.rows.iter().zip(&low.rows).map(slope));
    for ((value, by), spring) in right.iter_mut().zip(&of_bounds).zip(system.springs()) {
        *value += spring * by;
    }
    let quantities = nlp.quantities();
    let sizes = magnitudes(&quantities, &solution.v);
    let sizes: Vec<f64> = quantities.variables.iter().map(|it| sizes[*it]).collect();
    let worth = solution.objective.abs().max(f64::MIN_POSITIVE);
    let soft: Vec<f64> = sizes.iter().map(|size| worth / (size * size)).collect();
    // What moves by less than rounding with all of the change does not move.
    let least: Vec<f64> = sizes.iter().map(|size| NOT_MOVED * size / change).collect();
    let mut found = system.solved(&right, (&soft, &least))?;
    found.truncate(own.len());
    let fixed = own.iter().zip(&of_bounds).zip(&mut found).filter(|it| it.0.0.is_equality());
    fixed.for_each(|((_, by), value)| *value = *by);
    Some(found)
}

/// The derivative of the bound of each variable that it is nearer to; 0 of none.
fn bounds_moved(solution: &Solution, [below, above]: [&[Bounds]; 2], change: f64) -> Vec<f64> {
    let of = |((value, below), above): ((&f64, &Bounds), &Bounds)| {
        let is_lower = value - below.lower <= below.upper - value;
        let side = |it: &Bounds| if is_lower { it.lower } else { it.upper };
        let by = (side(above) - side(below)) / change;
        if by.is_finite() { by } else { 0.0 }
    };
    solution.v.iter().zip(below).zip(above).map(of).collect()
}

/// The gradient of the Lagrangian, and the rows less the bounds that they are at.
struct Conditions {
    gradient: Vec<f64>,
    rows: Vec<f64>,
}

impl Conditions {
    /// With the variables and multipliers of a solution; what is fixed is where its bounds are.
    fn new(nlp: &mut dyn Nlp, own: &[Bounds], solution: &Solution) -> Self {
        let lambda = &solution.multipliers.constraints;
        let mut v = solution.v.clone();
        let fixed = own.iter().zip(nlp.variable_bounds()).zip(&mut v);
        fixed.filter(|it| it.0.0.is_equality()).for_each(|((_, its), value)| *value = its.lower);
        let (mut at, mut rows) = (Derivatives::new(nlp), vec![0.0; lambda.len()]);
        nlp.derivatives(&v, 1.0, lambda, &mut at);
        nlp.values(&v, &mut rows);
        let mut gradient = at.gradient;
        let jacobian = nlp.jacobian_structure();
        jacobian.transposed_multiply_add(&at.jacobian, lambda, &mut gradient);
        let bounds = nlp.constraint_bounds().iter().zip(lambda);
        for (value, (bounds, lambda)) in rows.iter_mut().zip(bounds) {
            let side = if *lambda > 0.0 { bounds.upper } else { bounds.lower };
            *value -= if side.is_finite() { side } else { 0.0 };
        }
        Conditions { gradient, rows }
    }
}
