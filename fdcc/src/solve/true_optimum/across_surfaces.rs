//! Surfaces that the motion touches, but does not cross.
//!
//! That it stays on its side is a condition of the structure, which nobody wrote: where it is
//! active the other side may be better, and where it is reached without a force that is so, too.

use super::contacts::Contacts;
use super::insertion::{Candidate, tried};
use super::tuning::across_surfaces::NEAR;
use super::{Located, Search};
use fdcc_compiler::{Mode, PhaseOfModes, may_hold};

impl Search<'_> {
    /// A moment on the other side of each surface that is touched inside of a phase, or on which
    /// the motion begins or ends.
    pub(super) fn across_surfaces(&self, located: &Located) -> Vec<Candidate> {
        let mut all = self.across_at_ends(located);
        let (contacts, may_hold) = (Contacts::new(self.model, located), may_hold(self.model));
        for (j, phase) in located.structure.phases.iter().enumerate() {
            for (at, switch) in self.model.switches().iter().enumerate() {
                let Some(other) = across(phase, at).filter(|_| !switch.is_ball) else { continue };
                let mut touched = contacts.pressed(j, at);
                if !may_hold[at] {
                    touched.extend(contacts.turns(j, at));
                }
                all.extend(touched.into_iter().map(|time| {
                    let mut into = located.structure.with_cut(j, time);
                    into.phases[j + 1].is_cut = false;
                    Candidate { into: Some(into), ..tried(j + 1, other.clone()) }
                }));
            }
        }
        all
    }

    /// At the first and the last time. What begins or ends there because it is told to leaves it
    /// for a moment only if it may be on it for a moment, which [`Search::candidates`] looks at.
    fn across_at_ends(&self, located: &Located) -> Vec<Candidate> {
        let phases = &located.structure.phases;
        let whole = located.whole(self.problem).outcome;
        let may_hold = may_hold(self.model);
        let mut all = Vec::new();
        for (at, switch) in self.model.switches().iter().enumerate().filter(|it| !it.1.is_ball) {
            let psi = &whole.trajectory.switching[at];
            let least = NEAR * psi.iter().fold(0.0, |a: f64, it| a.max(it.abs()));
            let is_open = self.is_open_at_the_end(located, &switch.place.name);
            if psi[0].abs() <= least && !may_hold[at] && phases[0].jump.is_none() {
                all.extend(across(&phases[0], at).map(|other| tried(0, other)));
            }
            if psi[psi.len() - 1].abs() <= least && (is_open || !may_hold[at]) {
                let count = phases.len();
                all.extend(across(&phases[count - 1], at).map(|other| tried(count, other)));
            }
        }
        all
    }

    /// Whether nothing that is written says where the motion ends beside a surface.
    fn is_open_at_the_end(&self, located: &Located, surface: &str) -> bool {
        let boundary = &located.chain.phases[located.chain.phases.len() - 1].boundary;
        let label = format!("{surface} at the end");
        (1..boundary.outputs()).any(|row| *boundary.origin(row).label == *label)
    }
}

/// A phase like another one on the other side of a surface; nothing where it is held.
fn across(phase: &PhaseOfModes, at: usize) -> Option<PhaseOfModes> {
    let mut other = PhaseOfModes { jump: None, ..phase.clone() };
    other.modes[at] = match phase.modes[at] {
        Mode::Held => return None,
        Mode::Above => Mode::Below,
        Mode::Below => Mode::Above,
    };
    other.release();
    Some(other)
}
