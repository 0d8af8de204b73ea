//! What ties each phase of given modes to the next.

use super::independent::Independent;
use super::{Mode, Modes};
use crate::expressions::graph::ExprId;
use crate::model::{Constraint, Link, Place, Range, Symbol};
use fdcc_runtime::problem::End;

impl Modes<'_> {
    /// The state goes on; a surface that is left or reached is 0; a bound that is reached is met;
    /// beside a jump all bounds are; phases have durations.
    pub(super) fn link(&mut self, j: usize) -> Link {
        let mut rows = match self.phases[j + 1].jump {
            Some(_) => self.between.at_jump(j),
            None => self.continuity(j),
        };
        rows.extend(self.events(j));
        rows.extend(self.entries(j));
        rows.extend(self.beside_jump(j));
        rows.extend(self.departures(j));
        rows.extend(self.ends_of_controls(j));
        rows.extend(self.ends_of_path(j));
        rows.push(self.duration(j));
        if j + 1 == self.between.division.last() {
            rows.push(self.duration(j + 1));
        }
        Link { ends: vec![End::Last(j), End::First(j + 1)], objective: None, rows }
    }

    fn continuity(&mut self, j: usize) -> Vec<Constraint> {
        let range = self.between.division.exactly_zero();
        let model = self.between.division.model;
        let of = |(index, state): (usize, &crate::model::State)| {
            let before = self.between.division.of_phase(j, Symbol::AtEnd(index));
            let start = self.between.division.of_phase(j + 1, Symbol::AtStart(index));
            let place = Place { name: state.place.name.clone(), ..state.place };
            Constraint { place, value: self.between.division.graph.sub(start, before), range }
        };
        model.states.iter().enumerate().map(of).collect()
    }

    /// `psi = 0` where a surface is not held before and has another mode behind: what is held is 0
    /// already. Where a jump moves the surface, `psi = 0` behind it if it is held there.
    fn events(&mut self, j: usize) -> Vec<Constraint> {
        let (model, range) = (self.between.division.model, self.between.division.exactly_zero());
        let modes = self.phases[j].modes.iter().zip(&self.phases[j + 1].modes);
        let mut rows = Vec::new();
        for (switch, (before, after)) in model.switches().iter().zip(modes) {
            let surfaces = &model.surfaces[switch.surfaces.clone()];
            let is_moved = surfaces.iter().any(|it| self.is_moved(j, it.psi));
            let is_zero = match is_moved {
                true => *after == Mode::Held,
                false => *before != Mode::Held && before != after,
            };
            for surface in surfaces.iter().filter(|_| is_zero) {
                let value = match is_moved {
                    true => self.between.division.at_start(j + 1, surface.psi),
                    false => self.between.division.at_end(j, surface.psi),
                };
                rows.push(Constraint { place: surface.place.clone(), value, range });
            }
        }
        rows
    }

    /// The surfaces that are 0 where phase `j` ends and no jump moves them.
    pub(super) fn zero_between(&self, j: usize) -> Independent {
        let model = self.between.division.model;
        let mut known = Independent::default();
        let modes = self.phases[j].modes.iter().zip(&self.phases[j + 1].modes);
        for (switch, (before, after)) in model.switches().iter().zip(modes) {
            let is_zero = *before == Mode::Held || before != after;
            for surface in model.surfaces[switch.surfaces.clone()].iter().filter(|_| is_zero) {
                if !self.is_moved(j, surface.psi) {
                    known.add(self, surface.psi);
                }
            }
        }
        known
    }

    /// Whether a jump at the end of a phase resets what a value reads.
    pub(super) fn is_moved(&self, j: usize, value: ExprId) -> bool {
        let division = &self.between.division;
        let read = division.graph.inputs_of(&[value]);
        let jump = self.phases[j + 1].jump.map(|_| self.between.jump(j));
        let mut reset = jump.into_iter().flat_map(|it| &it.resets);
        reset.any(|it| read.contains(&division.input_of_state(it.0)))
    }

    fn duration(&mut self, j: usize) -> Constraint {
        let Range { lower, upper } = self.between.division.not_below();
        let [from, to] = [self.between.division.times[j], self.between.division.times[j + 1]];
        Constraint {
            place: Place { name: format!("duration of phase {}", j + 1), ..Place::default() },
            value: self.between.division.graph.sub(to, from),
            range: Range { lower, upper },
        }
    }
}
