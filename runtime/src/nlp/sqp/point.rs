//! A point of the iteration and how far it is outside.

use crate::nlp::{Counts, Nlp};
use crate::problem::Bounds;

/// Variables, and objective and rows there.
#[derive(Clone, Debug)]
pub(super) struct Point {
    pub(super) v: Vec<f64>,
    pub(super) objective: f64,
    pub(super) rows: Vec<f64>,
    /// `theta`: the sum of all violations of rows. Bounds of variables are never violated.
    pub(super) violation: f64,
}

impl Point {
    /// Moves `v` between its bounds and evaluates there.
    pub(super) fn new(nlp: &mut dyn Nlp, mut v: Vec<f64>, counts: &mut Counts) -> Self {
        for (value, bounds) in v.iter_mut().zip(nlp.variable_bounds()) {
            *value = value.max(bounds.lower).min(bounds.upper);
        }
        counts.values += 1;
        let mut rows = vec![0.0; nlp.row_bounds().len()];
        let objective = nlp.values(&v, &mut rows);
        let violation = violation(nlp.row_bounds(), &rows);
        Point { v, objective, rows, violation }
    }

    /// Whether there is a number everywhere.
    pub(super) fn is_finite(&self) -> bool {
        self.objective.is_finite() && self.violation.is_finite()
    }
}

/// The sum of all violations.
pub(super) fn violation(bounds: &[Bounds], rows: &[f64]) -> f64 {
    bounds.iter().zip(rows).map(|(bounds, value)| bounds.violation(*value)).sum()
}
