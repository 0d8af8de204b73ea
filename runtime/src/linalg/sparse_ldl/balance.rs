//! Units of rows in which a symmetric matrix has entries of about the same size.

use crate::linalg::structure::columns::Columns;

/// So often all rows are divided by the root of their largest entry.
const ROUNDS: usize = 2;

/// Factors of rows and columns.
#[derive(Debug)]
pub(super) struct Balance {
    factors: Vec<f64>,
    largest: Vec<f64>,
}

impl Balance {
    pub(super) fn new(size: usize) -> Self {
        Balance { factors: vec![1.0; size], largest: vec![0.0; size] }
    }

    /// Balances the matrix with these values (Ruiz 2001). The factors are powers of two, so that
    /// nothing is rounded.
    pub(super) fn update(&mut self, pattern: &Columns, values: &[f64]) {
        self.factors.fill(1.0);
        for _ in 0..ROUNDS {
            self.largest.fill(0.0);
            for (row, column, value) in pattern.places() {
                let size = self.scaled(row, column, values[value]).abs();
                self.largest[row] = self.largest[row].max(size);
                self.largest[column] = self.largest[column].max(size);
            }
            for (factor, largest) in self.factors.iter_mut().zip(&self.largest) {
                *factor *= if *largest > 0.0 { power_of_two(1.0 / largest.sqrt()) } else { 1.0 };
            }
        }
    }

    /// An entry of the balanced matrix.
    pub(super) fn scaled(&self, row: usize, column: usize, value: f64) -> f64 {
        self.factors[row] * value * self.factors[column]
    }

    /// Multiplies a right side, or a solution of the balanced matrix, by the factors.
    pub(super) fn scale(&self, b: &mut [f64]) {
        b.iter_mut().zip(&self.factors).for_each(|(value, factor)| *value *= factor);
    }
}

/// The largest one that is not above a positive value: its exponent without the digits.
fn power_of_two(value: f64) -> f64 {
    f64::from_bits(value.to_bits() & f64::INFINITY.to_bits())
}
