//! Applies repairs until nothing is left to repair.
//!
//! A repair is kept only if the text is better for it: fewer mistakes of syntax, or the same number
//! further down, or else fewer errors, or else fewer findings. Each of these can only shrink, so
//! repairing ends, and repairing the result changes nothing.

use super::analyze_parsed;
use fdcc_grammar::{Diagnostic, Parse, ParseCache, Severity, parse_with, repaired};

/// The text with all certain repairs, and with those that are likely if asked for.
pub fn repair(text: &str, unsafely: bool) -> String {
    let mut cache = ParseCache::default();
    let parsed = parse_with(&mut cache, text);
    let mut draft = Draft::new(text.to_owned(), Unreadable::of(text, &parsed), parsed);
    while let Some(better) = draft.improved(unsafely, &mut cache) {
        draft = better;
    }
    draft.text
}

/// A text with all that is to be said about it.
struct Draft {
    text: String,
    found: Vec<Diagnostic>,
    unreadable: Unreadable,
}

/// Mistakes of syntax.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Unreadable {
    count: usize,
    /// How far before the end they stand, all together.
    before_the_end: usize,
}

impl Unreadable {
    fn of(text: &str, parsed: &Parse) -> Self {
        let places = parsed.diagnostics.iter().map(|it| text.len() - it.span().start as usize);
        Unreadable { count: parsed.diagnostics.len(), before_the_end: places.sum() }
    }
}

impl Draft {
    fn new(text: String, unreadable: Unreadable, parsed: Parse) -> Self {
        Draft { found: analyze_parsed(&text, parsed, None).diagnostics, text, unreadable }
    }

    /// All repairs at once, or the first one that helps.
    fn improved(&self, unsafely: bool, cache: &mut ParseCache) -> Option<Draft> {
        let apply = |found: &[Diagnostic]| repaired(&self.text, found, unsafely);
        let single = self.found.iter().filter_map(|it| apply(std::slice::from_ref(it)));
        apply(&self.found).into_iter().chain(single).find_map(|text| self.better(text, cache))
    }

    /// The text, if it is better than this one. What is harder to read is not looked at any
    /// further.
    fn better(&self, text: String, cache: &mut ParseCache) -> Option<Draft> {
        let parsed = parse_with(cache, &text);
        let unreadable = Unreadable::of(&text, &parsed);
        if unreadable > self.unreadable {
            return None;
        }
        let other = Draft::new(text, unreadable, parsed);
        (other.badness() < self.badness()).then_some(other)
    }

    /// How bad the text is, the worst first: mistakes of syntax, errors, findings.
    fn badness(&self) -> (Unreadable, usize, usize) {
        let errors = self.found.iter().filter(|it| it.severity == Severity::Error).count();
        (self.unreadable, errors, self.found.len())
    }
}
