//! What is checked before the grammar sees a text, so that no text can exhaust its stack or its
//! time.

use super::items::Region;
use super::tokens::{Kind, Token};
use super::words;
use crate::parse::grammar::Rule;

/// Brackets inside each other. The grammar recurses on each, so this bounds its stack.
pub(crate) const MOST_BRACKETS: usize = 100;

/// Words, numbers and signs of one item. An item written by a person has dozens.
pub(crate) const MOST_TOKENS: usize = 50_000;

/// Bytes of one word or number, so that every message stays readable.
pub(crate) const MOST_LETTERS: usize = 255;

/// Why a region cannot be read.
pub(crate) enum Failure {
    /// The bracket with this token number is one too many inside each other.
    TooDeep(usize),
    /// The item has too many tokens.
    TooLong,
    /// The token with this number has too many letters.
    LongWord(usize),
    /// The grammar gave up at this byte, where it would have gone on with one of these.
    Stopped(usize, Vec<Rule>),
}

/// Why a region may not be given to the grammar.
pub(crate) fn exceeded(tokens: &[Token<'_>], region: &Region) -> Option<Failure> {
    let inside = &tokens[region.clone()];
    let bracket = || too_deep(inside).map(|at| Failure::TooDeep(region.start + at));
    let word = || long_word(inside).map(|at| Failure::LongWord(region.start + at));
    bracket().or_else(word).or_else(|| is_too_long(inside).then_some(Failure::TooLong))
}

/// Whether an item is too long, be it one of a phase.
fn is_too_long(tokens: &[Token<'_>]) -> bool {
    let is_item_word =
        |token: &Token<'_>| token.kind == Kind::Word && words::always_begins(token.text);
    tokens.len() > MOST_TOKENS && tokens.split(is_item_word).any(|item| item.len() > MOST_TOKENS)
}

fn long_word(tokens: &[Token<'_>]) -> Option<usize> {
    tokens.iter().position(|token| token.text.len() > MOST_LETTERS)
}

/// The first bracket that stands inside too many others.
fn too_deep(tokens: &[Token<'_>]) -> Option<usize> {
    let mut depth = 0_usize;
    tokens.iter().position(|token| {
        match token.kind {
            Kind::Open => depth += 1,
            Kind::Close => depth = depth.saturating_sub(1),
            _ => {}
        }
        depth > MOST_BRACKETS
    })
}
