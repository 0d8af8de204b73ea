//! What to differentiate by, as directions in the space of parameters, starts and controls.

use crate::simulate::{Controls, Regime, System};
use nalgebra::DMatrix;

/// A number that a derivative can be taken by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// An entry of `p`.
    Parameter(usize),
    /// The start of a state, whatever it is computed from.
    Start(usize),
    /// A control in a row of [`Controls::Held`]. Where the interval moves, the rows keep their normalised times.
    Control {
        /// The row.
        row: usize,
        /// The control.
        control: usize,
    },
}

/// One column for each quantity.
pub(super) struct Directions<'q> {
    quantities: &'q [Quantity],
    controls: usize,
    /// `dp`.
    pub parameters: DMatrix<f64>,
    /// The part of `dx(t0)` that does not come from parameters.
    pub starts: DMatrix<f64>,
}

impl<'q> Directions<'q> {
    pub fn new(system: &System, quantities: &'q [Quantity]) -> Self {
        let mut parameters = DMatrix::zeros(system.layout.p, quantities.len());
        let mut starts = DMatrix::zeros(system.layout.x, quantities.len());
        for (column, quantity) in quantities.iter().enumerate() {
            match *quantity {
                Quantity::Parameter(at) => parameters[(at, column)] = 1.0,
                Quantity::Start(at) => starts[(at, column)] = 1.0,
                Quantity::Control { .. } => {}
            }
        }
        Directions { quantities, controls: system.layout.u, parameters, starts }
    }

    pub fn count(&self) -> usize {
        self.quantities.len()
    }

    /// `d(u, p)` in a regime.
    pub fn inputs(&self, regime: &Regime) -> DMatrix<f64> {
        let mut inputs = DMatrix::zeros(self.controls + self.parameters.nrows(), self.count());
        inputs.rows_mut(self.controls, self.parameters.nrows()).copy_from(&self.parameters);
        for (column, quantity) in self.quantities.iter().enumerate() {
            if let Quantity::Control { row, control } = *quantity
                && regime.row == Some(row)
            {
                inputs[(control, column)] = 1.0;
            }
        }
        inputs
    }
}

/// The derivative of a scalar by everything there is: by `p`, by the start, by the controls of each row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Gradient {
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
