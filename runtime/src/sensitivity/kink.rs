//! Kinks of the right side that are no surfaces: no step ends there, so a step across one is differentiated as if it were smooth.

use super::linearization::Linearizer;
use crate::problem::{Columns, Origin};
use crate::simulate::{Piece, Tape};
use nalgebra::DVector;

/// A kink that a trajectory crosses inside a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Kink {
    /// The right side.
    pub of: Origin,
    /// The beginning of the step.
    pub time: f64,
}

/// The first, by the signs at the ends of the steps.
pub(super) fn first_kink(linearizer: &Linearizer, tape: &Tape) -> Option<Kink> {
    let kinks = &linearizer.system.kinks;
    if kinks.outputs() == 0 {
        return None;
    }
    tape.pieces.iter().find_map(|piece| {
        let Piece::Step { start, h, end, .. } = piece else { return None };
        let at = |time: f64, state: &[f64]| {
            let state = DVector::from_column_slice(state);
            let table = linearizer.table(&tape.regimes[start.regime], &start.selectors, time, &state);
            let mut values = Columns::new(kinks.outputs(), 1);
            kinks.value(&table, &linearizer.parameters, &mut values);
            values
        };
        let [first, last] = [at(start.time, &start.state), at(start.time + h, end)];
        let crossed = (0..kinks.outputs()).find(|&row| first.column(row)[0] * last.column(row)[0] < 0.0)?;
        Some(Kink { of: kinks.origin(crossed), time: start.time })
    })
}
