//! `fdcc fmt`: a text in the canonical layout.
//!
//! The layout is made of the words as they were written, so nothing is lost or rewritten: numbers,
//! parentheses and comments stay as they are. What it depends on is unchanged by it, so that
//! formatting twice changes nothing:
//!
//! 1. an item or entry stands on a line of its own, two blanks further in for each block around it
//!    (`lines`);
//! 2. a block stays on one line if it was written on one line and fits;
//! 3. blanks between words follow from the words, but for `*` and `/`, which are written `a*b` or
//!    `a * b` (`spacing`);
//! 4. neighbours line up in columns (`table`), and so do comments (`comments`);
//! 5. lines of more than 110 characters are broken at operators and commas (`wrap`);
//! 6. one empty line is kept where there were some; a block that is an item of the file has one
//!    before and behind.

mod comments;
mod gaps;
mod lines;
mod spacing;
mod table;
mod wrap;

use crate::parse::{outline, parse};
use crate::{Diagnostic, Severity};
use lines::{Line, lines};

/// No line of code is longer if it can be broken.
const WIDTH: usize = 110;

/// The text in the canonical layout, or why it cannot be read. Line ends stay those of the first
/// line.
pub fn format(text: &str) -> Result<String, Vec<Diagnostic>> {
    let errors: Vec<Diagnostic> =
        parse(text).diagnostics.into_iter().filter(|it| it.severity == Severity::Error).collect();
    if !errors.is_empty() {
        return Err(errors);
    }
    let has_carriage_returns =
        text.split_once('\n').is_some_and(|(first, _)| first.ends_with('\r'));
    let plain = text.trim_start_matches('\u{FEFF}').replace("\r\n", "\n").replace('\r', "\n");
    let formatted = lay_out(&plain);
    Ok(if has_carriage_returns { formatted.replace('\n', "\r\n") } else { formatted })
}

fn lay_out(text: &str) -> String {
    let words = spacing::words(text, &outline(text));
    let mut lines = wrap::wrap(lines(text, &words));
    comments::line_up(&mut lines);
    lines.iter().map(written).collect()
}

/// The line as it stands in the file.
fn written(line: &Line<'_>) -> String {
    let mut text = " ".repeat(line.indent);
    for (at, word) in line.words.iter().enumerate() {
        text += &" ".repeat(if at == 0 { 0 } else { word.blanks });
        text += word.text;
    }
    if let Some(comment) = &line.comment {
        text += &" ".repeat(comment.blanks);
        text += comment.text;
    }
    let before = if line.blank_before { "\n" } else { "" };
    format!("{before}{}\n", text.trim_end())
}
