//! The text of a model: from characters to a syntax tree and diagnostics.
//!
//! Parsing cannot fail: [`parse()`] returns what it understood and what it did not.

// What the generated parser takes its boxes from.
extern crate alloc;

pub mod ast;
mod diagnostic;
mod fix;
mod format;
mod parse;
mod repaired;
mod source;

pub use diagnostic::{Code, Diagnostic, Label, Severity};
pub use fix::{Edit, Fix};
pub use format::format;
pub use parse::words;
pub use parse::{ParseCache, comments, parse, parse_with};
pub use repaired::repaired;
pub use source::{LineColumn, SourceFile, Span};

/// What a text holds: the items that could be read, and what is wrong with the rest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parse {
    /// The tree of everything that could be read.
    pub tree: ast::Model,
    /// In the order of the text.
    pub diagnostics: Vec<Diagnostic>,
    /// Items that could not be read; what they declare may be used elsewhere.
    pub lost: Vec<Span>,
}
