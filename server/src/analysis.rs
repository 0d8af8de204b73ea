//! All that is known about one state of a text.

use crate::text::Text;
use fdcc_compiler::names::Names;
use fdcc_compiler::{Reviewed, review};
use fdcc_grammar::{Code, Severity};
use std::cell::OnceCell;

/// What a text means and what is wrong with it.
pub struct Analysis {
    /// The text.
    pub text: Text,
    /// As `fdcc check` sees it.
    pub reviewed: Reviewed,
    /// Whether all of it could be read.
    pub is_readable: bool,
    names: OnceCell<Names>,
}

impl Analysis {
    /// Reads and checks a text.
    pub fn new(text: Text) -> Self {
        let reviewed = review(&text.text);
        let is_syntax = |code: Code| code.as_str().starts_with("FDC00");
        let is_readable =
            !reviewed.diagnostics.iter().any(|it| it.severity == Severity::Error && is_syntax(it.code));
        Analysis { text, reviewed, is_readable, names: OnceCell::new() }
    }

    /// Every name with its role.
    pub fn names(&self) -> &Names {
        self.names.get_or_init(|| Names::new(&self.reviewed.tree))
    }
}
