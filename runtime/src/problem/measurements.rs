//! Sums over rows of measured data: terms that read the trajectory at times inside intervals.

use super::{Columns, Function, Origin, Problem};
use std::sync::Arc;

/// How states at a time inside an interval come from the variables there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolant {
    /// The polynomial of a collocation scheme.
    Polynomial,
    /// The cubic Hermite polynomial between the ends of a step.
    Hermite,
}

/// A sum over rows, each with a time of its own.
#[derive(Clone)]
pub struct Measurements {
    /// Where it stands.
    pub origin: Origin,
    /// The real time of each row.
    pub times: Vec<f64>,
    /// What was measured: one point for each row.
    pub columns: Columns,
    /// Its only output is the term of a row. Inputs `[tau | x | u | p | s]` with the normalised
    /// time of the row, 0 or 1 for one outside; differentiated by `x`, `u` and the unknowns.
    ///
    /// Of a polynomial `x` holds the states at the time of the row and, where a parameter moves
    /// rows or an end of time, their first and then their second derivatives by normalised time;
    /// `u` the same of the controls; `s` the columns. Of a Hermite polynomial `x` holds the states
    /// at both ends of the step, `u` the controls at both; `s` the columns, the normalised time at
    /// which the step begins, and its length.
    pub function: Arc<dyn Function>,
    /// Which of the two.
    pub interpolant: Interpolant,
    /// The state that grows by the term at the time of each row; none if the sum is a part of the
    /// objective.
    pub state: Option<usize>,
    /// Whether rows before its time and rows behind it belong to other phases; else they are at the
    /// ends of its time.
    pub is_shared: [bool; 2],
}

impl Measurements {
    /// Whether a row at this normalised time is one of this phase. One between two phases belongs
    /// to the second, and so does one of a phase without a duration, whose time is no number.
    pub(crate) fn has(&self, tau: f64) -> bool {
        let [before, behind] = self.is_shared;
        if tau.is_nan() {
            return !behind;
        }
        (!before || tau >= 0.0) && (!behind || tau < 1.0)
    }
}

impl Problem {
    /// First and last time with these values of `p`.
    pub fn ends(&self, parameters: &[f64]) -> [f64; 2] {
        let points = Columns::new(self.interval.layout().point_inputs(), 1);
        let mut values = Columns::new(self.interval.outputs(), 1);
        self.interval.value(&points, parameters, &mut values);
        [values.column(0)[0], values.column(1)[0]]
    }
}
