//! What ties each phase of given modes to the next.

use super::{Mode, Modes};
use crate::model::{Constraint, Link, Place, Range, Symbol};
use fdcc_runtime::problem::End;

impl Modes<'_> {
    /// The state goes on; a surface that is left or reached is 0; phases have durations.
    pub(super) fn link(&mut self, j: usize) -> Link {
        let mut rows = self.continuity(j);
        rows.extend(self.events(j));
        rows.push(self.duration(j));
        if j + 1 == self.division.last() {
            rows.push(self.duration(j + 1));
        }
        Link { ends: vec![End::Last(j), End::First(j + 1)], objective: None, rows }
    }

    fn continuity(&mut self, j: usize) -> Vec<Constraint> {
        let range = self.division.exactly_zero();
        let model = self.division.model;
        let of = |(index, state): (usize, &crate::model::State)| {
            let before = self.division.of_phase(j, Symbol::AtEnd(index));
            let start = self.division.of_phase(j + 1, Symbol::AtStart(index));
            let place = Place { name: state.place.name.clone(), ..state.place };
            Constraint { place, value: self.division.graph.sub(start, before), range }
        };
        model.states.iter().enumerate().map(of).collect()
    }

    /// `psi = 0` where a surface is not held before and has another mode behind: what is held is 0
    /// already.
    fn events(&mut self, j: usize) -> Vec<Constraint> {
        let (model, range) = (self.division.model, self.division.exactly_zero());
        let modes = self.phases[j].modes.iter().zip(&self.phases[j + 1].modes);
        let mut rows = Vec::new();
        for (switch, (before, after)) in model.switches().iter().zip(modes) {
            if *before == Mode::Held || before == after {
                continue;
            }
            for surface in &model.surfaces[switch.surfaces.clone()] {
                let value = self.division.at_end(j, surface.psi);
                rows.push(Constraint { place: surface.place.clone(), value, range });
            }
        }
        rows
    }

    fn duration(&mut self, j: usize) -> Constraint {
        let Range { lower, upper } = self.division.not_below();
        let [from, to] = [self.division.times[j], self.division.times[j + 1]];
        Constraint {
            place: Place { name: format!("duration of phase {}", j + 1), ..Place::default() },
            value: self.division.graph.sub(to, from),
            range: Range { lower, upper },
        }
    }
}
