//! A function of the problem with the tables that it is evaluated into.

use super::assembly::Contribution;
use crate::problem::{Columns, Function};
use std::sync::Arc;

/// Inputs, outputs and derivatives of a function at a fixed number of points.
pub(super) struct Tables {
    pub(super) function: Arc<dyn Function>,
    pub(super) points: Columns,
    pub(super) values: Columns,
    pub(super) jacobian: Columns,
    pub(super) hessian: Columns,
    pub(super) multipliers: Columns,
}

impl Tables {
    pub(super) fn new(function: &Arc<dyn Function>, count: usize) -> Self {
        let table = |columns| Columns::new(columns, count);
        Tables {
            points: table(function.layout().point_inputs()),
            values: table(function.outputs()),
            jacobian: table(function.jacobian_pattern().entries.len()),
            hessian: table(function.hessian_pattern().entries.len()),
            multipliers: table(function.outputs()),
            function: Arc::clone(function),
        }
    }

    /// The outputs at the points.
    pub(super) fn evaluate(&mut self, parameters: &[f64]) {
        self.function.value(&self.points, parameters, &mut self.values);
    }

    /// Outputs and derivatives at the points, with the multipliers as they stand.
    pub(super) fn differentiate(&mut self, parameters: &[f64]) {
        let Tables { function, points, values, jacobian, hessian, multipliers } = self;
        function.derivatives(points, parameters, multipliers, values, jacobian, hessian);
    }
}

/// Adds columns of a table to the values of a matrix, or puts them there.
pub(super) fn scatter(table: &Columns, moves: &[Contribution], values: &mut [f64]) {
    for &Contribution { column, coefficient, target } in moves {
        let column = table.column(column);
        let values = values[target.first..][..column.len()].iter_mut().zip(column);
        if target.is_new {
            values.for_each(|(value, d)| *value = coefficient * d);
        } else {
            values.for_each(|(value, d)| *value += coefficient * d);
        }
    }
}
