//! What a condition is the sum of: its slope by each input, times the size of that input.
//!
//! ```text
//!     size of c(z)  =  sum_i |dc/dz_i| max(|z_i|, how far z_i moves)
//! ```
//!
//! At the end of a motion to `x == 0` the value of `x` is nothing; its size is how far it came.

use super::motion::Motion;
use fdcc_runtime::problem::{Bounds, Columns, Function};

/// The size of the terms of a condition at a point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Terms {
    /// In SI.
    pub size: f64,
    /// A smaller violation is rounding.
    pub rounding: f64,
}

impl Terms {
    /// The violation of a value as a part of its terms, the bound included; 0 where it is rounding.
    pub fn part(&self, value: f64, bounds: &Bounds) -> f64 {
        let violation = bounds.violation(value);
        if violation <= self.rounding {
            return 0.0;
        }
        let bound = if value > bounds.upper { bounds.upper } else { bounds.lower };
        violation / self.size.max(bound.abs()).max(self.rounding)
    }
}

/// For each output of a function its values at some points, with their terms; `motions` are those
/// of the inputs that the points have, then of the parameters.
pub(super) fn terms(
    function: &dyn Function,
    (points, parameters): (&Columns, &[f64]),
    motions: &[Motion],
) -> Vec<Vec<(f64, Terms)>> {
    let entries = &function.jacobian_pattern().entries;
    let mut values = Columns::new(function.outputs(), points.count());
    let mut slopes = Columns::new(entries.len(), points.count());
    function.jacobian(points, parameters, &mut values, &mut slopes);
    let with_none =
        |row: usize| values.column(row).iter().map(|value| (*value, Terms::default())).collect();
    let mut rows: Vec<Vec<(f64, Terms)>> = (0..function.outputs()).map(with_none).collect();
    let parameter = function.layout().parameters();
    for (column, &(row, input)) in entries.iter().enumerate() {
        let (row, input) = (row as usize, input as usize);
        for (k, ((_, terms), slope)) in rows[row].iter_mut().zip(slopes.column(column)).enumerate()
        {
            let value = match input.checked_sub(parameter.start) {
                Some(at) => parameters[at],
                None => points.column(input)[k],
            };
            terms.size += slope.abs() * value.abs().max(motions[input].range);
            terms.rounding += slope.abs() * motions[input].rounding;
        }
    }
    rows
}
