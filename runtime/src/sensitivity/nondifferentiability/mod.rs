//! Where a trajectory has no derivative, or is so near such a place that one cannot tell.
//!
//! Five ways: it touches a surface without crossing it, it meets two surfaces at one time, it meets
//! a surface when the controls change, when it starts or right after a jump there, it meets one at
//! the end, it slides on one that can hold it no harder. All are suspicions;
//! [`one_sided()`](super::first_order::one_sided::one_sided()) decides.

pub(crate) mod kink;
pub(crate) mod objective_kink;
pub(crate) mod parameter_kink;
pub(crate) mod pile;
pub(crate) mod reset_kink;
pub(crate) mod surface_kink;

use super::linearised::linearisation::{Jacobian, Lineariser};
use super::linearised::variational_equation::LinearTape;
pub(crate) use crate::simulate::TOUCHING;
use crate::simulate::{Cause, Change, EventKind, Instant, Mode, Piece, Tape, Touch};
use nalgebra::DVector;

/// Cosines between a field and a normal below this are grazing.
pub(crate) const TANGENT: f64 = 1e-6;

/// Differences of times, relative to the interval, below this are 0.
const TOGETHER: f64 = 1e-10;

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NondifferentiabilityKind {
    /// A surface is touched, or met at almost no angle.
    Grazing,
    /// Two surfaces are met at one time.
    Corner,
    /// A surface is met when the controls change, at the start, or right after a jump there.
    Coincident,
    /// A surface is met at the end.
    End,
    /// A surface holds the state as hard as it can, and goes on to hold it or has just begun to.
    Limit,
}

/// A place without derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nondifferentiability {
    /// What is wrong.
    pub kind: NondifferentiabilityKind,
    /// At which surface.
    pub surface: usize,
    /// When.
    pub time: f64,
}

/// All suspicions, in the order of time.
pub(crate) fn nondifferentiabilities(pieces: &LinearTape) -> Vec<Nondifferentiability> {
    let LinearTape { lineariser, tape, .. } = *pieces;
    let watch = Watch { lineariser, tape };
    let mut found = Vec::new();
    for (at, piece) in tape.pieces.iter().enumerate() {
        match piece {
            Piece::Step { start, touches, .. } => {
                watch.limits(start, &mut found);
                found.extend(touches.iter().filter_map(touched));
            }
            Piece::Event { after, .. } => {
                watch.event(at, &mut found);
                // A hold that ends where it begins has no step.
                watch.limits(after, &mut found);
            }
        }
    }
    if let Some(last) = tape.pieces.last() {
        let end = last.end();
        let near = watch.met_at_the_end(&end);
        found.extend(near.map(|(surface, time)| Nondifferentiability {
            kind: NondifferentiabilityKind::End,
            surface,
            time,
        }));
    }
    found.dedup();
    found
}

/// A surface that is touched beside it, or that holds the state as hard as it can for an instant.
fn touched(Touch { of, time }: &Touch) -> Option<Nondifferentiability> {
    let (kind, surface) = match *of {
        Cause::Reaches(surface) => (NondifferentiabilityKind::Grazing, surface),
        Cause::Leaves(surface) => (NondifferentiabilityKind::Limit, surface),
        _ => return None,
    };
    Some(Nondifferentiability { kind, surface, time: *time })
}

struct Watch<'t> {
    lineariser: &'t Lineariser<'t>,
    tape: &'t Tape,
}

/// Surfaces at an instant: value, rate, size of the terms of the value, size of those of the rate.
struct Distances {
    value: Vec<f64>,
    rate: Vec<f64>,
    size: Vec<f64>,
    speed: Vec<f64>,
}

impl Distances {
    fn is_tangent(&self, surface: usize) -> bool {
        self.rate[surface].abs() <= TANGENT * self.speed[surface]
    }

    fn touches(&self, surface: usize) -> bool {
        self.value[surface].abs() <= TOUCHING * (1.0 + self.size[surface])
    }
}

impl Watch<'_> {
    fn distances(&self, at: &Instant) -> Distances {
        let flow = self.lineariser.rate_at_instant(self.tape, at);
        let state = DVector::from_column_slice(&at.state);
        let regime = &self.tape.regimes[at.regime];
        let table = self.lineariser.table(regime, &at.selectors, at.time, &state);
        let system = self.lineariser.system;
        let Jacobian { values, by } =
            Jacobian::of(&*system.switching, &table, &self.lineariser.parameters);
        let normals = by.columns(1, state.len());
        let visible = system.states.iter().zip(flow.iter()).filter(|(state, _)| !state.hidden);
        let size = visible.map(|(_, rate)| rate * rate).sum::<f64>().sqrt();
        let (surfaces, by_time) = (0..values.len(), by.column(0));
        Distances {
            value: values.iter().copied().collect(),
            rate: (normals * &flow + by_time).iter().copied().collect(),
            size: (normals.abs() * state.abs()).iter().copied().collect(),
            speed: surfaces.map(|i| normals.row(i).norm() * size + by_time[i].abs()).collect(),
        }
    }

    fn is_beside(&self, at: &Instant, surface: usize) -> bool {
        matches!(self.tape.regimes[at.regime].modes[surface], Mode::Below | Mode::Above)
    }

    fn beside(&self, at: &Instant) -> impl Iterator<Item = usize> {
        let modes = &self.tape.regimes[at.regime].modes;
        (0..modes.len()).filter(|&i| self.is_beside(at, i))
    }

    /// Surfaces that hold the state at an instant with selectors at the end of their interval: a
    /// little more force would move it. Each is noted where that begins.
    fn limits(&self, start: &Instant, found: &mut Vec<Nondifferentiability>) {
        let kind = NondifferentiabilityKind::Limit;
        let modes = &self.tape.regimes[start.regime].modes;
        for surface in (0..modes.len()).filter(|&i| modes[i] == Mode::Sliding) {
            let together = self.lineariser.system.held_together(surface);
            let size = start.selectors[together.clone()].iter().map(|s| s * s).sum::<f64>().sqrt();
            let is_known = found.iter().any(|it| (it.kind, it.surface) == (kind, surface));
            if size >= 1.0 - TOUCHING && surface == together.start && !is_known {
                found.push(Nondifferentiability { kind, surface, time: start.time });
            }
        }
    }

    fn event(&self, at: usize, found: &mut Vec<Nondifferentiability>) {
        let Piece::Event { cause, before, changes, .. } = &self.tape.pieces[at] else { return };
        let time = before.time;
        let mut note = |kind, surface| found.push(Nondifferentiability { kind, surface, time });
        for surface in changes.iter().filter_map(|it| self.jumped_onto(it)) {
            note(NondifferentiabilityKind::Coincident, surface);
        }
        let distances = self.distances(before);
        let met: Vec<usize> = self.beside(before).filter(|&i| distances.touches(i)).collect();
        match *cause {
            Cause::Reaches(surface) => {
                if distances.is_tangent(surface) {
                    note(NondifferentiabilityKind::Grazing, surface);
                }
                if met.iter().any(|&other| other != surface)
                    || self.meets_stop(at, |it| *it != Cause::Controls)
                {
                    note(NondifferentiabilityKind::Corner, surface);
                }
                if self.meets_stop(at, |it| *it == Cause::Controls) {
                    note(NondifferentiabilityKind::Coincident, surface);
                }
            }
            Cause::Start => {
                let is_jump = |it: &Change| matches!(it.kind, EventKind::Jump(_));
                let is_known = |i: usize| changes.iter().any(|it| it.surface == i && !is_jump(it));
                let jumped = changes.iter().filter(|it| is_jump(it)).map(|it| it.surface);
                met.into_iter()
                    .filter(|i| !is_known(*i))
                    .chain(jumped)
                    .for_each(|surface| note(NondifferentiabilityKind::Coincident, surface));
            }
            Cause::Controls => met
                .into_iter()
                .for_each(|surface| note(NondifferentiabilityKind::Coincident, surface)),
            Cause::Repels => {
                note(NondifferentiabilityKind::Grazing, changes.first().map_or(0, |it| it.surface))
            }
            Cause::Leaves(_) | Cause::CrossesKink(_) => {}
        }
    }

    /// The surface of a jump that moves the state with respect to it, but not off it, while the
    /// state goes on through it. A little less, and it comes to the surface again.
    fn jumped_onto(&self, change: &Change) -> Option<usize> {
        let EventKind::Jump(jump) = change.kind else { return None };
        let system = self.lineariser.system;
        let (of, surface) = (&system.jumps[jump], change.surface);
        let distances = self.distances(&change.after);
        let onward = if of.is_falling { -distances.rate[surface] } else { distances.rate[surface] };
        let goes_on = onward > 0.0 && !distances.is_tangent(surface);
        let entries = &system.switching.jacobian_pattern().entries;
        let reads = |row: u32, input: u32| {
            row as usize == surface && of.resets.iter().any(|state| input as usize == 1 + state)
        };
        let is_moved = entries.iter().any(|&(row, input)| reads(row, input));
        (goes_on && is_moved && distances.touches(surface)).then_some(surface)
    }

    /// Whether the event before or after is at the same time.
    fn meets_stop(&self, at: usize, is_it: impl Fn(&Cause) -> bool) -> bool {
        let [first, last] = self.lineariser.system.interval;
        let time_of = |piece: &Piece| match piece {
            Piece::Event { before, .. } => before.time,
            Piece::Step { start, .. } => start.time,
        };
        let own = time_of(&self.tape.pieces[at]);
        let is_near = |piece: &&Piece| (time_of(piece) - own).abs() <= TOGETHER * (last - first);
        let is_passed_over = |cause: &Cause| {
            matches!(cause, Cause::Start | Cause::Leaves(_) | Cause::CrossesKink(_))
        };
        let is_other = |piece: &&Piece| match piece {
            Piece::Event { cause, .. } => is_it(cause) && !is_passed_over(cause),
            Piece::Step { .. } => false,
        };
        let before =
            self.tape.pieces[..at].iter().rev().take_while(is_near).any(|it| is_other(&it));
        before || self.tape.pieces[at + 1..].iter().take_while(is_near).any(|it| is_other(&it))
    }

    fn met_at_the_end(&self, end: &Instant) -> impl Iterator<Item = (usize, f64)> {
        let distances = self.distances(end);
        let [first, last] = self.lineariser.system.interval;
        let events = self.tape.pieces.iter().rev().find_map(|piece| match piece {
            Piece::Event { cause: Cause::Reaches(surface), before, .. } => {
                Some((*surface, before.time))
            }
            _ => None,
        });
        let just_before = events.filter(|(_, time)| last - time <= TOGETHER * (last - first));
        let here: Vec<usize> = self.beside(end).filter(|&i| distances.touches(i)).collect();
        let here = here.into_iter().filter(move |i| just_before.is_none_or(|it| it.0 != *i));
        just_before.into_iter().chain(here.map(move |surface| (surface, last)))
    }
}
