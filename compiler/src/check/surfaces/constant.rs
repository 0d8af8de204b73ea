//! FDC0312: a surface whose function does not change along a motion.

use super::Subject;
use crate::model::Symbol;
use crate::syntax::text;
use fdcc_grammar::{Code, Diagnostic};

impl Subject<'_, '_, '_> {
    /// The finding, where the function reads nothing that changes over time.
    pub fn constant(&self) -> Option<Diagnostic> {
        let psi = self.view.surfaces[self.at].1?;
        let symbols = &self.facts.meaning.symbols;
        let is_fixed =
            |input: u32| matches!(symbols[input as usize], Symbol::Param(_) | Symbol::Free(_));
        if !self.facts.meaning.graph.inputs_of(&[psi]).into_iter().all(is_fixed) {
            return None;
        }
        let value = self.facts.meaning.numeric(psi);
        let label = match value.is_finite() {
            true => format!("always {}", text::number(value)),
            false => "the same at all times".into(),
        };
        let message = format!("surface `{}` never changes sides", self.name());
        let found = Diagnostic::new(Code::ConstantSurface, message, self.function(), label);
        Some(found.help(
            "a surface depends on states or on time; for a choice that is made once, write a \
                 `param`",
        ))
    }
}
