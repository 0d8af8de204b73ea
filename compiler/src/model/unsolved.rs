//! What is understood but cannot be solved yet, each said in one place: `check` tells it early, and
//! what compiles a problem refuses it.

use super::{Jump, Model, Symbol, not_yet};
use crate::expressions::graph::ExprId;
use fdcc_grammar::Diagnostic;

impl Model {
    /// Measured data beside jumps, of which the objective is no sum: a row may be in any of the
    /// pieces between them.
    pub(crate) fn rows_beside_jumps(&self) -> Option<Diagnostic> {
        let of_phases = self.phases.iter().find_map(|phase| phase.model.rows_beside_jumps());
        of_phases.or_else(|| self.own_rows_beside_jumps())
    }

    fn own_rows_beside_jumps(&self) -> Option<Diagnostic> {
        let (Some(_), Some(sum)) = (self.jumps.first(), self.sums.first()) else { return None };
        let what = "a function of a sum over rows in a model with jumps";
        (!self.are_sums_terms()).then(|| not_yet(sum.place.span, what))
    }

    /// A jump that reads the side of a surface, which a simulation knows and a problem does not.
    pub(crate) fn jump_by_side(&self) -> Option<Diagnostic> {
        let of_phases = self.phases.iter().find_map(|phase| phase.model.jump_by_side());
        of_phases.or_else(|| self.own_jump_by_side())
    }

    fn own_jump_by_side(&self) -> Option<Diagnostic> {
        let jump = self.jumps.iter().find(|jump| self.reads_selectors(jump))?;
        Some(not_yet(jump.place.span, "a jump that reads the side of a surface"))
    }

    fn reads_selectors(&self, jump: &Jump) -> bool {
        let values: Vec<ExprId> = jump.resets.iter().map(|reset| reset.1).collect();
        let read = self.graph.inputs_of(&values);
        read.iter().any(|at| matches!(self.symbols[*at as usize], Symbol::Selector(_)))
    }
}
