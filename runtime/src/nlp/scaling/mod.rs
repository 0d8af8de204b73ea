//! An NLP in other units, with numbers of moderate size ([`factors`]).
//!
//! ```text
//!     minimise  s f(V w)   subject to   R lower <= R c(V w) <= R upper,   lower <= V w <= upper
//! ```
//!
//! Newton's step is the same in all units; regularisation, tolerances and the norm of violations
//! are not.

pub(in crate::nlp) mod factors;
mod nominal;

use super::{Derivatives, Multipliers, Nlp, Place, Quantities, Start};
use crate::linalg::{PhaseStages, Stages, Triplets};
use crate::problem::Bounds;
use factors::ScalingFactors;
pub(crate) use factors::objective_unit;
use std::cell::OnceCell;
use std::sync::Arc;

/// The scaled NLP.
pub(crate) struct Scaled<'a> {
    inner: &'a mut dyn Nlp,
    factors: ScalingFactors,
    variable_bounds: Vec<Bounds>,
    constraint_bounds: Vec<Bounds>,
    /// A point and multipliers of the NLP inside.
    point: Vec<f64>,
    multipliers: Vec<f64>,
    /// ScalingFactors of Jacobian and Hessian values; none where all are 1, as is usual.
    entries: Vec<f64>,
    curvatures: Vec<f64>,
    /// Nothing as long as nobody asks.
    quantities: OnceCell<Arc<Quantities>>,
}

impl<'a> Scaled<'a> {
    /// With these factors.
    pub(in crate::nlp) fn with(inner: &'a mut dyn Nlp, factors: ScalingFactors) -> Self {
        let ScalingFactors { variables, rows, .. } = &factors;
        let scaled =
            |bounds: &Bounds, s: f64| Bounds { lower: bounds.lower * s, upper: bounds.upper * s };
        let of_variables = inner.variable_bounds().iter().zip(variables);
        let of_rows = inner.constraint_bounds().iter().zip(rows);
        let entries = products(inner.jacobian_structure(), rows, variables);
        let curvatures = products(inner.hessian_structure(), variables, variables);
        Scaled {
            variable_bounds: of_variables.map(|(bounds, s)| scaled(bounds, 1.0 / s)).collect(),
            constraint_bounds: of_rows.map(|(bounds, s)| scaled(bounds, *s)).collect(),
            point: variables.clone(),
            multipliers: rows.clone(),
            entries: unless_one(entries),
            curvatures: unless_one(curvatures),
            quantities: OnceCell::new(),
            inner,
            factors,
        }
    }

    /// Whether all factors are 1: then the measures of both programs are the same.
    pub(crate) fn is_as_written(&self) -> bool {
        let ScalingFactors { objective, variables, rows } = &self.factors;
        *objective == 1.0 && variables.iter().chain(rows).all(|s| *s == 1.0)
    }

    /// What the objective is multiplied by.
    pub(crate) fn objective(&self) -> f64 {
        self.factors.objective
    }

    /// A start of the NLP inside as one of this NLP.
    pub(crate) fn start(&self, start: &Start) -> Start {
        let ScalingFactors { objective, variables, rows } = &self.factors;
        let mut start = start.clone();
        start.v.iter_mut().zip(variables).for_each(|(value, s)| *value /= s);
        if let Some(Multipliers { constraints: of_rows, lower, upper }) =
            start.warm.as_mut().map(|warm| &mut warm.multipliers)
        {
            of_rows.iter_mut().zip(rows).for_each(|(value, s)| *value *= objective / s);
            for bounds in [lower, upper] {
                bounds.iter_mut().zip(variables).for_each(|(value, s)| *value *= objective * s);
            }
        }
        start
    }

    /// A point and multipliers of this NLP as those of the NLP inside.
    pub(crate) fn unscale(&self, v: &mut [f64], multipliers: &mut Multipliers) {
        let ScalingFactors { objective, variables, rows } = &self.factors;
        self.unscale_point(v);
        multipliers.constraints.iter_mut().zip(rows).for_each(|(value, s)| *value *= s / objective);
        for bounds in [&mut multipliers.lower, &mut multipliers.upper] {
            bounds.iter_mut().zip(variables).for_each(|(value, s)| *value /= objective * s);
        }
    }

    /// A point of this NLP as one of the NLP inside.
    pub(crate) fn unscale_point(&self, v: &mut [f64]) {
        v.iter_mut().zip(&self.factors.variables).for_each(|(value, s)| *value *= s);
    }

    fn scaled_quantities(&self) -> Quantities {
        let own = self.inner.quantities();
        // All variables of a quantity have one factor.
        let mut units = own.units.clone();
        for (i, s) in own.variables.iter().zip(&self.factors.variables) {
            units[*i] = own.units[*i] / s;
        }
        Quantities { units, ..(*own).clone() }
    }

    fn load(&mut self, w: &[f64]) {
        let both = w.iter().zip(&self.factors.variables);
        self.point.iter_mut().zip(both).for_each(|(v, (w, s))| *v = w * s);
    }
}

/// The factor of the row times that of the column, of each entry.
fn products(structure: &Triplets, rows: &[f64], columns: &[f64]) -> Vec<f64> {
    let mut products = Vec::with_capacity(structure.len());
    structure.entries().for_each(|(row, column)| products.push(rows[row] * columns[column]));
    products
}

/// Nothing where all are 1.
fn unless_one(factors: Vec<f64>) -> Vec<f64> {
    if factors.iter().all(|s| *s == 1.0) { Vec::new() } else { factors }
}

impl Nlp for Scaled<'_> {
    fn variable_bounds(&self) -> &[Bounds] {
        &self.variable_bounds
    }
    fn constraint_bounds(&self) -> &[Bounds] {
        &self.constraint_bounds
    }
    fn jacobian_structure(&self) -> &Triplets {
        self.inner.jacobian_structure()
    }
    fn hessian_structure(&self) -> &Triplets {
        self.inner.hessian_structure()
    }
    fn stages(&self) -> Option<Stages> {
        self.inner.stages()
    }
    fn phases(&self) -> Vec<PhaseStages> {
        self.inner.phases()
    }
    fn quantities(&self) -> Arc<Quantities> {
        Arc::clone(self.quantities.get_or_init(|| Arc::new(self.scaled_quantities())))
    }
    fn objective_size(&mut self, terms: f64) -> f64 {
        let scale = self.factors.objective;
        scale * self.inner.objective_size(terms / scale)
    }
    fn objective_unit(&mut self) -> f64 {
        self.factors.objective * self.inner.objective_unit()
    }
    fn values(&mut self, w: &[f64], rows: &mut [f64]) -> f64 {
        self.load(w);
        let objective = self.inner.values(&self.point, rows);
        rows.iter_mut().zip(&self.factors.rows).for_each(|(value, s)| *value *= s);
        self.factors.objective * objective
    }
    fn derivatives(&mut self, w: &[f64], weight: f64, multipliers: &[f64], out: &mut Derivatives) {
        self.load(w);
        let ScalingFactors { objective, variables, rows } = &self.factors;
        for ((target, multiplier), s) in self.multipliers.iter_mut().zip(multipliers).zip(rows) {
            *target = multiplier * s;
        }
        self.inner.derivatives(&self.point, weight * objective, &self.multipliers, out);
        out.gradient.iter_mut().zip(variables).for_each(|(value, s)| *value *= objective * s);
        out.jacobian.iter_mut().zip(&self.entries).for_each(|(value, s)| *value *= s);
        out.hessian.iter_mut().zip(&self.curvatures).for_each(|(value, s)| *value *= s);
    }
    fn has_kinks(&self) -> bool {
        self.inner.has_kinks()
    }
    fn is_linear(&self, row: usize) -> bool {
        self.inner.is_linear(row)
    }
    fn constraint_place(&self, row: usize) -> Place {
        self.inner.constraint_place(row)
    }
    fn not_finite(&mut self, w: &[f64]) -> Option<Place> {
        self.load(w);
        self.inner.not_finite(&self.point)
    }
}
