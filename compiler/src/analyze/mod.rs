//! A text, read and checked in one go: all that commands and editors show of it.

mod allow;
mod checked;
mod consequences;
pub(crate) mod repair;
pub(crate) mod sensitivity_query;
mod unparsed;
mod unseen;

use crate::data::Files;
use crate::model::Model;
use crate::units::NamedUnit;
pub use checked::{Checked, check, check_given, check_with};
use fdcc_grammar::ast;
use fdcc_grammar::{Code, Diagnostic, Parse, ParseCache, SourceFile, parse_with};
use unparsed::UnparsedRegions;

/// What a text means, and what is to be said about it.
pub struct Analysis {
    /// What could be read of it.
    pub tree: ast::Model,
    /// What it means, if it has no error.
    pub model: Option<Model>,
    /// What is wrong with it, in the order of the text, but for what the text allows.
    pub diagnostics: Vec<Diagnostic>,
    /// The unit of each name, if the text uses units.
    pub units: Vec<NamedUnit>,
}

/// Reads and checks a text.
pub fn analyze(text: &str) -> Analysis {
    analyze_with(&mut ParseCache::default(), text, None)
}

/// The same with a cache of the text as it was before, which spares reading what has not changed,
/// and with the texts of data files.
pub fn analyze_with(cache: &mut ParseCache, text: &str, files: Option<&dyn Files>) -> Analysis {
    analyze_parsed(text, parse_with(cache, text), files)
}

/// Checks a text that has been read.
pub(crate) fn analyze_parsed(text: &str, parsed: Parse, files: Option<&dyn Files>) -> Analysis {
    let mut diagnostics = parsed.diagnostics;
    let (mut model, mut units) = (None, Vec::new());
    if !parsed.tree.items.is_empty() {
        let is_broken = !diagnostics.is_empty();
        let checked = check_with(&parsed.tree, files);
        model = checked.model.filter(|_| !is_broken);
        units = checked.units;
        let source = SourceFile::new("", text);
        let regions = UnparsedRegions::new(&source, &diagnostics, &parsed.lost);
        // Behind a phase that has lost its head, where an item stands is not known.
        let broken = diagnostics.iter().map(|it| it.span().start).min();
        let is_place = |it: &Diagnostic| {
            it.code == Code::NotAllowedHere && broken.is_some_and(|first| first <= it.span().start)
        };
        let trusted = |it: &Diagnostic| !is_broken || !(is_place(it) || regions.may_be_behind(it));
        diagnostics.extend(checked.diagnostics.into_iter().filter(trusted));
    }
    diagnostics.extend(unseen::found(text));
    let mut diagnostics = allow::apply(text, diagnostics);
    diagnostics.sort_by_key(Diagnostic::span);
    Analysis { tree: parsed.tree, model, diagnostics, units }
}
