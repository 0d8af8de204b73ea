//! Where one arc of limits follows another at once, or goes on where the system changes.
//!
//! A limit with an arc on one side of a junction only, to or from which a free motion leads, is
//! left or reached in the best way once the time of the junction is. Elsewhere the multipliers at
//! the junction itself have to have the sign of their bounds: of each limit
//!
//! ```text
//! kappa + F(-) - F(+)
//! ```
//!
//! with the `kappa` of `c = 0` where its arc begins, and the `F` of its arcs at the end of the
//! phase before and at the begin of the one behind (`signs.rs`). Where one has not, the motion
//! would rather cut the corner: a free phase between the arcs is tried.

use super::contacts::Contacts;
use super::signs::{At, Wrong, side};
use super::structure::Structure;
use super::tuning::structure::{TRIED, TRIED_BESIDE};
use fdcc_compiler::{Arc, PhaseOfModes};

impl Contacts<'_> {
    /// What is wrong at the junctions before the phases behind the first.
    pub(super) fn wrong_at_corners(&self) -> Vec<Wrong> {
        let phases = 1..self.located.structure.phases.len();
        let all = phases.flat_map(|j| (0..self.limits.len()).map(move |limit| (j, limit)));
        let wrong = |(j, limit): (usize, usize)| {
            let wrong = self.wrong_at_corner(j, limit)?;
            let part = self.part_at_once(j, limit, wrong);
            Some(Wrong { phase: j, limit, part, is_at_corner: true })
        };
        all.filter_map(wrong).collect()
    }

    /// By how much the multiplier of a limit where phase `j` begins has the other sign, for
    /// certain; nothing where it is free on both sides, or has that sign by itself.
    fn wrong_at_corner(&self, j: usize, limit: usize) -> Option<f64> {
        let order = self.limits[limit].order.filter(|order| *order > 0)?;
        let phases = &self.located.structure.phases;
        let [before, after] = [&phases[j - 1], &phases[j]];
        let own = [before.contacts[limit], after.contacts[limit]];
        if own == [Arc::Free; 2] || is_plain(before, after, limit) {
            return None;
        }
        let side = own.iter().map(|it| side(*it)).find(|it| *it != 0.0)?;
        let density = |j: usize| At::new(self.located, j, self.multipliers(j, limit), order);
        let [ends, begins] = [(own[0], j - 1), (own[1], j)]
            .map(|(arc, j)| if arc == Arc::Free { None } else { Some(density(j)) });
        let kappa = self.kappa_of_entry(j, limit);
        // An entry that follows from others has no multiplier of its own.
        if own[0] == Arc::Free && kappa.is_none() {
            return None;
        }
        let [before, uncertain_before] = ends.map_or([0.0; 2], |it| it.end);
        let [after, uncertain_after] = begins.map_or([0.0; 2], |it| it.begin);
        let multiplier = kappa.unwrap_or(0.0) + before - after;
        Some(-side * multiplier - uncertain_before - uncertain_after)
    }
}

/// Whether nothing else changes at a junction than whether a limit is reached.
fn is_plain(before: &PhaseOfModes, after: &PhaseOfModes, limit: usize) -> bool {
    let mut others = (0..before.contacts.len()).filter(|other| *other != limit);
    before.modes == after.modes
        && after.jump.is_none()
        && after.touches.iter().all(|it| *it == Arc::Free)
        && others.all(|other| before.contacts[other] == after.contacts[other])
}

impl Structure {
    /// With short phases in which a limit is not reached, beside the begin of phase `j`.
    pub fn without_corner(&self, j: usize, limit: usize) -> Self {
        let mut other = self.clone();
        let is_same = self.phases[j - 1].modes == self.phases[j].modes;
        let is_one = is_same && self.phases[j].jump.is_none();
        let sides = [j - 1, j].map(|it| self.phases[it].contacts[limit] != Arc::Free);
        let at = self.times[j];
        let length = |j: usize| {
            let [first, last] = self.ends();
            let own = self.times[j + 1] - self.times[j];
            (TRIED * (last - first)).min(TRIED_BESIDE * own)
        };
        if sides[1] || is_one {
            let mut free = self.freed(j, j - 1, limit);
            if is_one {
                free.jump = None;
            } else {
                other.phases[j].jump = None;
                free.jump = self.phases[j].jump;
            }
            other.phases.insert(j, free);
            other.times.insert(j + 1, at + length(j));
        }
        if is_one {
            other.times[j] = at - length(j - 1);
        } else if sides[0] {
            let free = PhaseOfModes { jump: None, ..self.freed(j - 1, j, limit) };
            other.phases.insert(j, free);
            other.times.insert(j, at - length(j - 1));
        }
        other
    }

    /// A phase off a limit, with no more arcs than it has in common with another one.
    fn freed(&self, j: usize, beside: usize, limit: usize) -> PhaseOfModes {
        let mut free = self.phases[j].clone();
        let beside = &self.phases[beside];
        let arcs = [(&mut free.arcs, &beside.arcs), (&mut free.contacts, &beside.contacts)];
        for (own, its) in arcs {
            own.iter_mut()
                .zip(its)
                .filter(|(own, its)| *own != *its)
                .for_each(|it| *it.0 = Arc::Free);
        }
        free.contacts[limit] = Arc::Free;
        free.touches.fill(Arc::Free);
        (free.is_cut, free.is_joined) = (false, false);
        free
    }
}
