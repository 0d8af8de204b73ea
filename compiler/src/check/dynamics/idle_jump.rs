//! FDC0311: a jump that never acts, because one above it always does at the same crossing.

use crate::check::facts::Facts;
use fdcc_grammar::ast::{Direction, Ident, ItemKind};
use fdcc_grammar::{Code, Diagnostic};

/// Reports jumps behind one without `at most` on the same surface and in the same direction.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let mut endless: Vec<(&Ident, &str, Direction)> = Vec::new();
    for item in &facts.items {
        let ItemKind::Jump { name, surface, direction, at_most, .. } = &item.kind else { continue };
        let key = (surface.name.as_str(), *direction);
        match endless.iter().find(|it| (it.1, it.2) == key) {
            Some((first, ..)) => found.push(idle(name, first)),
            None if at_most.is_none() => endless.push((name, key.0, key.1)),
            None => {}
        }
    }
}

fn idle(name: &Ident, first: &Ident) -> Diagnostic {
    let message = format!("jump `{}` never acts", name.name);
    let why =
        format!("`{}` resets at every such crossing, and one jump acts at a time", first.name);
    Diagnostic::new(Code::IdleJump, message, name.span, "the same surface in the same direction")
        .label(first.span, why)
        .help(format!(
            "reset everything in `{0}`, or say how often it may act: `at most n`; then `{1}` \
             follows",
            first.name, name.name
        ))
}
