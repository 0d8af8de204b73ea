//! Conditions at the ends of the phases: what ties each to the next, and what is written of the
//! whole.

use super::MultiPhase;
use crate::model::{Constraint, Place, Range};

impl MultiPhase<'_> {
    /// `psi = 0` and the resets at each jump, that the last phase has a duration, and what is
    /// written of the ends.
    pub(super) fn boundary(&mut self) -> Vec<Constraint> {
        let mut rows = Vec::new();
        for j in 0..self.sequence.len() {
            rows.extend(self.link(j));
        }
        if let Some(last) = self.sequence.last().map(|at| &self.whole.jumps[*at]) {
            let [zero, infinity] = [0.0, f64::INFINITY].map(|it| self.graph.number(it));
            let name = format!("time after {}", last.place.name);
            rows.push(Constraint {
                place: Place { name, span: last.place.span },
                value: self.durations[self.sequence.len()],
                range: Range { lower: zero, upper: infinity },
            });
        }
        for row in &self.model.boundary {
            rows.push(Constraint { value: self.of_whole(row.value), ..row.clone() });
        }
        rows
    }

    /// From the end of a phase to the start of the next.
    fn link(&mut self, j: usize) -> Vec<Constraint> {
        let (jump, zero) = (self.jump(j), self.graph.number(0.0));
        let row = |name: String, value| Constraint {
            place: Place { name, span: jump.place.span },
            value,
            range: Range { lower: zero, upper: zero },
        };
        let psi = self.at_end(j, self.whole.surfaces[jump.surface].psi);
        let mut rows = vec![row(jump.place.name.clone(), psi)];
        rows.extend(self.direction(j));
        for (index, state) in self.model.states.iter().enumerate() {
            let reset = jump.resets.iter().find(|it| it.0 == index).map(|it| it.1);
            let before = match reset {
                Some(value) => self.at_end(j, value),
                None => self.phases[j].ends[index],
            };
            let gap = match self.at_rest(j + 1, index) {
                Some(approach) => approach,
                None => self.graph.sub(self.phases[j + 1].starts[index], before),
            };
            rows.push(row(format!("{} after {}", state.place.name, jump.place.name), gap));
        }
        rows
    }
}
