//! Leaves out the diagnostics that follow from others.

use fdcc_grammar::{Code, Diagnostic, Label, Severity, Span};
use std::collections::{HashMap, HashSet};

/// In the order of the text, each finding once.
pub(super) fn sort(diagnostics: &mut Vec<Diagnostic>) {
    diagnostics.sort_by_key(|it| (it.span(), it.code));
    diagnostics.dedup_by(|a, b| (a.span(), a.code, &a.message) == (b.span(), b.code, &b.message));
}

/// A condition with another mistake in it contradicts nothing.
pub(super) fn without_consequences(mut diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let is_mistake =
        |it: &&Diagnostic| it.severity == Severity::Error && it.code != Code::Contradiction;
    let mistakes: Vec<Span> = diagnostics.iter().filter(is_mistake).map(Diagnostic::span).collect();
    let follows = |it: &Diagnostic| {
        let whole = it.span();
        it.code == Code::Contradiction
            && mistakes.iter().any(|part| whole.start <= part.start && part.end <= whole.end)
    };
    diagnostics.retain(|it| !follows(it));
    diagnostics
}

/// One finding for each unknown name, wherever it is used; and what it is likely a typo of is not
/// called unused.
pub(super) fn without_echoes(diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let mut kept: Vec<Diagnostic> = Vec::new();
    let mut first_use: HashMap<String, usize> = HashMap::new();
    let mut meant: HashSet<Span> = HashSet::new();
    for found in diagnostics {
        if found.code == Code::UnknownName {
            meant.extend(found.labels[1..].iter().map(|label| label.span));
            if let Some(&at) = first_use.get(&found.message) {
                kept[at].labels.push(Label { span: found.span(), text: "here too".into() });
                continue;
            }
            first_use.insert(found.message.clone(), kept.len());
        }
        kept.push(found);
    }
    kept.retain(|it| it.code != Code::Unused || !meant.contains(&it.span()));
    let twice: HashSet<String> =
        kept.iter().filter(|it| it.code == Code::DuplicateName).filter_map(quoted).collect();
    let follows = |it: &Diagnostic| {
        matches!(it.code, Code::WrongKind | Code::Unused)
            && quoted(it).is_some_and(|name| twice.contains(&name))
    };
    kept.retain(|it| !follows(it));
    kept
}

/// The name that a message speaks of.
fn quoted(found: &Diagnostic) -> Option<String> {
    found.message.split('`').nth(1).map(str::to_owned)
}
