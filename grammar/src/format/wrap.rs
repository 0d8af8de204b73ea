//! Lines that are too long, broken before operators and behind commas: outside brackets rather than
//! inside, before comparisons rather than sums, before sums rather than products.

use super::WIDTH;
use super::lines::{CONTINUED, Line};

/// The lines with every break that is needed and possible; a comment stays behind the last part.
pub(super) fn wrap(lines: Vec<Line<'_>>) -> Vec<Line<'_>> {
    let mut wrapped = Vec::new();
    for mut line in lines {
        let indent = line.indent + CONTINUED;
        while let Some(at) = place_to_break(&line) {
            let rest = line.words.split_off(at);
            let comment = line.comment.take();
            wrapped.push(line);
            line = Line { indent, words: rest, comment, blank_before: false };
        }
        wrapped.push(line);
    }
    wrapped
}

/// The word before which a line that is too long is broken: of the most willing ones the last that
/// still leaves the line short enough, or the first if none does.
fn place_to_break(line: &Line<'_>) -> Option<usize> {
    if line.width() <= WIDTH {
        return None;
    }
    let places = willingness(line);
    let fitting = || places.iter().filter(|(at, _)| line.width_before(*at) <= WIDTH);
    let best = fitting().map(|(_, level)| level).min();
    let last = fitting().rfind(|(_, level)| Some(level) == best);
    last.or(places.first()).map(|(at, _)| *at)
}

/// The words before which a line may be broken, the most willing with the lowest number.
fn willingness(line: &Line<'_>) -> Vec<(usize, usize)> {
    const LEVELS: usize = 3;
    let (mut depth, mut blocks) = (0_usize, 0_usize);
    let mut places = Vec::new();
    for (at, word) in line.words.iter().enumerate() {
        match word.text {
            "(" | "[" => depth += 1,
            ")" | "]" => depth = depth.saturating_sub(1),
            "{" => blocks += 1,
            "}" => blocks = blocks.saturating_sub(1),
            _ => {}
        }
        let inside = depth - usize::from(matches!(word.text, "(" | "["));
        if let Some(level) = word.breaks.filter(|_| at > 0 && blocks == 0) {
            places.push((at, inside * LEVELS + level));
        }
    }
    places
}
