//! A point of the primal-dual iteration and what is known there.

use super::barrier::Terms;
use super::formulation::Formulation;
use super::vectors::{are_finite, largest, sum_of_sizes};
use crate::linalg::{Products, Triplets};
use crate::nlp::{Counts, Derivatives, Nlp};

/// Primal and dual variables.
#[derive(Clone, Debug)]
pub(super) struct Iterate {
    /// `[v | slacks]`
    pub(super) y: Vec<f64>,
    /// Multipliers of the rows.
    pub(super) lambda: Vec<f64>,
    /// Multipliers of the bounds; 0 where there is none.
    pub(super) lower: Vec<f64>,
    pub(super) upper: Vec<f64>,
}

impl Iterate {
    /// Sets the multiplier of every finite bound from the distance to it.
    pub(super) fn set_bound_multipliers(
        &mut self,
        formulation: &Formulation,
        value: impl Fn(f64) -> f64,
    ) {
        let Iterate { y, lower, upper, .. } = self;
        formulation.for_each_bound(y, |i, distance, direction| {
            *(if direction > 0.0 { &mut lower[i] } else { &mut upper[i] }) = value(distance);
        });
    }
}

/// A direction in the same space: a Newton step, or one of negative curvature.
#[derive(Clone, Debug)]
pub(super) struct SearchDirection {
    pub(super) y: Vec<f64>,
    pub(super) lambda: Vec<f64>,
    pub(super) lower: Vec<f64>,
    pub(super) upper: Vec<f64>,
}

impl SearchDirection {
    pub(super) fn new(formulation: &Formulation) -> Self {
        let (length, rows) = (formulation.len(), formulation.target.len());
        SearchDirection {
            y: vec![0.0; length],
            lambda: vec![0.0; rows],
            lower: vec![0.0; length],
            upper: vec![0.0; length],
        }
    }
}

/// Objective and residuals at some `y`.
#[derive(Clone, Debug, Default)]
pub(super) struct Values {
    pub(super) objective: f64,
    pub(super) residuals: Vec<f64>,
    /// `theta`: the 1-norm of the residuals.
    pub(super) violation: f64,
    /// What the barrier function has beside the objective.
    pub(super) terms: Terms,
}

impl Values {
    /// Evaluates at `y`; `false` if anything is not finite.
    pub(super) fn evaluate(
        &mut self,
        nlp: &mut dyn Nlp,
        formulation: &Formulation,
        y: &[f64],
        counts: &mut Counts,
    ) -> bool {
        counts.values += 1;
        self.residuals.resize(formulation.target.len(), 0.0);
        let objective = nlp.values(&y[..formulation.variables], &mut self.residuals);
        self.objective = objective + formulation.elastic_cost(y);
        formulation.residuals(y, &mut self.residuals);
        self.violation = sum_of_sizes(&self.residuals);
        self.terms = Terms::new(formulation, y);
        self.is_finite()
    }

    /// Whether there is a number everywhere.
    pub(super) fn is_finite(&self) -> bool {
        self.objective.is_finite() && self.violation.is_finite()
    }

    /// The largest residual.
    pub(super) fn largest(&self) -> f64 {
        largest(&self.residuals)
    }

    /// Takes the residuals as none, by moving the right-hand sides.
    pub(super) fn relax(&mut self, formulation: &mut Formulation) {
        formulation.relax(&mut self.residuals);
        self.violation = 0.0;
    }
}

/// Derivatives at the current iterate, and the gradient of the Lagrangian without bounds.
pub(super) struct Slopes {
    pub(super) derivatives: Derivatives,
    /// `grad f + J' lambda` over `y`.
    pub(super) lagrangian: Vec<f64>,
    products: Products,
}

impl Slopes {
    pub(super) fn new(nlp: &dyn Nlp, formulation: &Formulation) -> Self {
        let products = Products::new(nlp.stages(), &Triplets::default(), nlp.jacobian_structure());
        Slopes {
            derivatives: Derivatives::new(nlp),
            lagrangian: vec![0.0; formulation.len()],
            products,
        }
    }

    /// Evaluates at the iterate; `false` if anything is not finite.
    pub(super) fn evaluate(
        &mut self,
        nlp: &mut dyn Nlp,
        formulation: &Formulation,
        at: &Iterate,
        counts: &mut Counts,
    ) -> bool {
        counts.derivatives += 1;
        nlp.derivatives(&at.y[..formulation.variables], 1.0, &at.lambda, &mut self.derivatives);
        self.update_lagrangian(formulation, &at.lambda) && are_finite(&self.derivatives.hessian)
    }

    /// The gradient of the Lagrangian with these multipliers; fixed variables have none. `false` if
    /// it is not finite, which it is only where all of the Jacobian is.
    fn update_lagrangian(&mut self, formulation: &Formulation, lambda: &[f64]) -> bool {
        let Slopes { derivatives, products, lagrangian } = self;
        let (variables, slacks) = lagrangian.split_at_mut(formulation.variables);
        variables.copy_from_slice(&derivatives.gradient);
        products.transposed_multiply_add(&derivatives.jacobian, lambda, variables);
        let is_finite = are_finite(variables);
        for (value, fixed) in variables.iter_mut().zip(&formulation.fixed) {
            if *fixed {
                *value = 0.0;
            }
        }
        for (value, slack) in slacks.iter_mut().zip(&formulation.slacks) {
            *value = slack.cost + slack.sign * lambda[slack.row];
        }
        is_finite
    }
}
