//! Applies repairs until nothing is left to repair.
//!
//! A repair is kept only if the text is better for it: fewer mistakes of syntax, or the same number further down, or
//! else fewer errors, or else fewer findings. Each of these can only shrink, so repairing ends, and repairing the
//! result changes nothing.

use crate::review;
use fdcc_grammar::{Severity, fix, parse};

/// The text with all certain repairs, and with those that are likely if asked for.
pub fn repair(text: &str, unsafely: bool) -> String {
    let mut text = text.to_owned();
    let mut badness = Badness::of(&text);
    while let Some((better, less)) = improved(&text, &badness, unsafely) {
        (text, badness) = (better, less);
    }
    text
}

/// All repairs at once, or the first one that helps.
fn improved(text: &str, badness: &Badness, unsafely: bool) -> Option<(String, Badness)> {
    let found = review(text).diagnostics;
    let all = fix::apply(text, &found, unsafely);
    let single = found.iter().filter_map(|it| fix::apply(text, std::slice::from_ref(it), unsafely));
    let tried = all.into_iter().chain(single).map(|text| (Badness::of(&text), text));
    tried.filter(|(new, _)| new < badness).map(|(new, text)| (text, new)).next()
}

/// How bad a text is, the worst first.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Badness {
    /// Mistakes of syntax.
    unreadable: usize,
    /// How far before the end they stand, all together.
    before_the_end: usize,
    errors: usize,
    findings: usize,
}

impl Badness {
    fn of(text: &str) -> Badness {
        let unreadable = parse(text).diagnostics;
        let found = review(text).diagnostics;
        Badness {
            unreadable: unreadable.len(),
            before_the_end: unreadable.iter().map(|it| text.len() - it.span().start as usize).sum(),
            errors: found.iter().filter(|it| it.severity == Severity::Error).count(),
            findings: found.len(),
        }
    }
}
