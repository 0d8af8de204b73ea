//! FDC0310: jumps that can fire without end.

use super::Subject;
use crate::surfaces::endless::restitution;
use fdcc_grammar::ast::{Direction, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Severity, Span};

impl Subject<'_, '_, '_> {
    /// Jumps of this surface that are proved to pile up, with nothing said about what comes after.
    pub(super) fn endless(&mut self) -> Vec<Diagnostic> {
        let (facts, at) = (self.facts, self.at);
        let unlimited = facts.meaning.model.jumps.iter();
        let unlimited = unlimited
            .filter(|it| it.surface == at && it.at_most.is_none() && it.then_hold.is_none());
        let mut found = Vec::new();
        for jump in unlimited {
            if let Some(factor) = restitution(&mut self.local, self.view, jump) {
                let factor = self.text(factor);
                let (place, direction) = self.direction(&jump.place.name, jump.direction);
                let message = format!("`{}` can fire without end", jump.place.name);
                let text = format!("with {factor} < 1 the bounces pile up in finite time");
                let mut diagnostic = Diagnostic::new(Code::EndlessJumps, message, place, text)
                    .help(format!(
                        "say how many may happen: `on {0} {direction} at most 3`, \
                     or what follows the last one: `then hold {0}`",
                        self.name()
                    ));
                // A simulation finds the time at which they end by itself.
                if facts.meaning.model.objective.is_none() {
                    diagnostic.severity = Severity::Advice;
                }
                found.push(diagnostic);
            }
        }
        found
    }

    /// The word of the direction, and where it stands.
    fn direction(&self, jump: &str, direction: Direction) -> (Span, &'static str) {
        let word = if direction == Direction::Falling { "falling" } else { "rising" };
        let place = self.facts.items.iter().find_map(|item| match &item.kind {
            ItemKind::Jump { name, direction_span, .. } if name.name == jump => {
                Some(*direction_span)
            }
            _ => None,
        });
        (place.unwrap_or(self.declared()), word)
    }
}
