//! The right side with its derivatives, as dense matrices.

use super::{Field, column_values};
use crate::problem::{Columns, Function};
use nalgebra::DMatrix;
use std::ops::Range;

impl Field<'_> {
    /// Values and the derivatives by one kind of inputs, as a dense matrix.
    pub(crate) fn jacobian(
        &self,
        function: &dyn Function,
        inputs: Range<usize>,
    ) -> (Vec<f64>, DMatrix<f64>) {
        let pattern = function.jacobian_pattern();
        let mut values = Columns::new(function.outputs(), 1);
        let mut entries = Columns::new(pattern.entries.len(), 1);
        function.jacobian(&self.point, &self.parameters, &mut values, &mut entries);
        let mut matrix = DMatrix::zeros(function.outputs(), inputs.len());
        for (at, &(row, column)) in pattern.entries.iter().enumerate() {
            if inputs.contains(&(column as usize)) {
                matrix[(row as usize, column as usize - inputs.start)] = entries.column(at)[0];
            }
        }
        (column_values(&values), matrix)
    }

    /// `f` and `df/ds` where all selectors are given.
    pub fn with_selectors(
        &mut self,
        t: f64,
        x: &[f64],
        selectors: &[f64],
    ) -> (Vec<f64>, DMatrix<f64>) {
        self.derivatives(t, x, selectors, self.system.layout.selectors())
    }

    /// `df/dx` in the current mode.
    pub fn by_state(&mut self, t: f64, x: &[f64]) -> DMatrix<f64> {
        let selectors = self.selectors.clone();
        self.derivatives(t, x, &selectors, self.system.layout.states()).1
    }

    /// `f` and `df/dx` where all selectors are given.
    pub fn by_state_with(
        &mut self,
        t: f64,
        x: &[f64],
        selectors: &[f64],
    ) -> (Vec<f64>, DMatrix<f64>) {
        self.derivatives(t, x, selectors, self.system.layout.states())
    }

    /// The derivative of the right side in the current mode, in which the selectors of sliding
    /// surfaces follow the state: `f_x + f_s s_x` with `psi'_s s_x = -psi'_x`.
    pub fn jacobian_of_mode(&mut self, t: f64, x: &[f64]) -> DMatrix<f64> {
        let (states, selectors) = (self.system.layout.states(), self.system.layout.selectors());
        let now = self.selectors_at(t, x);
        let (_, by_inputs) = self.derivatives(t, x, &now, 0..selectors.end);
        let by_state = by_inputs.columns(states.start, states.len()).into_owned();
        let sliding = self.sliding();
        if sliding.is_empty() {
            return by_state;
        }
        let (_, rates) = self.jacobian(&*self.system.rates, 0..selectors.end);
        let rates = rates.select_rows(&sliding);
        let places: Vec<usize> = sliding.iter().map(|&i| selectors.start + i).collect();
        let follows =
            rates.select_columns(&places).lu().solve(&rates.columns(states.start, states.len()));
        match follows {
            Some(follows) => by_state - by_inputs.select_columns(&places) * follows,
            None => by_state,
        }
    }

    fn derivatives(
        &mut self,
        t: f64,
        x: &[f64],
        selectors: &[f64],
        by: Range<usize>,
    ) -> (Vec<f64>, DMatrix<f64>) {
        self.evaluations += 1;
        self.set_point(t, x, Some(selectors));
        let (mut rate, mut matrix) = self.jacobian(&*self.system.flow, by);
        for &state in &self.held {
            rate[state] = 0.0;
            matrix.row_mut(state).fill(0.0);
        }
        (rate, matrix)
    }
}
