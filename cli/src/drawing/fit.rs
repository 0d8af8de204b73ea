//! Makes drawings fit the width of a terminal, which would break them anywhere: labels go on in a
//! new line between words, and a long line of a model ends with `…` where nothing is said about the
//! rest of it.

use std::borrow::Cow;
use std::ops::Range;

/// A label at the right edge gets so many columns at least.
const NARROWEST_LABEL: usize = 16;

/// Between the number of a line and its text: ` 17 │ `.
const FRAME: usize = 4;

/// Before a label: `╰── `.
const HOOK: usize = 4;

/// Stands for every byte that is cut off, and is taken out of the drawing.
pub const CUT: char = '\x7f';

/// How wide a tab is drawn.
const TAB: usize = 4;

/// A page that is drawn: its width, and how many digits the numbers of its lines have.
#[derive(Clone, Copy, Debug)]
pub struct Page {
    pub width: usize,
    pub digits: usize,
}

impl Page {
    /// The text of a label under a place in the text, in lines that fit beside it.
    pub fn label(self, label: &str, text: &str, place: Range<usize>) -> String {
        let line = line_of(text, place.start);
        let hook = match text[place.clone()].contains('\n') {
            true => 0,
            false => columns(&text[line.start..place.start]) + columns(&text[place]) / 2,
        };
        wrapped(label, self.room().saturating_sub(hook + HOOK).max(NARROWEST_LABEL))
    }

    /// The text with the ends of those lines cut that are too long, byte by byte as long as before.
    /// No place is cut into.
    pub fn lines<'t>(self, text: &'t str, places: &[Range<usize>]) -> Cow<'t, str> {
        let mut text = Cow::Borrowed(text);
        for place in places {
            let mut at = line_above(&text, line_of(&text, place.start).start);
            let last = line_below(&text, line_of(&text, place.end).end);
            while at <= last {
                let line = line_of(&text, at);
                at = line.end + 1;
                if let Some(from) = self.end_of_what_fits(&text, &line)
                    && places.iter().all(|it| it.end <= from || it.start >= line.end)
                {
                    let rest = CUT.to_string().repeat(line.end - from - '…'.len_utf8());
                    text.to_mut().replace_range(from..line.end, &format!("…{rest}"));
                }
            }
        }
        text
    }

    /// Whether a place lies within the width: an arrow at another one would be torn off its line.
    pub fn holds(self, text: &str, place: usize) -> bool {
        columns(&text[line_of(text, place).start..place]) < self.room()
    }

    /// Columns for lines of the model.
    fn room(self) -> usize {
        self.width.saturating_sub(self.digits + FRAME)
    }

    /// Where a line is cut; nothing if it fits, or if there is no room for the sign that it is cut.
    fn end_of_what_fits(self, text: &str, line: &Range<usize>) -> Option<usize> {
        let whole = &text[line.clone()];
        if columns(whole) <= self.room() {
            return None;
        }
        let mut characters = whole.char_indices().map(|(at, _)| at);
        let from = characters.find(|&at| columns(&whole[..at]) + 1 >= self.room())?;
        let kept = whole[..from].trim_end().len();
        (whole.len() - kept >= '…'.len_utf8()).then_some(line.start + kept)
    }
}

/// Breaks a text between words; `code` stays whole.
fn wrapped(text: &str, room: usize) -> String {
    let (mut lines, mut line, mut is_code) = (Vec::new(), String::new(), false);
    for word in text.split(' ') {
        let fits = line.is_empty() || is_code || columns(&line) + 1 + columns(word) <= room;
        if !fits {
            lines.push(std::mem::take(&mut line));
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
        is_code ^= word.matches('`').count() % 2 == 1;
    }
    lines.push(line);
    lines.join("\n")
}

fn columns(text: &str) -> usize {
    text.chars()
        .fold(0, |column, c| if c == '\t' { column + TAB - column % TAB } else { column + 1 })
}

/// The line of a byte, without its end.
fn line_of(text: &str, at: usize) -> Range<usize> {
    let start = text[..at].rfind('\n').map_or(0, |end| end + 1);
    let end = text[at..].find('\n').map_or(text.len(), |end| at + end);
    start..end
}

fn line_above(text: &str, start: usize) -> usize {
    if start == 0 { 0 } else { line_of(text, start - 1).start }
}

fn line_below(text: &str, end: usize) -> usize {
    if end >= text.len() { end } else { line_of(text, end + 1).end }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_break_between_words_and_not_in_code() {
        assert_eq!(wrapped("a control, which varies", 12), "a control,\nwhich varies");
        assert_eq!(wrapped("while `slip is 0` it holds", 10), "while\n`slip is 0`\nit holds");
        assert_eq!(wrapped("unbreakable", 4), "unbreakable");
    }

    #[test]
    fn a_long_line_is_cut_behind_what_is_said_of_it() {
        let page = Page { width: 20, digits: 1 };
        let text = "param a = 1 # a number that is one\nparam b = 2\n";
        let cut = |place: Range<usize>| page.lines(text, std::slice::from_ref(&place)).into_owned();
        assert_eq!(cut(6..7).len(), text.len());
        assert_eq!(cut(6..7).replace(CUT, ""), "param a = 1 #…\nparam b = 2\n");
        assert_eq!(cut(20..24), text, "what is marked stays");
        assert!(cut(40..41).contains('…'), "the line above is cut as well");
    }
}
