//! A jump that finds the state, or the parameters, on a kink of what it assigns: `y := max(y, 1)`
//! where `y` is 1.

use super::kink::{Kink, KinkMet};
use super::parameter_kink::{first_with_kink, terms_of, values_of};
use crate::sensitivity::linearised::linearisation::Lineariser;
use crate::simulate::{EventKind, Instant, Piece, Regime, Tape};
use nalgebra::DVector;
use std::ops::Range;

/// An event of a tape, with the states that quantities move before it.
pub(crate) struct Moved {
    pub event: usize,
    pub states: Vec<usize>,
}

/// The first kink of a reset that one of these states, or of these parameters, is on.
pub(crate) fn reset_kink(
    lineariser: &Lineariser,
    tape: &Tape,
    parameters: &[usize],
    events: &[Moved],
) -> Option<Kink> {
    events.iter().find_map(|Moved { event, states }| {
        let Piece::Event { before, changes, .. } = &tape.pieces[*event] else { return None };
        let mut from = before;
        for change in changes {
            if let EventKind::Jump(jump) = change.kind {
                let count = before.state.len();
                let rows = jump * count..(jump + 1) * count;
                let here = Here { lineariser, regime: &tape.regimes[before.regime], from, rows };
                if let Some(row) = here.bent(parameters, states) {
                    let of = lineariser.system.resets.origin(row);
                    return Some(Kink { of, met: KinkMet::ByJump(before.time) });
                }
            }
            if change.after.time == before.time {
                from = &change.after;
            }
        }
        None
    })
}

/// What a jump assigns, at an instant.
struct Here<'h> {
    lineariser: &'h Lineariser<'h>,
    regime: &'h Regime,
    from: &'h Instant,
    rows: Range<usize>,
}

impl Here<'_> {
    fn bent(&self, parameters: &[usize], states: &[usize]) -> Option<usize> {
        let terms = self.terms();
        let first = |value: f64, values: &dyn Fn(f64) -> Vec<f64>| {
            first_with_kink(value, self.rows.clone(), &terms, values)
        };
        let by_parameter = |&at: &usize| {
            let value = self.lineariser.parameters[at];
            first(value, &|moved| self.values(None, Some((at, moved))))
        };
        let by_state =
            |&at: &usize| first(self.from.state[at], &|moved| self.values(Some((at, moved)), None));
        parameters.iter().find_map(by_parameter).or_else(|| states.iter().find_map(by_state))
    }

    /// The sizes of what all resets are sums of.
    fn terms(&self) -> Vec<f64> {
        let Instant { time, selectors, state, .. } = self.from;
        let x = DVector::from_column_slice(state);
        let point = self.lineariser.table(self.regime, selectors, *time, &x);
        terms_of(&*self.lineariser.system.resets, &point, &self.lineariser.parameters)
    }

    /// All resets with a state, or a parameter, moved.
    fn values(&self, state: Option<(usize, f64)>, parameter: Option<(usize, f64)>) -> Vec<f64> {
        let mut x = DVector::from_column_slice(&self.from.state);
        let mut parameters = self.lineariser.parameters.clone();
        state.into_iter().for_each(|(at, moved)| x[at] += moved);
        parameter.into_iter().for_each(|(at, moved)| parameters[at] += moved);
        let Instant { time, selectors, .. } = self.from;
        let point = self.lineariser.table(self.regime, selectors, *time, &x);
        values_of(&*self.lineariser.system.resets, &point, &parameters)
    }
}
