//! Conditions at the last time that a held surface says already.
//!
//! Where `psi = 0` is held until the end, `end` conditions that add up to it would be said twice,
//! and the Jacobian of the chain would lose rank: a block that rests in the end with `end v == 0`.

use super::independent::Independent;
use super::{Mode, Modes};
use crate::expressions::graph::ExprId;
use crate::model::{Constraint, Symbol};

impl Modes<'_> {
    /// The conditions at the ends of the whole time; those that follow from what is held in the end
    /// have no bounds.
    pub(super) fn boundary(&mut self) -> Vec<Constraint> {
        let model = self.between.division.model;
        let unbounded = self.unbounded();
        let mut rows = model.boundary.clone();
        let ends: Vec<usize> = (0..rows.len()).filter(|at| self.is_of_end(&rows[*at])).collect();
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
        rows
    }

    /// Whether it is an equation of the state at the last time alone.
    fn is_of_end(&self, row: &Constraint) -> bool {
        let model = self.between.division.model;
        let read = model.graph.inputs_of(&[row.value, row.range.lower]);
        let is_of_end = |at: &u32| {
            let symbol = model.symbols[*at as usize];
            matches!(symbol, Symbol::AtEnd(_) | Symbol::Param(_) | Symbol::Free(_))
        };
        row.range.lower == row.range.upper && read.iter().all(is_of_end)
    }

    /// The functions of the surfaces that are held in the last phase.
    fn held_in_the_end(&self) -> Vec<ExprId> {
        let (model, last) = (self.between.division.model, &self.phases[self.phases.len() - 1]);
        let switches = model.switches();
        let held = switches.iter().zip(&last.modes).filter(|it| *it.1 == Mode::Held);
        held.flat_map(|it| &model.surfaces[it.0.surfaces.clone()]).map(|it| it.psi).collect()
    }
}
