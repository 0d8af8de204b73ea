//! FDC0407: states, controls or dynamics need a `time`; FDC0102: one is enough.

use crate::check::facts::Facts;
use crate::syntax::scope::declared;
use fdcc_grammar::ast::{Ident, ItemKind};
use fdcc_grammar::{Code, Diagnostic};

/// Reports a model that moves without a time to move in.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let declarations = &facts.meaning.scope.declarations;
    let mut times = declarations.iter().filter(|it| matches!(it.item.kind, ItemKind::Time { .. }));
    if let Some(first) = times.next() {
        found.extend(times.map(|second| twice(second.name, first.name)));
        return;
    }
    let moves = |kind: &ItemKind| {
        matches!(
            kind,
            ItemKind::State { .. } | ItemKind::Control { .. } | ItemKind::Dynamics { .. }
        )
    };
    if let Some(first) = facts.items.iter().find(|item| moves(&item.kind)) {
        let span = declared(first).map_or(first.span, |name| name.span);
        let diagnostic = Diagnostic::new(
            Code::NoTime,
            "the model has no time",
            span,
            "changes over time, but from when to when?",
        );
        found
            .push(diagnostic.help(
                "write `time t in [0, 1]`, or `free T in [0.1, 100]` and `time t in [0, T]`",
            ));
    }
}

fn twice(second: &Ident, first: &Ident) -> Diagnostic {
    Diagnostic::new(Code::DuplicateName, "a second `time`", second.span, "declared again")
        .label(first.span, "the first one")
        .help("a model has one time; leave one out, or give each phase its own")
}
