//! Whether a point with its multipliers may be called a solution: two measures of the nonlinear
//! program as it was written. Neither bounds nor guess nor scaling
//! have a say in them; they are the same in all units.
//!
//! ```text
//!     violation   = max over rows    |how far c_i is outside| / size of the terms of the row
//!     spread      = max over states  sum over time  |defect| / size of the state
//!     improvement = ( sum z_j * min(distance_j, size_j)  +  sum |lambda_i| * violation_i  +  sum
//! |grad L|_j * size_j ) / size of f
//! ```
//!
//! The first part of the improvement is the complementarity, which on the central path of a convex
//! program is the duality gap (Boyd & Vandenberghe, Convex Optimization,
//! section 5.5); the second is what violations are worth by their multipliers; the third bounds
//! what a step that moves every quantity by its own size could still gain. The last is pessimistic;
//! whoever knows the Newton decrement may put it in its place.
//!
//! The size of a quantity is its largest value over time. A quantity that is 0 has a millionth of
//! its declared unit, so that rounding is not mistaken for a value.

use super::curvature::curvatures;
use super::tuning::assessment::{
    ACCEPTABLE_IMPROVEMENT, ACCEPTABLE_VIOLATION, AIM, IMPROVEMENT, NOTHING, PART, SPREAD,
};
use super::{Derivatives, Multipliers, Nlp, Quantities};
use crate::problem::Bounds;

/// See the head of this file.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Assessment {
    /// Largest violation of a row or bound, relative to the size of its terms.
    pub(crate) violation: f64,
    /// The largest sum of the violations of a state's steps, relative to the size of the state.
    pub(crate) spread: f64,
    /// Complementarity, and what violations are worth by their multipliers: what these say the
    /// objective can still gain, relative to its size.
    pub(crate) complementarity: f64,
    /// The same of the gradient of the Lagrangian.
    pub(crate) slope: f64,
    /// The size of the objective: of its value, and of the terms of its expansion.
    pub(crate) size: f64,
}

impl Assessment {
    /// Of the point `v` (one value per variable) with its multipliers. What is not a number makes
    /// the measures so.
    pub(crate) fn new(nlp: &mut dyn Nlp, v: &[f64], multipliers: &Multipliers) -> Self {
        let quantities = nlp.quantities();
        let magnitudes = magnitudes(&quantities, v);
        let sizes: Vec<f64> = quantities.variables.iter().map(|i| magnitudes[*i]).collect();
        let (mut rows, mut at) = (vec![0.0; nlp.constraint_bounds().len()], Derivatives::new(nlp));
        let objective = nlp.values(v, &mut rows);
        nlp.derivatives(v, 1.0, &vec![0.0; rows.len()], &mut at);
        let terms = expansion(nlp, &at, v, &sizes);
        let size = nlp.objective_size(objective.abs().max(terms));
        let of_rows =
            constraint_magnitudes(nlp, &quantities, v, &at.jacobian, (&magnitudes, &sizes));
        let sides = nlp.variable_bounds().iter().zip(v).zip(&sizes);
        let both = multipliers.lower.iter().zip(&multipliers.upper);
        let mut sums = Sums::default();
        sides.zip(both).for_each(|(((bounds, value), size), (lower, upper))| {
            sums.add(bounds, *value, *size, [*lower, *upper]);
        });
        let rows =
            nlp.constraint_bounds().iter().zip(&rows).zip(&of_rows).zip(&multipliers.constraints);
        let mut spreads = vec![0.0; quantities.stepped];
        rows.zip(&quantities.constraints).for_each(|((((bounds, value), size), lambda), kind)| {
            sums.add(bounds, *value, *size, [(-lambda).max(0.0), lambda.max(0.0)]);
            if let Some(spread) = spreads.get_mut(*kind) {
                *spread += bounds.violation(*value) / size;
            }
        });
        let spread = spreads.into_iter().fold(0.0, f64::max);
        let slope = slope(nlp, &at, multipliers, &sizes);
        // Without an objective there is nothing to gain.
        let relative =
            |value: f64| if objective == 0.0 && terms == 0.0 { 0.0 } else { value / size };
        let (complementarity, slope) = (relative(sums.complementarity), relative(slope));
        Assessment { violation: sums.violation, spread, complementarity, slope, size }
    }

    /// The same, where the Newton decrement says what the gradient of the Lagrangian can gain: the
    /// objective of the quadratic model at the point less that at its minimum.
    pub(crate) fn with_decrement(self, decrement: f64) -> Self {
        Assessment { slope: self.slope.min(decrement / self.size), ..self }
    }

    /// What the multipliers say the objective can still gain, relative to its size.
    pub(crate) fn improvement(&self) -> f64 {
        self.complementarity + self.slope
    }

    /// Whether all but the gradient of the Lagrangian is as it should be.
    pub(crate) fn is_only_steep(&self, tol: f64) -> bool {
        self.is_feasible(tol)
            && self.complementarity <= most_improvement(tol)
            && !self.is_enough(tol)
    }

    /// Whether the conditions are met to this tolerance.
    pub(crate) fn is_feasible(&self, tol: f64) -> bool {
        self.violation <= tol && self.spread <= SPREAD * tol
    }

    /// Whether it may be called a solution to this tolerance.
    pub(crate) fn is_convincing(&self, tol: f64) -> bool {
        self.is_feasible(tol) && self.improvement() <= most_improvement(tol)
    }

    /// Whether it is as good as is aimed at.
    pub(crate) fn is_enough(&self, tol: f64) -> bool {
        self.is_feasible(tol) && self.improvement() <= AIM * most_improvement(tol)
    }

    /// What is aimed at, relative to what is there: the smaller the further away.
    pub(crate) fn missed(&self, tol: f64) -> f64 {
        let feasible = (tol / self.violation).min(SPREAD * tol / self.spread);
        feasible.min(AIM * most_improvement(tol) / self.improvement())
    }

    /// What an objective has to gain to count.
    pub(crate) fn least_gain(&self, tol: f64) -> f64 {
        most_improvement(tol) * self.size
    }

    /// Whether it is good enough for most uses.
    pub(crate) fn is_acceptable(&self, tol: f64) -> bool {
        self.is_feasible(tol.max(ACCEPTABLE_VIOLATION))
            && self.improvement() <= ACCEPTABLE_IMPROVEMENT.max(tol)
    }
}

/// Relative to the size of the objective.
fn most_improvement(tol: f64) -> f64 {
    (IMPROVEMENT * tol).min(ACCEPTABLE_IMPROVEMENT.max(tol))
}

/// Sums over the two sides of bounds.
#[derive(Default)]
struct Sums {
    violation: f64,
    complementarity: f64,
}

impl Sums {
    fn add(&mut self, bounds: &Bounds, value: f64, size: f64, [lower, upper]: [f64; 2]) {
        let outside = bounds.violation(value);
        let relative = if outside == 0.0 { 0.0 } else { outside / size };
        self.violation =
            if relative > self.violation || relative.is_nan() { relative } else { self.violation };
        if bounds.is_equality() {
            self.complementarity += (lower + upper) * outside;
            return;
        }
        for (multiplier, distance) in [(lower, value - bounds.lower), (upper, bounds.upper - value)]
        {
            // What is far from its bound moves by no more than its own size.
            self.complementarity += multiplier * distance.abs().min(size);
        }
    }
}

/// The largest value of each quantity over time.
pub(super) fn magnitudes(quantities: &Quantities, v: &[f64]) -> Vec<f64> {
    let mut magnitudes: Vec<f64> = quantities.units.iter().map(|unit| NOTHING * unit).collect();
    for (i, value) in quantities.variables.iter().zip(v) {
        magnitudes[*i] = magnitudes[*i].max(value.abs());
    }
    magnitudes
}

/// Of the step of a state the size of the state; of a condition the sum of its terms to second
/// order, and its bounds; the largest of all times.
fn constraint_magnitudes(
    nlp: &mut dyn Nlp,
    quantities: &Quantities,
    v: &[f64],
    jacobian: &[f64],
    (magnitudes, sizes): (&[f64], &[f64]),
) -> Vec<f64> {
    let mut terms = vec![0.0; quantities.constraints.len()];
    nlp.jacobian_structure().with_values(jacobian).for_each(|(row, column, slope)| {
        terms[row] += slope.abs() * sizes[column];
    });
    let kinds = quantities.constraints.iter().max().map_or(0, |last| last + 1);
    let mut largest = vec![0.0f64; kinds];
    for ((i, terms), bounds) in
        quantities.constraints.iter().zip(terms).zip(nlp.constraint_bounds())
    {
        let ends =
            [bounds.lower, bounds.upper].map(f64::abs).into_iter().filter(|end| end.is_finite());
        largest[*i] = largest[*i].max(ends.fold(terms, f64::max));
    }
    let of_conditions = (quantities.stepped, kinds);
    let curvatures = curvatures(nlp, quantities, v, magnitudes, of_conditions);
    largest.iter_mut().zip(curvatures).for_each(|(size, more)| *size += more);
    let size = |i: usize| if i < quantities.stepped { magnitudes[i] } else { largest[i] };
    quantities.constraints.iter().map(|i| size(*i)).collect()
}

/// The terms of the objective to second order around the point: near a minimum its gradient says
/// little of them.
fn expansion(nlp: &dyn Nlp, at: &Derivatives, v: &[f64], sizes: &[f64]) -> f64 {
    let reach: Vec<f64> = v.iter().zip(sizes).map(|(v, size)| v.abs() + PART * size).collect();
    let first: f64 = at.gradient.iter().zip(&reach).map(|(slope, by)| slope.abs() * by).sum();
    let second = nlp.hessian_structure().with_values(&at.hessian).map(|(i, j, curvature)| {
        let factor = if i == j { 0.5 } else { 1.0 };
        factor * curvature.abs() * reach[i] * reach[j]
    });
    first + second.sum::<f64>()
}

/// What a step that moves every free variable by its size could gain by the gradient of the
/// Lagrangian.
fn slope(nlp: &dyn Nlp, at: &Derivatives, multipliers: &Multipliers, sizes: &[f64]) -> f64 {
    let mut gradient = at.gradient.clone();
    nlp.jacobian_structure().transposed_multiply_add(
        &at.jacobian,
        &multipliers.constraints,
        &mut gradient,
    );
    let sides = multipliers.lower.iter().zip(&multipliers.upper);
    let of_variables = nlp.variable_bounds().iter().zip(sizes);
    let parts = gradient.iter().zip(sides).zip(of_variables).map(
        |((slope, (lower, upper)), (bounds, size))| {
            if bounds.is_equality() { 0.0 } else { (slope - lower + upper).abs() * size }
        },
    );
    parts.sum()
}
