//! From text to tree: the text is split into items, and the grammar reads one after the other.
//!
//! Nothing outside this folder knows that the grammar is written for pest, and nothing of pest's
//! own wording is shown.

mod cache;
mod grammar;
mod lexical;
mod outline;
mod recovery;
#[cfg(test)]
mod rules;
mod tree;
#[cfg(test)]
mod whole;

pub(crate) use outline::{Column, Leaf, Part, Row, outline};

use crate::source::line_starts;
use crate::{Code, Diagnostic, Parse, Span};

pub use crate::parse::cache::ParseCache;
pub use lexical::tokens::comments;
pub use lexical::words;

/// A model that somebody writes has a few kilobytes.
const MOST_BYTES: usize = 4_000_000;

/// Reads a text: everything that can be understood, and what is wrong with the rest.
pub fn parse(text: &str) -> Parse {
    parse_with(&mut ParseCache::default(), text)
}

/// The same with a cache of the text as it was before: only what has changed since then is read.
pub fn parse_with(cache: &mut ParseCache, text: &str) -> Parse {
    if let Some(diagnostic) = refuse(text) {
        return Parse { diagnostics: vec![diagnostic], ..Parse::default() };
    }
    let mut parse = recovery::read(text, &lexical::tokens::tokens(text), cache);
    cache.forget();
    parse.tree.docs = doc_lines(text);
    parse.tree.line_starts = line_starts(text).collect();
    if parse.tree.items.is_empty() && parse.diagnostics.is_empty() {
        parse.diagnostics.push(empty_model());
    }
    parse.diagnostics.sort_by_key(Diagnostic::span);
    parse
}

/// What is no model at all: too large, or not text.
fn refuse(text: &str) -> Option<Diagnostic> {
    if text.len() > MOST_BYTES {
        let message = format!("a file of {} MB is too large to be a model", text.len() / 1_000_000);
        let diagnostic =
            Diagnostic::new(Code::TooLarge, message, Span::default(), "the file begins here");
        return Some(diagnostic.help(
            "a model has at most 4 MB; measurements belong in a CSV file, read with `data`",
        ));
    }
    let (at, control) =
        text.char_indices().find(|(_, c)| c.is_control() && !matches!(c, '\t' | '\n' | '\r'))?;
    let span = Span::new(at, at + control.len_utf8());
    let label = format!("a control character, U+{:04X}", u32::from(control));
    let diagnostic = Diagnostic::new(Code::NotText, "this is not a text file", span, label);
    Some(diagnostic.help("a model is plain text in UTF-8"))
}

fn empty_model() -> Diagnostic {
    let message = "there is no item in this file";
    Diagnostic::new(
        Code::EmptyModel,
        message,
        Span::default(),
        "nothing but blanks and comments \
        from here on",
    )
    .help(
        "a model has a time, states and dynamics, for example\n  time t in [0, 1]\n  state x \
               start 0\n  dynamics { x' = 1 }",
    )
}

/// The `#!` lines before the first item.
fn doc_lines(text: &str) -> Vec<String> {
    let head = text.trim_start_matches('\u{FEFF}').lines().map(str::trim);
    let head = head.take_while(|line| line.is_empty() || line.starts_with('#'));
    head.filter_map(|line| line.strip_prefix("#!")).map(|doc| doc.trim().to_owned()).collect()
}
