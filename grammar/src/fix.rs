//! Repairs: what would be changed in the text so that a finding goes away.
//!
//! A repair is *certain* if the text has only one reading, and *likely* if it is the best guess at
//! what was meant. Places are those of the text that the finding is about; nothing here knows about
//! files.

use crate::{Diagnostic, Span};

/// A piece of the text and what should stand there instead.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// What is replaced; empty for an insertion.
    pub span: Span,
    /// The new text.
    pub replacement: String,
}

/// One way to repair the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fix {
    /// What it does, as a request: "write `in`".
    pub title: String,
    /// What changes, disjoint.
    pub edits: Vec<Edit>,
    /// Whether it may be applied without asking.
    pub certain: bool,
}

impl Fix {
    /// A repair that may be applied without asking.
    pub fn certain(title: impl Into<String>) -> Self {
        Fix { title: title.into(), edits: Vec::new(), certain: true }
    }

    /// The best guess at what was meant.
    pub fn likely(title: impl Into<String>) -> Self {
        Fix { certain: false, ..Fix::certain(title) }
    }

    /// Adds a replacement.
    pub fn replace(mut self, span: Span, replacement: impl Into<String>) -> Self {
        self.edits.push(Edit { span, replacement: replacement.into() });
        self
    }

    /// Adds an insertion before a byte.
    pub fn insert(self, at: u32, text: impl Into<String>) -> Self {
        self.replace(Span { start: at, end: at }, text)
    }

    /// Takes out what stands there.
    pub fn remove(self, span: Span) -> Self {
        self.replace(span, "")
    }
}

/// A text with the first repair of each finding, as far as the repairs do not touch one another;
/// `None` if there is nothing to repair. With `unsafely`, what is likely is done as well.
pub fn apply(text: &str, diagnostics: &[Diagnostic], unsafely: bool) -> Option<String> {
    let mut edits: Vec<&Edit> = Vec::new();
    for diagnostic in diagnostics {
        let fix = diagnostic.fixes.iter().find(|fix| fix.certain || unsafely);
        let new = fix.map_or(&[][..], |fix| &fix.edits);
        let is_free = |edit: &Edit| edits.iter().all(|other| are_apart(edit.span, other.span));
        if new.iter().all(is_free) {
            edits.extend(new);
        }
    }
    edits.sort_by_key(|edit| edit.span);
    let mut repaired = text.to_owned();
    for edit in edits.iter().rev() {
        repaired.replace_range(edit.span.range(), &edit.replacement);
    }
    (repaired != text).then_some(repaired)
}

/// Whether two edits do not meet: two insertions at one place would have no order.
fn are_apart(one: Span, other: Span) -> bool {
    one.end < other.start || other.end < one.start
}
