//! What to differentiate by, as directions in the space of parameters, starts and controls.

use crate::simulate::{Controls, Regime, System};
use nalgebra::DMatrix;
use std::collections::BTreeMap;

/// A number that a derivative can be taken by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// An entry of `p`.
    Parameter(usize),
    /// The start of a state, whatever it is computed from.
    Start(usize),
    /// A control in a row of [`Controls::Held`]. Where the interval moves, the rows keep their
    /// normalised times.
    Control {
        /// The row.
        row: usize,
        /// The control.
        control: usize,
    },
}

/// Directions in the space of all quantities, one column each.
pub(crate) struct Directions {
    count: usize,
    control_count: usize,
    /// `dp`.
    pub parameters: DMatrix<f64>,
    /// The part of `dx(t0)` that does not come from parameters.
    pub starts: DMatrix<f64>,
    /// `(control, direction, amount)` for the rows in which some control moves.
    controls: BTreeMap<usize, Vec<(usize, usize, f64)>>,
}

impl Directions {
    /// Each quantity alone.
    pub fn each(system: &System, quantities: &[Quantity]) -> Self {
        Self::new(system, quantities, &DMatrix::identity(quantities.len(), quantities.len()))
    }

    /// Sums of the quantities, weighted by the columns of a matrix.
    pub fn new(system: &System, quantities: &[Quantity], weights: &DMatrix<f64>) -> Self {
        let count = weights.ncols();
        let mut directions = Directions {
            count,
            control_count: system.layout.u,
            parameters: DMatrix::zeros(system.layout.p, count),
            starts: DMatrix::zeros(system.layout.x, count),
            controls: BTreeMap::new(),
        };
        for (quantity, weights) in quantities.iter().zip(weights.row_iter()) {
            for (column, &weight) in
                weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0)
            {
                directions.add(quantity, column, weight);
            }
        }
        directions
    }

    fn add(&mut self, quantity: &Quantity, column: usize, weight: f64) {
        match *quantity {
            Quantity::Parameter(at) => self.parameters[(at, column)] += weight,
            Quantity::Start(at) => self.starts[(at, column)] += weight,
            Quantity::Control { row, control } => {
                self.controls.entry(row).or_default().push((control, column, weight));
            }
        }
    }

    pub fn count(&self) -> usize {
        self.count
    }

    /// `d(u, p)` in a regime.
    pub fn inputs(&self, regime: &Regime) -> DMatrix<f64> {
        let mut inputs = DMatrix::zeros(self.control_count + self.parameters.nrows(), self.count);
        inputs.rows_mut(self.control_count, self.parameters.nrows()).copy_from(&self.parameters);
        let moved = regime.row.and_then(|row| self.controls.get(&row));
        for &(control, column, weight) in moved.into_iter().flatten() {
            inputs[(control, column)] += weight;
        }
        inputs
    }
}

/// The derivative of a scalar by everything there is: by `p`, by the start, by the controls of each
/// row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Gradient {
    pub parameters: Vec<f64>,
    pub starts: Vec<f64>,
    pub controls: Vec<Vec<f64>>,
}

impl Gradient {
    pub fn zero(system: &System, controls: &Controls) -> Self {
        let rows = match controls {
            Controls::Guess => 0,
            Controls::Held { rows, .. } => rows.len(),
        };
        Gradient {
            parameters: vec![0.0; system.layout.p],
            starts: vec![0.0; system.layout.x],
            controls: vec![vec![0.0; system.layout.u]; rows],
        }
    }

    /// The entry for a quantity.
    pub fn by(&self, quantity: &Quantity) -> f64 {
        match *quantity {
            Quantity::Parameter(at) => self.parameters[at],
            Quantity::Start(at) => self.starts[at],
            Quantity::Control { row, control } => self.controls[row][control],
        }
    }

    /// Adds the derivative by `(u, p)` in a regime.
    pub fn add_inputs(&mut self, regime: &Regime, controls: usize, by: impl Iterator<Item = f64>) {
        for (at, value) in by.enumerate() {
            match (at.checked_sub(controls), regime.row) {
                (Some(parameter), _) => self.parameters[parameter] += value,
                (None, Some(row)) => self.controls[row][at] += value,
                (None, None) => {}
            }
        }
    }
}
