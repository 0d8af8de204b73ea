//! What stands between two words: line breaks, empty lines and comments.

/// A comment and the column where it begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Remark<'t> {
    pub text: &'t str,
    pub column: usize,
}

/// What stands between two words, line by line.
#[derive(Debug, Default)]
pub(super) struct Gap<'t> {
    /// The comment behind the first word, on its line.
    pub behind: Option<Remark<'t>>,
    /// The lines between the two: comments, or nothing.
    pub between: Vec<Option<Remark<'t>>>,
    /// Whether the second word stands on another line.
    pub breaks: bool,
}

impl Gap<'_> {
    /// Whether there is any comment.
    pub fn has_comments(&self) -> bool {
        self.behind.is_some() || self.between.iter().any(Option::is_some)
    }
}

/// Reads `text[from..to]`, which has no words.
pub(super) fn gap(text: &str, from: usize, to: usize) -> Gap<'_> {
    let lines: Vec<&str> = text[from..to].split('\n').collect();
    let mut at = from;
    let mut remarks = Vec::new();
    for line in &lines {
        remarks.push(remark(text, at, line));
        at += line.len() + 1;
    }
    let breaks = lines.len() > 1;
    let behind = if from == 0 { None } else { remarks[0] };
    let first = usize::from(from != 0);
    // What stands before a word on its line is neither a comment nor an empty line; at the end of
    // the text there is no word.
    let last = if to == text.len() || !breaks { lines.len() } else { lines.len() - 1 };
    Gap { behind, between: remarks.get(first..last).unwrap_or_default().to_vec(), breaks }
}

fn remark<'t>(text: &'t str, start: usize, line: &'t str) -> Option<Remark<'t>> {
    let begins = line.find('#')?;
    let line_start = text[..start].rfind('\n').map_or(0, |end| end + 1);
    let column = text[line_start..start + begins].chars().count();
    Some(Remark { text: line[begins..].trim_end(), column })
}
