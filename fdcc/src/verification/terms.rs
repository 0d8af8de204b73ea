//! What a condition is the sum of: its slope by each input, times the size of that input.
//!
//! ```text
//!     size of c(z)  =  sum_i min(|dc/dz_i| s_i, max |c(z +- s_i e_i) - c(z)|)
//!     s_i           =  max(|z_i|, how far z_i moves)
//! ```
//!
//! At the end of a motion to `x == 0` the value of `x` is nothing; its size is how far it came. A
//! condition with a narrow peak is as steep as it is narrow: its terms are no larger than what the
//! whole size of an input changes.

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

/// What the terms of conditions are found from.
pub(super) struct Inputs<'a> {
    /// States, controls and times at some points.
    pub points: &'a Columns,
    /// The parameters.
    pub parameters: &'a [f64],
    /// How far each input of the points moves, then each parameter.
    pub motions: &'a [Motion],
}

/// For each output of a function its values at the points, with their terms where its bounds are
/// violated.
pub(super) fn terms(
    function: &dyn Function,
    inputs: &Inputs,
    bounds: &[Bounds],
) -> Vec<Vec<(f64, Terms)>> {
    let mut values = Columns::new(function.outputs(), inputs.points.count());
    function.value(inputs.points, inputs.parameters, &mut values);
    let with_none =
        |row: usize| values.column(row).iter().map(|value| (*value, Terms::default())).collect();
    let mut rows: Vec<Vec<(f64, Terms)>> = (0..function.outputs()).map(with_none).collect();
    let is_violated =
        |k: &usize| rows.iter().zip(bounds).any(|(row, it)| it.violation(row[*k].0) > 0.0);
    let violated: Vec<usize> = (0..inputs.points.count()).filter(is_violated).collect();
    if violated.is_empty() {
        return rows;
    }
    let points = inputs.points.selected(&violated);
    let inputs = Inputs { points: &points, ..*inputs };
    for (row, found) in rows.iter_mut().zip(inputs.sums(function)) {
        violated.iter().zip(found).for_each(|(k, terms)| row[*k].1 = terms);
    }
    rows
}

impl Inputs<'_> {
    /// The terms of each output at each point.
    fn sums(&self, function: &dyn Function) -> Vec<Vec<Terms>> {
        let count = self.points.count();
        let entries = &function.jacobian_pattern().entries;
        let mut values = Columns::new(function.outputs(), count);
        let mut slopes = Columns::new(entries.len(), count);
        function.jacobian(self.points, self.parameters, &mut values, &mut slopes);
        let mut rows = vec![vec![Terms::default(); count]; function.outputs()];
        for input in 0..self.motions.len() {
            let of_input =
                entries.iter().enumerate().filter(|(_, entry)| entry.1 as usize == input);
            let mut of_input = of_input.peekable();
            if of_input.peek().is_none() {
                continue;
            }
            let moved = [-1.0, 1.0].map(|side| self.moved(function, input, side));
            for (column, &(row, _)) in of_input {
                let row = row as usize;
                for (k, slope) in slopes.column(column).iter().enumerate() {
                    let own = values.column(row)[k];
                    let change = |other: &Columns| (other.column(row)[k] - own).abs();
                    let [least, most] = moved.each_ref().map(change);
                    // What has no value says nothing.
                    let most =
                        if (least + most).is_finite() { least.max(most) } else { f64::INFINITY };
                    rows[row][k].size += (slope.abs() * self.size(input, k)).min(most);
                    rows[row][k].rounding += slope.abs() * self.motions[input].rounding;
                }
            }
        }
        rows
    }

    /// Which of the parameters an input is.
    fn parameter(&self, input: usize) -> Option<usize> {
        input.checked_sub(self.points.columns())
    }

    /// The size of an input at a point.
    fn size(&self, input: usize, k: usize) -> f64 {
        let value = match self.parameter(input) {
            Some(at) => self.parameters[at],
            None => self.points.column(input)[k],
        };
        value.abs().max(self.motions[input].range)
    }

    /// The values where one input is larger by its whole size, or less.
    fn moved(&self, function: &dyn Function, input: usize, side: f64) -> Columns {
        let (mut points, mut parameters) = (self.points.clone(), self.parameters.to_vec());
        match self.parameter(input) {
            Some(at) => parameters[at] += side * self.size(input, 0),
            None => {
                let moves: Vec<f64> =
                    (0..points.count()).map(|k| side * self.size(input, k)).collect();
                points.column_mut(input).iter_mut().zip(moves).for_each(|(value, by)| *value += by);
            }
        }
        let mut values = Columns::new(function.outputs(), points.count());
        function.value(&points, &parameters, &mut values);
        values
    }
}
