//! A text, read and checked in one go: all that commands and editors show of it.

use crate::{Model, allow, check};
use fdcc_grammar::{Code, Diagnostic, parse};

/// What a text means, and what is to be said about it.
pub struct Reviewed {
    /// What it means, if it has no error.
    pub model: Option<Model>,
    /// What is wrong with it, in the order of the text, but for what the text allows.
    pub diagnostics: Vec<Diagnostic>,
}

/// Reads and checks a text.
pub fn review(text: &str) -> Reviewed {
    let parsed = parse(text);
    let mut diagnostics = parsed.diagnostics;
    let mut model = None;
    if !parsed.tree.items.is_empty() {
        let is_broken = !diagnostics.is_empty();
        let checked = check(&parsed.tree);
        model = checked.model.filter(|_| !is_broken);
        let trusted = |it: &Diagnostic| !is_broken || !is_about_absence(text, it);
        diagnostics.extend(checked.diagnostics.into_iter().filter(trusted));
    }
    let mut diagnostics = allow::apply(text, diagnostics);
    diagnostics.sort_by_key(Diagnostic::span);
    Reviewed { model, diagnostics }
}

/// Whether a finding says that something is not there, though it may be in the part of the text that cannot be read.
fn is_about_absence(text: &str, diagnostic: &Diagnostic) -> bool {
    match diagnostic.code {
        Code::UnknownName => is_second_word(text, &text[diagnostic.span().range()]),
        code => matches!(code, Code::NoBoundary | Code::NoEquation | Code::NoTime | Code::Unused),
    }
}

/// Whether a line has a name where a declaration has it.
fn is_second_word(text: &str, name: &str) -> bool {
    let second = |line: &str| {
        let mut words =
            line.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty());
        words.nth(1) == Some(name)
    };
    text.lines().any(second)
}
