//! Surfaces that the motion touches, but does not cross.
//!
//! That it stays on its side is a condition of the structure, which nobody wrote: where it is
//! active, the other side may be better.

use super::contacts::Contacts;
use super::insertion::{Candidate, is_zero, tried};
use super::{Located, Search};
use fdcc_compiler::{Mode, PhaseOfModes};

impl Search<'_> {
    /// A moment on the other side of each surface that is touched inside of a phase, or reached at
    /// the last time though nothing says that it has to be.
    pub(super) fn across_surfaces(&self, located: &Located) -> Vec<Candidate> {
        let mut all = self.across_at_the_end(located);
        let contacts = Contacts::new(self.model, located);
        for (j, phase) in located.structure.phases.iter().enumerate() {
            for (at, switch) in self.model.switches().iter().enumerate() {
                let Some(other) = across(phase, at).filter(|_| !switch.is_ball) else { continue };
                let touched = contacts.touched(j, at).into_iter();
                all.extend(touched.map(|time| {
                    let mut into = located.structure.with_cut(j, time);
                    into.phases[j + 1].is_cut = false;
                    Candidate { into: Some(into), ..tried(j + 1, other.clone()) }
                }));
            }
        }
        all
    }

    fn across_at_the_end(&self, located: &Located) -> Vec<Candidate> {
        let count = located.structure.phases.len();
        let (last, problem) = (&located.structure.phases[count - 1], &located.chain.phases);
        let boundary = &problem[count - 1].boundary;
        let whole = located.whole(self.problem).outcome;
        let switches = self.model.switches().into_iter().enumerate();
        let reached = switches.filter(|(at, switch)| {
            let label = format!("{} at the end", switch.place.name);
            let mut rows = 0..boundary.outputs() - 1;
            !switch.is_ball
                && rows.any(|row| *boundary.origin(row + 1).label == *label)
                && is_zero(&whole, *at, |column| column[column.len() - 1])
        });
        let others = reached.filter_map(|(at, _)| across(last, at));
        others.map(|other| tried(count, other)).collect()
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
