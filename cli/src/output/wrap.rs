//! Long lines for a terminal, which would break them anywhere.

use std::io::IsTerminal;

/// What stands behind the word of a line, such as ` done  `.
const INDENT: usize = 7;
/// Narrower terminals get lines as they are.
const NARROWEST: usize = 40;

/// How wide the terminal is; nothing where the standard output is none, or a very narrow one.
pub(super) fn terminal() -> Option<usize> {
    let size = || terminal_size::terminal_size().map(|it| usize::from(it.0.0));
    let width = std::io::stdout().is_terminal().then(size).flatten();
    width.filter(|it| *it >= NARROWEST)
}

/// A text whose lines go on between words where a terminal ends; unchanged where the standard
/// output is none.
pub fn for_terminal(text: &str) -> String {
    match terminal() {
        Some(width) => {
            text.split_inclusive('\n').map(|line| hanging(line, width, INDENT)).collect()
        }
        None => text.to_owned(),
    }
}

/// A line that goes on under its text, which is so far from the left.
pub(super) fn hanging(line: &str, width: usize, indent: usize) -> String {
    let (body, end) = line.strip_suffix('\n').map_or((line, ""), |body| (body, "\n"));
    let (mut text, mut column) = (String::new(), 0);
    let mut rest = body;
    while !rest.is_empty() {
        let blanks = rest.len() - rest.trim_start_matches(' ').len();
        let word = rest[blanks..].find(' ').map_or(rest.len(), |at| blanks + at);
        let size = rest[..word].chars().count();
        if column + size > width && column > indent {
            text += "\n";
            text += &" ".repeat(indent);
            column = indent + size - blanks;
            text += &rest[blanks..word];
        } else {
            column += size;
            text += &rest[..word];
        }
        rest = &rest[word..];
    }
    text + end
}

#[cfg(test)]
mod tests {
    use super::{INDENT, hanging};

    #[test]
    fn a_long_line_goes_on_under_its_text() {
        let line = " true  replayed: objective 5.3   `x` differs by 1e-9   all conditions met\n";
        let lines = [
            " true  replayed: objective 5.3   `x`",
            "       differs by 1e-9   all conditions",
            "       met\n",
        ];
        let expected = lines.join("\n");
        assert_eq!(hanging(line, 40, INDENT), expected);
        assert_eq!(hanging(line, 80, INDENT), line);
        let word = format!(" wrote {}\n", "x".repeat(60));
        assert_eq!(hanging(&word, 40, INDENT), word, "a word is not broken");
    }
}
