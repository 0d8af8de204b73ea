//! A surface that is met where its function has a kink: `surface s = x + abs(y)` where `y` is 0.
//! When that happens depends on the side to which the state, or the time, is moved.

use super::kink::{Kink, KinkMet, is_met_oddly};
use super::parameter_kink::{first_with_kink, terms_of};
use super::reset_kink::Moved;
use crate::sensitivity::linearised::linearisation::{Lineariser, sliding};
use crate::simulate::{Cause, Instant, Piece, Regime, Tape};
use nalgebra::DVector;

/// The first surface that is met on a kink by states that quantities move; or on which the state
/// is where it crosses one along the kink, or together with another. Else that is an event with a
/// time of its own.
pub(crate) fn surface_kink(
    lineariser: &Lineariser,
    tape: &Tape,
    parameters: &[usize],
    events: &[Moved],
) -> Option<Kink> {
    events.iter().find_map(|Moved { event, states }| {
        let Piece::Event { before, cause, changes, .. } = &tape.pieces[*event] else { return None };
        let reached = match *cause {
            Cause::Reaches(surface) => Some(surface),
            Cause::CrossesKink(kink) if !is_met_oddly(lineariser, tape, before, kink) => {
                return None;
            }
            _ => None,
        };
        let regime = &tape.regimes[before.regime];
        let here = Here { lineariser, regime, at: before };
        let held = sliding(regime).into_iter();
        let held = held.filter(|_| matches!(cause, Cause::CrossesKink(_)));
        let mut met = reached.into_iter().chain(changes.iter().map(|it| it.surface)).chain(held);
        let surface = met.find(|surface| here.is_bent(*surface, parameters, states))?;
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
    fn is_bent(&self, surface: usize, parameters: &[usize], states: &[usize]) -> bool {
        let Instant { time, selectors, state, .. } = self.at;
        let own = &self.lineariser.parameters;
        let x = DVector::from_column_slice(state);
        let point = self.lineariser.table(self.regime, selectors, *time, &x);
        let terms = terms_of(&*self.lineariser.system.switching, &point, own);
        let is_kink = |value: f64, moved: &dyn Fn(f64) -> Moving| {
            let values = |by: f64| self.values(&moved(by));
            first_with_kink(value, surface..surface + 1, &terms, values).is_some()
        };
        let by_time = || is_kink(*time, &Moving::Time);
        let by_state = |at: &usize| is_kink(x[*at], &|by| Moving::State(*at, by));
        let by_parameter = |at: &usize| is_kink(own[*at], &|by| Moving::Parameter(*at, by));
        parameters.iter().any(by_parameter)
            || !states.is_empty() && (by_time() || states.iter().any(by_state))
    }

    /// With something moved, on the side of each kink where that is.
    fn values(&self, moved: &Moving) -> Vec<f64> {
        let Instant { time, selectors, state, .. } = self.at;
        let mut time = *time;
        let mut x = DVector::from_column_slice(state);
        let mut parameters = self.lineariser.parameters.clone();
        match *moved {
            Moving::Time(by) => time += by,
            Moving::State(at, by) => x[at] += by,
            Moving::Parameter(at, by) => parameters[at] += by,
        }
        let point = self.lineariser.table(self.regime, selectors, time, &x);
        let mut point: Vec<f64> = (0..point.columns()).map(|at| point.column(at)[0]).collect();
        self.lineariser.system.switching_at(&mut point, &parameters)
    }
}

/// What is moved, and by how much.
enum Moving {
    Time(f64),
    State(usize, f64),
    Parameter(usize, f64),
}
