//! What ties each phase to the next, and what is written of the ends of the whole time.

use super::MultiPhase;
use crate::model::{Constraint, Link, Place, Range, Symbol};
use fdcc_runtime::problem::End;

impl MultiPhase<'_> {
    /// `psi = 0` and the resets at a jump, and that the phases beside it have durations.
    pub(super) fn link(&mut self, j: usize) -> Link {
        let mut rows = self.at_jump(j);
        rows.push(self.duration(j, "before"));
        if j + 1 == self.sequence.len() {
            rows.push(self.duration(j + 1, "after"));
        }
        Link { ends: vec![End::Last(j), End::First(j + 1)], objective: None, rows }
    }

    /// `psi = 0`, in the direction of the jump, and the resets.
    pub(super) fn at_jump(&mut self, j: usize) -> Vec<Constraint> {
        let jump = self.jump(j);
        let zero = self.division.graph.number(0.0);
        let row = |name: String, span, value| Constraint {
            place: Place { name, span },
            value,
            range: Range { lower: zero, upper: zero },
        };
        let psi = self.division.at_end(j, self.whole().surfaces[jump.surface].psi);
        let mut rows = vec![row(jump.place.name.clone(), jump.place.span, psi)];
        rows.extend(self.direction(j));
        for (index, state) in self.division.model.states.iter().enumerate() {
            let reset = jump.resets.iter().position(|it| it.0 == index);
            let span = reset.map_or(jump.place.span, |at| jump.assignments[at]);
            let before = match reset {
                Some(at) => self.division.at_end(j, jump.resets[at].1),
                None => self.division.of_phase(j, Symbol::AtEnd(index)),
            };
            let start = self.division.of_phase(j + 1, Symbol::AtStart(index));
            let gap = match self.at_rest(j + 1, index) {
                Some(approach) => approach,
                None => self.division.graph.sub(start, before),
            };
            rows.push(row(format!("{} after {}", state.place.name, jump.place.name), span, gap));
        }
        rows
    }

    /// That a phase does not end before it begins; it is told by the jump before or after it.
    fn duration(&mut self, j: usize, word: &str) -> Constraint {
        let place = &self.jump(j.min(self.sequence.len() - 1)).place;
        Constraint {
            place: Place { name: format!("time {word} {}", place.name), span: place.span },
            value: self.division.graph.sub(self.division.times[j + 1], self.division.times[j]),
            range: self.division.not_below(),
        }
    }
}
