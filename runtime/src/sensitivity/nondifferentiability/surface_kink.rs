//! A surface that is met where its function has a kink: `surface s = x + abs(y)` where `y` is 0.
//! When that happens depends on the side to which the state, or the time, is moved.

use super::kink::{Kink, KinkMet};
use super::parameter_kink::{first_with_kink, terms_of, values_of};
use super::reset_kink::Moved;
use crate::sensitivity::linearised::linearisation::Lineariser;
use crate::simulate::{Cause, Instant, Piece, Regime, Tape};
use nalgebra::DVector;

/// The first surface that is met on a kink by states that quantities move.
pub(crate) fn surface_kink(lineariser: &Lineariser, tape: &Tape, events: &[Moved]) -> Option<Kink> {
    events.iter().filter(|it| !it.states.is_empty()).find_map(|Moved { event, states }| {
        let Piece::Event { before, cause, changes, .. } = &tape.pieces[*event] else { return None };
        let reached = match *cause {
            Cause::Reaches(surface) => Some(surface),
            _ => None,
        };
        let here = Here { lineariser, regime: &tape.regimes[before.regime], at: before };
        let mut met = reached.into_iter().chain(changes.iter().map(|it| it.surface));
        let surface = met.find(|surface| here.is_bent(*surface, states))?;
        let of = lineariser.system.switching.origin(surface);
        Some(Kink { of, met: KinkMet::BySurface(before.time) })
    })
}

/// The functions of all surfaces at an instant.
struct Here<'h> {
    lineariser: &'h Lineariser<'h>,
    regime: &'h Regime,
    at: &'h Instant,
}

impl Here<'_> {
    fn is_bent(&self, surface: usize, states: &[usize]) -> bool {
        let x = DVector::from_column_slice(&self.at.state);
        let point = self.lineariser.table(self.regime, &self.at.selectors, self.at.time, &x);
        let switching = &*self.lineariser.system.switching;
        let terms = terms_of(switching, &point, &self.lineariser.parameters);
        let is_kink = |value: f64, values: &dyn Fn(f64) -> Vec<f64>| {
            first_with_kink(value, surface..surface + 1, &terms, values).is_some()
        };
        let by_time = is_kink(self.at.time, &|moved| self.values(moved, None));
        let by_state = |at: &usize| is_kink(x[*at], &|moved| self.values(0.0, Some((*at, moved))));
        by_time || states.iter().any(by_state)
    }

    /// With the time or a state moved.
    fn values(&self, later: f64, state: Option<(usize, f64)>) -> Vec<f64> {
        let mut x = DVector::from_column_slice(&self.at.state);
        state.into_iter().for_each(|(at, moved)| x[at] += moved);
        let Instant { time, selectors, .. } = self.at;
        let point = self.lineariser.table(self.regime, selectors, time + later, &x);
        values_of(&*self.lineariser.system.switching, &point, &self.lineariser.parameters)
    }
}
