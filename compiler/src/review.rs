//! A text, read and checked in one go: all that commands and editors show of it.

use crate::gaps::Gaps;
use crate::{Model, NamedUnit, allow, bidirectional, check};
use fdcc_grammar::ast;
use fdcc_grammar::{Diagnostic, Memory, Parse, SourceFile, parse_with};

/// What a text means, and what is to be said about it.
pub struct Reviewed {
    /// What could be read of it.
    pub tree: ast::Model,
    /// What it means, if it has no error.
    pub model: Option<Model>,
    /// What each phase means, if it has any.
    pub phases: Vec<Model>,
    /// What is wrong with it, in the order of the text, but for what the text allows.
    pub diagnostics: Vec<Diagnostic>,
    /// The unit of each name, if the text uses units.
    pub units: Vec<NamedUnit>,
}

/// Reads and checks a text.
pub fn review(text: &str) -> Reviewed {
    review_with(&mut Memory::default(), text)
}

/// The same with a memory of the text as it was before, which spares reading what has not changed.
pub fn review_with(memory: &mut Memory, text: &str) -> Reviewed {
    reviewed(text, parse_with(memory, text))
}

/// Checks a text that has been read.
pub(crate) fn reviewed(text: &str, parsed: Parse) -> Reviewed {
    let mut diagnostics = parsed.diagnostics;
    let (mut model, mut phases, mut units) = (None, Vec::new(), Vec::new());
    if !parsed.tree.items.is_empty() {
        let is_broken = !diagnostics.is_empty();
        let checked = check(&parsed.tree);
        model = checked.model.filter(|_| !is_broken);
        phases = checked.phases;
        units = checked.units;
        let source = SourceFile::new("", text);
        let gaps = Gaps::new(&source, &diagnostics, &parsed.lost);
        let trusted = |it: &Diagnostic| !is_broken || !gaps.may_be_behind(it);
        diagnostics.extend(checked.diagnostics.into_iter().filter(trusted));
    }
    diagnostics.extend(bidirectional::found(text));
    let mut diagnostics = allow::apply(text, diagnostics);
    diagnostics.sort_by_key(Diagnostic::span);
    Reviewed { tree: parsed.tree, model, phases, diagnostics, units }
}
