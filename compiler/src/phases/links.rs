//! Conditions at the ends of the pieces: what ties each to the next, and what is written of the
//! whole.

use super::Unrolling;
use crate::model::{Place, Range, Row};

impl Unrolling<'_> {
    /// `psi = 0` and the resets at each jump, that the last piece has a length, and what is written
    /// of the ends.
    pub(super) fn boundary(&mut self) -> Vec<Row> {
        let mut rows = Vec::new();
        for j in 0..self.sequence.len() {
            rows.extend(self.link(j));
        }
        if let Some(last) = self.sequence.last().map(|at| &self.whole.jumps[*at]) {
            let [zero, infinity] = [0.0, f64::INFINITY].map(|it| self.graph.number(it));
            let name = format!("time after {}", last.place.name);
            rows.push(Row {
                place: Place { name, span: last.place.span },
                value: self.lengths[self.sequence.len()],
                range: Range { lower: zero, upper: infinity },
            });
        }
        for row in &self.model.boundary {
            rows.push(Row { value: self.of_whole(row.value), ..row.clone() });
        }
        rows
    }

    /// From the end of a piece to the start of the next.
    fn link(&mut self, j: usize) -> Vec<Row> {
        let (jump, zero) = (self.jump(j), self.graph.number(0.0));
        let row = |name: String, value| Row {
            place: Place { name, span: jump.place.span },
            value,
            range: Range { lower: zero, upper: zero },
        };
        let guard = self.at_end(j, self.whole.surfaces[jump.surface].psi);
        let mut rows = vec![row(jump.place.name.clone(), guard)];
        rows.extend(self.direction(j));
        for (index, state) in self.model.states.iter().enumerate() {
            let reset = jump.resets.iter().find(|it| it.0 == index).map(|it| it.1);
            let before = match reset {
                Some(value) => self.at_end(j, value),
                None => self.pieces[j].ends[index],
            };
            let gap = match self.at_rest(j + 1, index) {
                Some(approach) => approach,
                None => self.graph.sub(self.pieces[j + 1].starts[index], before),
            };
            rows.push(row(format!("{} after {}", state.place.name, jump.place.name), gap));
        }
        rows
    }
}
