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
        let own = Moving { parameters, states, time: !states.is_empty() };
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
        let surface = met.find(|surface| here.is_bent(*surface, &own))?;
        let of = lineariser.system.switching.origin(surface);
        Some(Kink { of, met: KinkMet::BySurface(before.time) })
    })
}

/// A surface that holds the state where it ends, on a kink of its function: the rate there, and so
/// what a little more time makes of the state, is that of one side.
pub(crate) fn kink_at_the_end(
    lineariser: &Lineariser,
    tape: &Tape,
    parameters: &[usize],
    states: &[usize],
) -> Option<Kink> {
    let moves = |at: &usize| lineariser.ends_by[(1, *at)] != 0.0;
    let moving = Moving { parameters, states, time: parameters.iter().any(moves) };
    let is_step = |piece: &&Piece| matches!(piece, Piece::Step { .. });
    // What leaves at the last time was still held before.
    let lasts = [tape.pieces.last()?, tape.pieces.iter().rev().find(is_step)?];
    let surface = lasts.map(Piece::end).iter().find_map(|at| {
        let regime = &tape.regimes[at.regime];
        let here = Here { lineariser, regime, at };
        sliding(regime).into_iter().find(|surface| here.is_bent(*surface, &moving))
    })?;
    let of = lineariser.system.switching.origin(surface);
    Some(Kink { of, met: KinkMet::BySurface(lineariser.system.interval[1]) })
}

/// What quantities move.
struct Moving<'m> {
    parameters: &'m [usize],
    states: &'m [usize],
    time: bool,
}

/// The functions of all surfaces at an instant.
struct Here<'h> {
    lineariser: &'h Lineariser<'h>,
    regime: &'h Regime,
    at: &'h Instant,
}

impl Here<'_> {
    fn is_bent(&self, surface: usize, moving: &Moving) -> bool {
        let Instant { time, selectors, state, .. } = self.at;
        let own = &self.lineariser.parameters;
        let x = DVector::from_column_slice(state);
        let point = self.lineariser.table(self.regime, selectors, *time, &x);
        let terms = terms_of(&*self.lineariser.system.switching, &point, own);
        let is_kink = |value: f64, moved: &dyn Fn(f64) -> Shift| {
            let values = |by: f64| self.values(&moved(by));
            first_with_kink(value, surface..surface + 1, &terms, values).is_some()
        };
        let by_state = |at: &usize| is_kink(x[*at], &|by| Shift::State(*at, by));
        let by_parameter = |at: &usize| is_kink(own[*at], &|by| Shift::Parameter(*at, by));
        moving.parameters.iter().any(by_parameter)
            || moving.time && is_kink(*time, &Shift::Time)
            || moving.states.iter().any(by_state)
    }

    /// With something moved, on the side of each kink where that is.
    fn values(&self, moved: &Shift) -> Vec<f64> {
        let Instant { time, selectors, state, .. } = self.at;
        let mut time = *time;
        let mut x = DVector::from_column_slice(state);
        let mut parameters = self.lineariser.parameters.clone();
        match *moved {
            Shift::Time(by) => time += by,
            Shift::State(at, by) => x[at] += by,
            Shift::Parameter(at, by) => parameters[at] += by,
        }
        let point = self.lineariser.table(self.regime, selectors, time, &x);
        let mut point: Vec<f64> = (0..point.columns()).map(|at| point.column(at)[0]).collect();
        self.lineariser.system.switching_at(&mut point, &parameters)
    }
}

/// What is moved, and by how much.
enum Shift {
    Time(f64),
    State(usize, f64),
    Parameter(usize, f64),
}
