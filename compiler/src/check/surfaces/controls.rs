//! FDC0306: a control that acts differently on the two sides of a surface.

use super::Subject;
use crate::expressions::graph::ExprId;
use crate::expressions::graph::derivative::derivative;
use crate::model::Symbol;
use fdcc_grammar::ast::ExprKind;
use fdcc_grammar::{Code, Diagnostic};

impl Subject<'_, '_, '_> {
    /// The first state and control for which the derivatives on both sides differ.
    pub(super) fn control_jumps(&mut self) -> Option<Diagnostic> {
        let controls: Vec<(u32, Symbol)> = (0..)
            .zip(self.local.symbols.iter().copied())
            .filter(|it| matches!(it.1, Symbol::Control(_)))
            .collect();
        let sides: Vec<[ExprId; 2]> = self.local.sides.iter().map(|it| it.1).collect();
        for (input, symbol) in controls {
            for ends in &sides {
                let slopes = ends.map(|end| {
                    let slope = derivative(&mut self.local.graph, end, input);
                    self.local.normal(slope)
                });
                let difference = self.local.graph.sub(slopes[1], slopes[0]);
                if !self.local.form(difference).is_zero() {
                    return Some(self.two_slopes(symbol, slopes));
                }
            }
        }
        None
    }

    fn two_slopes(&mut self, symbol: Symbol, slopes: [ExprId; 2]) -> Diagnostic {
        let control = self.view.name(symbol);
        let message =
            format!("control `{control}` acts differently on the two sides of `{}`", self.name());
        let [below, above] = slopes.map(|slope| self.text(slope));
        let label = format!("d/d{control} is {below} below and {above} above");
        let span = match self.place.map(|place| (&place.set.kind, place.term.span)) {
            Some((ExprKind::Match { sides, .. }, _)) => *sides,
            Some((_, term)) => term,
            None => self.declared(),
        };
        Diagnostic::new(Code::ControlJumps, message, span, label).help(
            "Section 7 of the method needs d/du of the right side to be continuous. Without it, \
             controls at the crossing time get a smeared gradient. Check the answer with `fdcc \
             sweep --continue sigma`.",
        )
    }
}
