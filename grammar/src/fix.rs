//! Repairs: what would be changed in the text so that a finding goes away.
//!
//! A repair is *certain* if the text has only one reading, and *likely* if it is the best guess at
//! what was meant. Places are those of the text that the finding is about; nothing here knows about
//! files.

use crate::Span;

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
