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
        let row = |name: String, value| Constraint {
            place: Place { name, span: jump.place.span },
            value,
            range: Range { lower: zero, upper: zero },
        };
        let psi = self.division.at_end(j, self.whole().surfaces[jump.surface].psi);
        let mut rows = vec![row(jump.place.name.clone(), psi)];
        rows.extend(self.direction(j));
        for (index, state) in self.division.model.states.iter().enumerate() {
            let reset = jump.resets.iter().find(|it| it.0 == index).map(|it| it.1);
            let before = match reset {
                Some(value) => self.division.at_end(j, value),
                None => self.division.of_phase(j, Symbol::AtEnd(index)),
            };
            let start = self.division.of_phase(j + 1, Symbol::AtStart(index));
            let gap = match self.at_rest(j + 1, index) {
                Some(approach) => approach,
                None => self.division.graph.sub(start, before),
            };
            rows.push(row(format!("{} after {}", state.place.name, jump.place.name), gap));
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
