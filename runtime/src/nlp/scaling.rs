//! A programme whose objective and rows have gradients of moderate size at the start.
//!
//! As in Ipopt (Waechter & Biegler 2006, section 3.8): factors `min(1, 100 / ||gradient||)`, never below 1e-8.

use super::{Derivatives, Multipliers, Nlp, Place};
use crate::linalg::{Stages, Triplets};
use crate::problem::Bounds;

/// Gradients above this are scaled down to it.
const LARGEST_GRADIENT: f64 = 100.0;
const SMALLEST_FACTOR: f64 = 1e-8;

/// `objective * f` and `rows[i] * c_i` of the programme inside.
pub(crate) struct Scaled<'a> {
    inner: &'a mut dyn Nlp,
    pub(crate) objective: f64,
    pub(crate) rows: Vec<f64>,
    bounds: Vec<Bounds>,
    multipliers: Vec<f64>,
    /// Factor of each Jacobian value; none where no row is scaled, as is usual.
    entries: Vec<f64>,
}

impl<'a> Scaled<'a> {
    /// Chooses the factors from the gradients at `v`.
    pub(crate) fn new(inner: &'a mut dyn Nlp, v: &[f64]) -> Self {
        let count = inner.row_bounds().len();
        let mut derivatives = Derivatives::new(inner);
        inner.derivatives(v, 0.0, &vec![0.0; count], &mut derivatives);
        let mut largest = vec![0.0f64; count];
        for ((row, _), value) in inner.jacobian_structure().entries().zip(&derivatives.jacobian) {
            largest[row] = largest[row].max(value.abs());
        }
        let rows: Vec<f64> = largest.into_iter().map(factor).collect();
        let objective = factor(derivatives.gradient.iter().fold(0.0, |largest: f64, g| largest.max(g.abs())));
        let bounds = inner.row_bounds().iter().zip(&rows);
        let bounds = bounds.map(|(b, s)| Bounds { lower: b.lower * s, upper: b.upper * s }).collect();
        let mut entries = Vec::new();
        if rows.iter().any(|s| *s != 1.0) {
            entries.extend(inner.jacobian_structure().entries().map(|(row, _)| rows[row]));
        }
        Scaled { inner, objective, rows, bounds, multipliers: vec![0.0; count], entries }
    }

    /// Multipliers of the programme inside, from those of this one.
    pub(crate) fn unscale(&self, multipliers: &mut Multipliers) {
        let by_objective = 1.0 / self.objective;
        multipliers.rows.iter_mut().zip(&self.rows).for_each(|(value, s)| *value *= s * by_objective);
        multipliers.lower.iter_mut().chain(&mut multipliers.upper).for_each(|value| *value *= by_objective);
    }

    /// Multipliers of this programme, from those of the one inside.
    pub(crate) fn scale(&self, multipliers: &mut Multipliers) {
        multipliers.rows.iter_mut().zip(&self.rows).for_each(|(value, s)| *value *= self.objective / s);
        multipliers.lower.iter_mut().chain(&mut multipliers.upper).for_each(|value| *value *= self.objective);
    }
}

fn factor(gradient: f64) -> f64 {
    if gradient > LARGEST_GRADIENT { (LARGEST_GRADIENT / gradient).max(SMALLEST_FACTOR) } else { 1.0 }
}

impl Nlp for Scaled<'_> {
    fn variable_bounds(&self) -> &[Bounds] {
        self.inner.variable_bounds()
    }
    fn row_bounds(&self) -> &[Bounds] {
        &self.bounds
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
    fn values(&mut self, v: &[f64], rows: &mut [f64]) -> f64 {
        let objective = self.inner.values(v, rows);
        rows.iter_mut().zip(&self.rows).for_each(|(value, s)| *value *= s);
        self.objective * objective
    }
    fn derivatives(&mut self, v: &[f64], weight: f64, multipliers: &[f64], out: &mut Derivatives) {
        for ((target, multiplier), s) in self.multipliers.iter_mut().zip(multipliers).zip(&self.rows) {
            *target = multiplier * s;
        }
        self.inner.derivatives(v, weight * self.objective, &self.multipliers, out);
        out.gradient.iter_mut().for_each(|value| *value *= self.objective);
        out.jacobian.iter_mut().zip(&self.entries).for_each(|(value, s)| *value *= s);
    }
    fn row_place(&self, row: usize) -> Place {
        self.inner.row_place(row)
    }
    fn not_finite(&mut self, v: &[f64]) -> Option<Place> {
        self.inner.not_finite(v)
    }
}
