//! Conditions at the last time that a held surface says already.
//!
//! Where `psi = 0` is held until the end, `end` conditions that add up to it would be said twice,
//! and the Jacobian of the chain would lose rank: a block that rests in the end with `end v == 0`.
//!
//! Bounds of states and path conditions, and the sides of surfaces, hold at the nodes of the
//! collocation, which say nothing of the last time: a tank would be emptied behind the last node.

use super::hold_parameters::is_of_end;
use super::independent::Independent;
use super::limits::rates;
use super::{Arc, Mode, Modes};
use crate::expressions::graph::ExprId;
use crate::model::{Constraint, Place};

impl Modes<'_> {
    /// The conditions at the ends of the whole time: first bounds that nobody wrote as one, then
    /// what is written; what follows from what is held in the end has no bounds.
    pub(super) fn boundary(&mut self) -> Vec<Constraint> {
        let model = self.between.division.model;
        let unbounded = self.unbounded();
        let mut rows = model.boundary.clone();
        let ends: Vec<usize> = (0..rows.len()).filter(|at| is_of_end(model, &rows[*at])).collect();
        let held = self.held_in_the_end();
        let mut known = Independent::default();
        held.iter().for_each(|psi| {
            known.add(self, *psi);
        });
        for at in ends.into_iter().filter(|_| !held.is_empty()) {
            let gap = self.between.division.graph.sub(rows[at].value, rows[at].range.lower);
            if !known.add(self, gap) {
                rows[at].range = unbounded;
            }
        }
        let fixed = |row: &&Constraint| row.range.lower == row.range.upper;
        for row in model.boundary.iter().filter(fixed) {
            let gap = self.between.division.graph.sub(row.value, row.range.lower);
            known.add(self, gap);
        }
        let mut all = self.limits_at_end(&known);
        all.extend(self.modes_at_end(&known));
        all.extend(rows);
        all
    }

    /// The sides of the surfaces that are not held in the last phase, where nothing fixes them.
    fn modes_at_end(&mut self, known: &Independent) -> Vec<Constraint> {
        let (model, last) = (self.between.division.model, &self.phases[self.phases.len() - 1]);
        let mut rows = Vec::new();
        for (switch, mode) in model.switches().iter().zip(&last.modes) {
            let surface = &model.surfaces[switch.surfaces.start];
            let range = match mode {
                Mode::Above if !switch.is_ball => self.between.division.not_below(),
                Mode::Below if !switch.is_ball => self.between.division.not_above(),
                _ => continue,
            };
            let value = self.between.division.at_own_end(surface.psi);
            if known.clone().add(self, value) {
                let name = format!("{} at the end", surface.place.name);
                let place = Place { name, ..surface.place };
                rows.push(Constraint { place, value, range });
            }
        }
        rows
    }

    /// Those that controls move, though not at once, or unknowns and starts; that are not kept in
    /// the last phase, and not fixed by what is known of its end.
    fn limits_at_end(&mut self, known: &Independent) -> Vec<Constraint> {
        let last = &self.phases[self.phases.len() - 1];
        let moving = self.moving(last);
        let states = self.all_bounds_of_states();
        let limits = states.iter().chain(&moving.path).zip(&last.contacts);
        let free = limits.filter(|it| *it.1 == Arc::Free).map(|it| it.0);
        let mut rows = Vec::new();
        for row in free {
            let value = self.between.division.at_own_end(row.value);
            let rates = rates(&moving, &mut self.between.division.graph, row.value);
            let is_moved = match rates {
                Some(rates) => rates.len() > 1,
                None => self.is_open(self.phases.len() - 1, &moving, row.value),
            };
            if is_moved && known.clone().add(self, value) {
                let name = format!("{} at the end", row.place.name);
                let place = Place { name, ..row.place };
                rows.push(Constraint { place, value, range: row.range });
            }
        }
        rows
    }

    /// The functions of the surfaces that are held in the last phase.
    fn held_in_the_end(&self) -> Vec<ExprId> {
        let (model, last) = (self.between.division.model, &self.phases[self.phases.len() - 1]);
        let switches = model.switches();
        let held = switches.iter().zip(&last.modes).filter(|it| *it.1 == Mode::Held);
        held.flat_map(|it| &model.surfaces[it.0.surfaces.clone()]).map(|it| it.psi).collect()
    }
}
