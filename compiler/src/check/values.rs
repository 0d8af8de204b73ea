//! FDC0408: a parameter needs a value, in the text or from the command line.

use super::Facts;
use fdcc_grammar::ast::ItemKind;
use fdcc_grammar::{Code, Diagnostic, Span};

/// Reports parameters without a value.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    for item in &facts.items {
        if let ItemKind::Param { name, value: None, .. } = &item.kind {
            found.push(missing(&name.name, name.span));
        }
    }
}

/// The finding, also for a run that gave no value.
pub(crate) fn missing(name: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NoValue,
        format!("parameter `{name}` has no value"),
        span,
        "how large is it?",
    )
    .help(format!("write `param {name} = 1`, or give it for one run: `--set {name}=1`"))
}
