//! Words and comments in lines: an entry on each, blocks two blanks further in.

use std::collections::BTreeSet;

use super::gaps::{Gap, Remark, gap};
use super::spacing::Word;
use super::{WIDTH, table};
use crate::parse::Row;

/// Further in for each block.
const STEP: usize = 2;

/// Further in than its first line is the rest of an entry.
pub(super) const CONTINUED: usize = 4;

/// A line of the formatted text.
#[derive(Clone, Debug, Default)]
pub(super) struct Line<'t> {
    pub indent: usize,
    pub words: Vec<Word<'t>>,
    pub comment: Option<Comment<'t>>,
    /// Whether an empty line stands before it.
    pub blank_before: bool,
}

/// The comment at the end of a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Comment<'t> {
    pub text: &'t str,
    /// The blanks before it.
    pub blanks: usize,
    /// Whether a line without words goes on with the comment of the line above.
    pub continues: bool,
}

impl Line<'_> {
    /// The width without its comment.
    pub fn width(&self) -> usize {
        self.width_before(self.words.len())
    }

    /// The width of the words before the one with this number.
    pub fn width_before(&self, end: usize) -> usize {
        let words = self.words[..end].iter().enumerate();
        self.indent
            + words
                .map(|(at, word)| if at == 0 { 0 } else { word.blanks } + word.width())
                .sum::<usize>()
    }

    /// What lines up: a line that is an entry as a whole.
    pub fn row(&self) -> Option<Row> {
        let opens = self.words.last().is_some_and(|last| last.text == "{");
        self.words.first().and_then(|first| first.row).filter(|_| !opens)
    }

    fn begins_with(&self, text: &str) -> bool {
        self.words.first().is_some_and(|first| first.text == text)
    }

    fn ends_with(&self, text: &str) -> bool {
        self.words.last().is_some_and(|last| last.text == text)
    }
}

/// All lines. A block on a line that is too long is written out, and then the lines are made anew.
pub(super) fn lines<'t>(text: &'t str, words: &[Word<'t>]) -> Vec<Line<'t>> {
    let gaps: Vec<Gap<'t>> = (0..=words.len())
        .map(|at| {
            let from = at.checked_sub(1).map_or(0, |at| words[at].end());
            gap(text, from, words.get(at).map_or(text.len(), |word| word.start))
        })
        .collect();
    let mut written_out = multi_line_blocks(words, &gaps);
    loop {
        let mut builder = Builder { lines: Vec::new(), depth: Vec::new(), blank: false };
        builder.read(words, &gaps, &written_out);
        let mut lined_up = builder.lines;
        separate_blocks(&mut lined_up);
        table::line_up(&mut lined_up);
        let too_long = lined_up.iter().filter(|line| line.width() > WIDTH);
        let blocks: Vec<usize> = too_long.flat_map(|line| inline_blocks(line)).collect();
        if blocks.is_empty() {
            return lined_up;
        }
        written_out.extend(blocks);
    }
}

/// The first bytes of the blocks that open and close on a line.
fn inline_blocks(line: &Line<'_>) -> Vec<usize> {
    let (mut open, mut found) = (Vec::new(), Vec::new());
    for word in &line.words {
        match word.text {
            "{" => open.push(word.start),
            "}" => found.extend(open.pop()),
            _ => {}
        }
    }
    found
}

/// The first bytes of the blocks with a line break inside, and of all phases.
fn multi_line_blocks(words: &[Word<'_>], gaps: &[Gap<'_>]) -> BTreeSet<usize> {
    let mut open: Vec<(usize, usize)> = Vec::new();
    let mut found = BTreeSet::new();
    let mut breaks = 0;
    for (at, word) in words.iter().enumerate() {
        let is_empty =
            at > 0 && words[at - 1].text == "{" && word.text == "}" && !gaps[at].has_comments();
        breaks += usize::from(gaps[at].breaks && !is_empty);
        match word.text {
            "{" => open.push((word.start, breaks)),
            "}" => found
                .extend(open.pop().filter(|(_, before)| breaks > *before).map(|(start, _)| start)),
            _ => {}
        }
    }
    found
}

struct Builder<'t> {
    lines: Vec<Line<'t>>,
    /// For each open block whether it is written out.
    depth: Vec<bool>,
    /// Whether there was an empty line since the last one.
    blank: bool,
}

impl<'t> Builder<'t> {
    fn read(&mut self, words: &[Word<'t>], gaps: &[Gap<'t>], written_out: &BTreeSet<usize>) {
        for (at, word) in words.iter().enumerate() {
            let closes = word.text == "}" && self.depth.pop() == Some(true);
            let begins = word.row.is_some()
                && self.depth.last().is_none_or(|is_written_out| *is_written_out);
            self.remarks(
                &gaps[at],
                if closes {
                    STEP
                } else if begins {
                    0
                } else {
                    CONTINUED
                },
            );
            if closes || begins || at == 0 || gaps[at].has_comments() || self.after_opener() {
                self.begin(closes, begins);
            }
            self.blank = false;
            if let Some(line) = self.lines.last_mut() {
                line.words.push(*word);
            }
            if word.text == "{" {
                self.depth.push(written_out.contains(&word.start));
            }
        }
        self.remarks(&gaps[words.len()], 0);
    }

    fn indent(&self) -> usize {
        STEP * self.depth.iter().filter(|is_written_out| **is_written_out).count()
    }

    fn after_opener(&self) -> bool {
        self.depth.last() == Some(&true)
            && self.lines.last().is_some_and(|line| line.ends_with("{") && line.comment.is_none())
    }

    fn begin(&mut self, closes: bool, begins: bool) {
        let further = if closes || begins || self.lines.is_empty() { 0 } else { CONTINUED };
        let blank_before = begins && self.blank && !self.lines.is_empty() && !self.opened();
        self.lines.push(Line { indent: self.indent() + further, blank_before, ..Line::default() });
    }

    /// Whether the last line with words opens a block and nothing stands in it yet.
    fn opened(&self) -> bool {
        self.lines.last().is_some_and(|line| line.ends_with("{"))
    }

    /// The comments before a word, `further` in than the block around it.
    fn remarks(&mut self, gap: &Gap<'t>, further: usize) {
        let mut above = gap.behind;
        if let (Some(remark), Some(line)) = (gap.behind, self.lines.last_mut()) {
            line.comment = Some(Comment { text: remark.text, blanks: 2, continues: false });
        }
        for line in &gap.between {
            match line {
                None => (self.blank, above) = (true, None),
                Some(remark) => {
                    let continues = above.is_some_and(|above| above.column == remark.column);
                    above = above.filter(|_| continues);
                    self.comment_line(remark, continues, further);
                }
            }
        }
    }

    fn comment_line(&mut self, remark: &Remark<'t>, continues: bool, further: usize) {
        let blank_before =
            self.blank && !self.lines.is_empty() && !self.opened() && further != CONTINUED;
        let comment = Some(Comment { text: remark.text, blanks: 0, continues });
        self.lines.push(Line {
            indent: self.indent() + further,
            words: Vec::new(),
            comment,
            blank_before,
        });
        self.blank = false;
    }
}

/// Empty lines around the items of the file that are blocks; comments right above an item belong to
/// it.
fn separate_blocks(lines: &mut [Line<'_>]) {
    for at in 0..lines.len() {
        let is_item = lines[at].indent == 0;
        let goes_on = |line: &Line<'_>| line.comment.is_some_and(|comment| comment.continues);
        if is_item
            && lines[at].begins_with("}")
            && !lines[at].ends_with("{")
            && let Some(next) = lines[at + 1..].iter_mut().find(|line| !goes_on(line))
        {
            next.blank_before = true;
        }
        if is_item && lines[at].ends_with("{") && !lines[at].begins_with("}") {
            let belongs = |line: &Line<'_>| {
                line.words.is_empty()
                    && line.indent == 0
                    && line.comment.is_some_and(|it| !it.continues)
            };
            let mut first = at;
            while first > 0 && !lines[first].blank_before && belongs(&lines[first - 1]) {
                first -= 1;
            }
            lines[first].blank_before = first > 0;
        }
    }
}
