//! Blanks between words, and where a line may be broken.

use crate::parse::{Column, Leaf, Part, Row};

/// A word of the formatted text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word<'t> {
    pub text: &'t str,
    pub start: usize,
    /// The blanks before it on its line.
    pub blanks: usize,
    /// How willingly a line is broken before it: 0 most.
    pub breaks: Option<usize>,
    pub row: Option<Row>,
    pub column: Option<Column>,
}

impl Word<'_> {
    /// One past its last byte.
    pub fn end(&self) -> usize {
        self.start + self.text.len()
    }

    /// How many columns it takes.
    pub fn width(&self) -> usize {
        self.text.chars().count()
    }
}

/// The words with one, two or no blanks before each.
pub(super) fn words<'t>(text: &str, leaves: &[Leaf<'t>]) -> Vec<Word<'t>> {
    let ties: Vec<Tie> = (0..leaves.len()).map(|at| tie(text, leaves, at)).collect();
    let word = |(at, leaf): (usize, &Leaf<'t>)| {
        let before = at.checked_sub(1).map(|at| (&leaves[at], ties[at]));
        let blanks = before.map_or(0, |(before, tie)| blanks(before, tie, leaf, ties[at]));
        let breaks = before.filter(|_| blanks > 0).and_then(|(before, _)| breaks(before, leaf));
        Word {
            text: leaf.text,
            start: leaf.start,
            blanks,
            breaks,
            row: leaf.row,
            column: leaf.column,
        }
    };
    leaves.iter().enumerate().map(word).collect()
}

/// Whether a word holds on to its neighbours.
#[derive(Clone, Copy)]
struct Tie {
    left: bool,
    right: bool,
}

fn tie(text: &str, leaves: &[Leaf<'_>], at: usize) -> Tie {
    let leaf = &leaves[at];
    let (left, right) = match (leaf.part, leaf.text) {
        (Part::UnitSign, _) | (_, "^" | ".") => (true, true),
        (Part::Product, _) => {
            let is_tight = is_tight(text, leaves, at);
            (is_tight, is_tight)
        }
        (Part::Negation, _) => (false, true),
        (Part::Suffix, "(" | "[") => (true, true),
        (_, "(" | "[") => (false, true),
        (_, ")" | "]" | "," | ":" | "'") => (true, false),
        _ => (false, false),
    };
    Tie { left, right }
}

/// Whether a sign between two words was written without blanks.
fn is_tight(text: &str, leaves: &[Leaf<'_>], at: usize) -> bool {
    let before = at.checked_sub(1).is_none_or(|before| leaves[before].end() == leaves[at].start);
    let after = leaves.get(at + 1).is_none_or(|after| leaves[at].end() == after.start);
    debug_assert!(text.is_char_boundary(leaves[at].start));
    before && after
}

fn blanks(before: &Leaf<'_>, before_tie: Tie, leaf: &Leaf<'_>, tie: Tie) -> usize {
    match (before.text, leaf.text) {
        ("{", "}") => 0,
        ("{", _) | (_, "}") => 1,
        // Entries on one line stand apart, unless a comma says so already.
        (text, _) if leaf.row.is_some() && text != "," => 2,
        _ => usize::from(!before_tie.right && !tie.left),
    }
}

fn breaks(before: &Leaf<'_>, leaf: &Leaf<'_>) -> Option<usize> {
    match (leaf.part, leaf.text) {
        (Part::Plain, "<=" | ">=" | "==") => Some(0),
        (Part::Plain, "+" | "-") => Some(1),
        (Part::Product, _) => Some(2),
        _ if before.text == "," => Some(0),
        _ => None,
    }
}
