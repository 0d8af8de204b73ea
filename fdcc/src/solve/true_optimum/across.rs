//! Switches at the very time at which one phase of a model ends and the next begins.
//!
//! The time of such a switch is that of the link, which nothing moves: the modes of the neighbour
//! are tried for a moment on this side of it.

use super::insertion::{Candidate, tried};
use super::joint::Among;
use super::{Located, Search};
use fdcc_compiler::{Mode, PhaseOfModes};
use fdcc_runtime::problem::End;

impl Search<'_> {
    /// Of each phase that a link ties to this one, the modes that it has beside the link, where
    /// surfaces of the same names have other modes here.
    pub(super) fn across_links(&self, located: &Located) -> Vec<Candidate> {
        let Some(Among { whole, own, .. }) = self.among else { return Vec::new() };
        let phases = &located.structure.phases;
        let (first, last) = (&phases[0], &phases[phases.len() - 1]);
        let mut all = Vec::new();
        for link in &whole.links {
            let [End::Last(before), End::First(after)] = link.ends[..] else { continue };
            if before == own && after != own {
                let next = &beside(located, own, after).structure.phases[0];
                all.extend(self.with_modes_of(after, next, last).map(|it| (phases.len(), it)));
            }
            if after == own && before != own {
                let others = &beside(located, own, before).structure.phases;
                let other = &others[others.len() - 1];
                all.extend(self.with_modes_of(before, other, first).map(|it| (0, it)));
            }
        }
        // What is written of the ends may leave no way back.
        let candidate = |(before, held)| Candidate { is_doubtful: true, ..tried(before, held) };
        all.into_iter().map(candidate).collect()
    }

    /// A phase with the modes that surfaces of the same names have in another one.
    fn with_modes_of(
        &self,
        part: usize,
        other: &PhaseOfModes,
        own: &PhaseOfModes,
    ) -> Option<PhaseOfModes> {
        let switches = self.among?.parts[part].model.switches();
        let mode_of = |name: &str| -> Option<Mode> {
            let at = switches.iter().position(|it| it.place.name == name)?;
            Some(other.modes[at])
        };
        let mut changed = PhaseOfModes { jump: None, ..own.clone() };
        for (mode, switch) in changed.modes.iter_mut().zip(self.model.switches()) {
            *mode = mode_of(&switch.place.name).unwrap_or(*mode);
        }
        changed.release();
        (changed.modes != own.modes).then_some(changed)
    }
}

/// Another phase than `own`.
fn beside(located: &Located, own: usize, other: usize) -> &Located {
    &located.beside[if other < own { other } else { other - 1 }]
}
