//! Names of phases that were written once, for each of several files: `run[1]`, `run[2]`. No name
//! in a text has brackets, so they are those of nothing else.

use fdcc_grammar::ast::{Expr, ExprKind};
use std::borrow::Cow;

/// The name of the phase of one file, counted from 1.
pub(crate) fn numbered(name: &str, at: usize) -> String {
    format!("{name}[{at}]")
}

/// The name of a phase where an expression may be one: `coast`, `run[2]`.
pub(crate) fn phase_named(base: &Expr) -> Option<Cow<'_, str>> {
    match &base.kind {
        ExprKind::Name(name) => Some(Cow::Borrowed(name)),
        ExprKind::Index(inner, at) => match &inner.kind {
            ExprKind::Name(name) => Some(Cow::Owned(numbered(name, *at))),
            _ => None,
        },
        _ => None,
    }
}

/// A message without the numbers of phases.
pub(crate) fn unnumbered(message: &str) -> String {
    let mut pieces = message.split('[');
    let first = pieces.next().unwrap_or_default().to_owned();
    let without = |piece: &str| match piece.trim_start_matches(|it: char| it.is_ascii_digit()) {
        rest if rest.starts_with(']') => format!("[{rest}"),
        _ => format!("[{piece}"),
    };
    pieces.fold(first, |text, piece| text + &without(piece))
}
