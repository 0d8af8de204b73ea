//! What to differentiate by, as directions in the space of parameters, starts and controls.

use crate::simulate::{Controls, Regime, System};
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;
use std::ops::Range;

/// A number that a derivative can be taken by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// An entry of `p`.
    Parameter(usize),
    /// The start of a state, whatever it is computed from.
    Start(usize),
    /// A control in one of the [`Controls::rows`]. Where the interval moves, the rows keep their
    /// normalised times.
    Control {
        /// The row.
        row: usize,
        /// The control.
        control: usize,
    },
}

/// Directions in the space of all quantities, one column each.
pub(crate) struct Directions<'a> {
    count: usize,
    control_count: usize,
    of: &'a Controls,
    /// `dp`.
    pub parameters: DMatrix<f64>,
    /// The part of `dx(t0)` that does not come from parameters.
    pub starts: DMatrix<f64>,
    /// `(control, direction, amount)` for the rows in which some control moves.
    controls: BTreeMap<usize, Vec<(usize, usize, f64)>>,
}

impl<'a> Directions<'a> {
    /// Each quantity alone.
    pub fn each(system: &System, controls: &'a Controls, quantities: &[Quantity]) -> Self {
        let weights = DMatrix::identity(quantities.len(), quantities.len());
        Self::new(system, controls, quantities, &weights)
    }

    /// Sums of the quantities, weighted by the columns of a matrix.
    pub fn new(
        system: &System,
        controls: &'a Controls,
        quantities: &[Quantity],
        weights: &DMatrix<f64>,
    ) -> Self {
        let count = weights.ncols();
        let mut directions = Directions {
            count,
            control_count: system.layout.u,
            of: controls,
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

    /// `d(U, p)` in a regime.
    pub fn inputs(&self, regime: &Regime) -> DMatrix<f64> {
        let rows = self.of.range(regime.segment);
        let (numbers, parameters) =
            (self.control_count * rows.len().max(1), self.parameters.nrows());
        let mut inputs = DMatrix::zeros(numbers + parameters, self.count);
        inputs.rows_mut(numbers, parameters).copy_from(&self.parameters);
        for (k, row) in rows.enumerate() {
            for &(control, column, weight) in self.controls.get(&row).into_iter().flatten() {
                inputs[(k * self.control_count + control, column)] += weight;
            }
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
        Gradient {
            parameters: vec![0.0; system.layout.p],
            starts: vec![0.0; system.layout.x],
            controls: vec![vec![0.0; system.layout.u]; controls.rows().len()],
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

    /// Adds the derivative by `(U, p)` where `U` are the numbers of some rows.
    pub fn add_inputs(&mut self, rows: Range<usize>, by: &DVector<f64>) {
        let first = by.len() - self.parameters.len();
        let parameters = self.parameters.iter_mut();
        let numbers = self.controls[rows].iter_mut().flatten();
        parameters.zip(by.iter().skip(first)).for_each(|(sum, by)| *sum += by);
        numbers.zip(by.iter()).for_each(|(sum, by)| *sum += by);
    }
}
