//! The orders in which surfaces change their modes that change them at the same time.
//!
//! Where two switches come together the objective has a kink: each order has a derivative of its
//! own by the time between them. A chain of phases knows one order, in which that time is 0 or
//! more, or that they happen at once; it is stationary there though another order is better.

use super::Search;
use super::insertion::{Candidate, tried};
use super::repair::is_nothing;
use super::structure::Structure;
use fdcc_compiler::{Mode, PhaseOfModes, may_hold};
use std::ops::Range;

impl Search<'_> {
    /// All modes on the way from one phase to the next where several surfaces change theirs, at
    /// once or with phases between that have shrunk to nothing. Each surface has a multiplier of
    /// its own there, so that their worth is tried.
    pub(super) fn orders(&self, structure: &Structure) -> Vec<Candidate> {
        let phases = &structure.phases;
        let all = between(structure).into_iter().flat_map(|gone| {
            let [before, after] = [&phases[gone.start - 1], &phases[gone.end]];
            let known = &phases[gone.clone()];
            let rest = gone.clone().fold(structure.clone(), |it, _| it.without_phase(gone.start));
            let new = self.on_the_way(before, after).into_iter();
            let new = new.filter(move |modes| known.iter().all(|it| it.modes != *modes));
            new.map(move |modes| {
                let mut held = PhaseOfModes { modes, jump: None, ..after.clone() };
                held.release();
                Candidate { into: Some(rest.clone()), ..tried(gone.start, held) }
            })
        });
        all.collect()
    }

    /// The modes that some surfaces already have, and others still, or that hold them.
    fn on_the_way(&self, before: &PhaseOfModes, after: &PhaseOfModes) -> Vec<Vec<Mode>> {
        let changes = |at: &usize| before.modes[*at] != after.modes[*at];
        let changing: Vec<usize> = (0..before.modes.len()).filter(changes).collect();
        if changing.len() < 2 {
            return Vec::new();
        }
        let may_hold = may_hold(self.model);
        let mut all = vec![before.modes.clone()];
        for at in changing {
            let mut options = vec![before.modes[at], after.modes[at]];
            if may_hold[at] && !options.contains(&Mode::Held) {
                options.push(Mode::Held);
            }
            let with = |modes: &Vec<Mode>, mode: Mode| {
                let mut own = modes.clone();
                own[at] = mode;
                own
            };
            let each = all.iter().flat_map(|modes| options.iter().map(|it| with(modes, *it)));
            all = each.collect();
        }
        all.retain(|modes| *modes != before.modes && *modes != after.modes);
        all
    }
}

/// The phases without a length, one after the other, between two that are there; where these follow
/// each other there is none between them. Beside jumps nothing is inserted.
fn between(structure: &Structure) -> Vec<Range<usize>> {
    let count = structure.phases.len();
    let there: Vec<usize> = (0..count).filter(|j| !is_nothing(structure, *j)).collect();
    let pairs = there.windows(2).map(|pair| pair[0] + 1..pair[1]);
    let is_free = |gone: &Range<usize>| {
        structure.phases[gone.start..=gone.end].iter().all(|it| it.jump.is_none())
    };
    pairs.filter(is_free).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use fdcc_compiler::Arc;
    use fdcc_runtime::problem::ControlShape;

    fn phase(mode: Mode) -> PhaseOfModes {
        PhaseOfModes {
            jump: None,
            modes: vec![mode],
            arcs: vec![Arc::Free],
            contacts: Vec::new(),
            touches: Vec::new(),
            shape: ControlShape::Polynomial,
            halvings: 0,
            is_graded: false,
            steep: Vec::new(),
            is_cut: false,
            is_joined: false,
        }
    }

    /// A phase that has shrunk to nothing is one of the orders that there are; others are tried in
    /// its place.
    #[test]
    fn switches_at_one_time_have_what_shrank_between_them() {
        let phases = [Mode::Below, Mode::Held, Mode::Above, Mode::Held].map(phase);
        let times = vec![0.0, 1.0, 1.0 + 1e-9, 2.0, 3.0];
        let mut structure = Structure { phases: phases.to_vec(), times };
        assert_eq!(between(&structure), [1..2, 3..3]);
        structure.phases[3].jump = Some(0);
        assert_eq!((between(&structure).len(), between(&structure)[0].clone()), (1, 1..2));
    }
}
