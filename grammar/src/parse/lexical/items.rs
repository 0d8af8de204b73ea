//! Splits a text into regions, its items and their entries, that can be parsed one by one.
//!
//! A file and a phase are split where an item word begins; a block such as `dynamics { ... }` where
//! an entry begins. Item words are reserved, so they begin an item wherever the text before them is
//! complete, and at the beginning of a line even inside brackets that somebody forgot to close.
//! `start`, `end`, `guess` and `free` also stand inside items and need a closer look. `fit`,
//! `plot`, `signal` and `at` may be names, and begin an item where no name could stand. A column of
//! data may be called as an item word.

use std::ops::Range;

use super::tokens::{Kind, Token};
use super::words;

/// Words and signs; nobody writes half as many.
const LONGEST_UNIT: usize = 100;

/// Words and signs of the time of a condition; nobody writes half as many.
const LONGEST_TIME: usize = 100;

/// Pieces are ranges of token numbers.
pub(crate) type Region = Range<usize>;

/// The items of a file, or of the inside of a phase.
pub(crate) fn items(tokens: &[Token<'_>], range: Region) -> Vec<Region> {
    cut(tokens, range, begins_item)
}

/// The entries of a block.
pub(crate) fn entries(tokens: &[Token<'_>], range: Region, block: &str) -> Vec<Region> {
    cut(tokens, range, |so_far, at| begins_entry(so_far, at, block))
}

/// The region being read: where it began and which brackets are open in it.
struct SoFar<'s, 't> {
    tokens: &'s [Token<'t>],
    head: usize,
    end: usize,
    open: Vec<&'static str>,
    /// Whether a `{` has come, and a `piecewise` or `match`.
    has_brace: bool,
    has_switch: bool,
    /// Whether it has come to the columns of a data set and not beyond them.
    in_columns: bool,
}

impl<'t> SoFar<'_, 't> {
    fn word(&self) -> &'t str {
        self.tokens[self.head].text
    }

    fn text(&self, at: usize) -> &'t str {
        if at < self.end { self.tokens[at].text } else { "" }
    }

    fn in_phase(&self) -> bool {
        self.open.first() == Some(&"}") && self.word() == "phase"
    }

    fn is_item_of_phase(&self, at: usize) -> bool {
        let is_item = words::always_begins(self.tokens[at].text) && !is_argument(self, at);
        is_item || begins_soft(self, at) || is_misspelt_item(self, at)
    }

    /// Whether the region is a block, or holds a `piecewise`, whose `{` has not come yet.
    fn lacks_brace(&self) -> bool {
        !self.has_brace && (self.has_switch || words::entry_form(self.word()).is_some())
    }

    /// Whether a word stands between the brackets of a unit, where any word may stand, and two of
    /// them side by side.
    fn is_in_unit(&self, at: usize) -> bool {
        let mut ahead = self.tokens[at..self.end].iter().take(LONGEST_UNIT);
        let is_bracket = |token: &&Token<'_>| matches!(token.kind, Kind::Open | Kind::Close);
        self.open.last() == Some(&"]")
            && ahead.find(is_bracket).is_some_and(|bracket| bracket.text == "]")
    }

    /// Whether a token belongs to the list behind `columns`.
    fn goes_on_with_columns(&self, at: usize) -> bool {
        let token = &self.tokens[at];
        let is_listed = self.open.last() == Some(&"]") || matches!(token.text, "," | "[");
        let begins = token.text == "columns" && at > self.head && self.tokens[at - 1].text == ")";
        begins || self.in_columns && (is_listed || self.follows_columns(at))
    }

    /// Whether a word stands where a column is named.
    fn follows_columns(&self, at: usize) -> bool {
        let is_word = self.tokens[at].kind == Kind::Word;
        self.in_columns && is_word && matches!(self.tokens[at - 1].text, "columns" | ",")
    }

    /// Whether a reserved word is a name: that of a column, or behind a dot.
    fn is_name_here(&self, at: usize) -> bool {
        let is_dotted =
            at > self.head && self.tokens[at - 1].text == "." && !self.tokens[at].begins_line;
        is_dotted || self.follows_columns(at)
    }

    /// Keeps account of the open brackets. A closer also closes what was left open inside its pair.
    fn track(&mut self, at: usize) {
        let token = &self.tokens[at];
        self.in_columns = self.goes_on_with_columns(at);
        self.has_brace |= token.text == "{";
        self.has_switch |= matches!(token.text, "piecewise" | "match");
        if token.kind == Kind::Open {
            self.open.push(token.closer());
        } else if token.kind == Kind::Close
            && let Some(partner) = self.open.iter().rposition(|closer| *closer == token.text)
        {
            self.open.truncate(partner);
        } else if self.in_phase() && token.begins_line && self.is_item_of_phase(at) {
            self.open.truncate(1);
        }
    }
}

fn cut(
    tokens: &[Token<'_>],
    range: Region,
    begins: impl Fn(&SoFar<'_, '_>, usize) -> bool,
) -> Vec<Region> {
    let mut regions = Vec::new();
    let (head, end) = (range.start, range.end);
    let mut so_far = SoFar {
        tokens,
        head,
        end,
        open: Vec::new(),
        has_brace: false,
        has_switch: false,
        in_columns: false,
    };
    for at in range.clone() {
        if at > so_far.head && begins(&so_far, at) {
            regions.push(so_far.head..at);
            so_far.head = at;
            so_far.open.clear();
            (so_far.has_brace, so_far.has_switch, so_far.in_columns) = (false, false, false);
        }
        so_far.track(at);
    }
    if so_far.head < range.end {
        regions.push(so_far.head..range.end);
    }
    regions
}

fn begins_item(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    let token = &so_far.tokens[at];
    let outside = so_far.open.is_empty();
    match (token.kind, words::reserved(token.text)) {
        (Kind::Close, _) => outside,
        (Kind::Open, _) if token.text == "{" && outside => is_nameless_block(so_far, at),
        (Kind::Word, _) if so_far.is_in_unit(at) || names_a_column(so_far, at) => false,
        (Kind::Word, _) if names_a_plot(so_far, at) => false,
        (Kind::Word, Some(word)) if word.item.is_some() => {
            if so_far.in_phase() {
                return token.begins_line && matches!(token.text, "phase" | "link");
            }
            let may_begin = if outside { can_begin(so_far, at) } else { token.begins_line };
            may_begin && !continues_item(so_far, at)
        }
        (Kind::Word, None) if !so_far.in_phase() => {
            begins_soft(so_far, at)
                || is_misspelt_item(so_far, at)
                || (outside && is_unknown_item(so_far, at))
        }
        _ => false,
    }
}

/// Whether what stands before could be the end of a region.
fn can_begin(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    let is_start_free = match &so_far.tokens[..at] {
        [.., start, free] => start.text == "start" && free.text == "free",
        _ => false,
    };
    so_far.tokens[at].begins_line || can_end(so_far, at - 1) || is_start_free
}

/// Whether a column is called as an item word. In an unfinished list the word begins an item: a
/// name follows, or what no list goes on with.
fn names_a_column(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    let Some(next) = so_far.tokens[..so_far.end].get(at + 1) else {
        return so_far.follows_columns(at);
    };
    let begins_next = words::always_begins(next.text) || begins_soft(so_far, at + 1);
    let ends_head = next.text == "{" && so_far.word() == "phase";
    let goes_on = matches!(next.text, "," | "[" | "}") || begins_next || ends_head;
    so_far.follows_columns(at) && (goes_on || !so_far.tokens[at].begins_line)
}

/// Whether a plot is called as an item word: `plot path:`.
fn names_a_plot(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    let follows = at > so_far.head && so_far.tokens[at - 1].text == "plot";
    follows && !so_far.tokens[at].begins_line && so_far.text(at + 1) == ":"
}

/// Whether a region may end with a token.
fn can_end(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    let token = &so_far.tokens[at];
    match token.kind {
        Kind::Word => words::reserved(token.text).is_none() || so_far.is_name_here(at),
        Kind::Sign => token.text == "'",
        Kind::Open => false,
        Kind::Number | Kind::Text | Kind::Close | Kind::Foreign => true,
    }
}

/// Whether an item word belongs to the item that is being read.
fn continues_item(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    let next = so_far.text(at + 1);
    // A misspelt item may be any.
    let item =
        |words: &[&str]| words.contains(&so_far.word()) || words::reserved(so_far.word()).is_none();
    match so_far.tokens[at].text {
        "free" => {
            (so_far.tokens[at - 1].text == "start" && !so_far.is_name_here(at - 1))
                || (item(&["state"]) && ["", "in"].contains(&next))
        }
        "guess" => item(&["free", "control"]) && next != "{",
        "start" => is_argument(so_far, at) || (item(&["state"]) && !has_relation(so_far, at)),
        "end" => is_argument(so_far, at),
        _ => false,
    }
}

/// Whether `start` or `end` stands for a time, as in `x(end)`.
fn is_argument(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    matches!(so_far.tokens[at].text, "start" | "end") && matches!(so_far.text(at + 1), ")" | ",")
}

/// Whether a comparison follows before the next item: then `start` is a condition, not a state's
/// value. The comparisons of a `piecewise` are between braces.
fn has_relation(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    let mut braces = 0;
    for (at, token) in so_far.tokens[..so_far.end].iter().enumerate().skip(at + 1) {
        match token.text {
            "{" => braces += 1,
            "}" => braces -= 1,
            "<=" | ">=" | "==" if braces == 0 => return true,
            _ if so_far.is_name_here(at) => {}
            word if words::always_begins(word) && !is_argument(so_far, at) => return false,
            _ if begins_soft(so_far, at) => return false,
            _ => {}
        }
    }
    false
}

/// Whether an item begins with a word that may be a name.
fn begins_soft(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    begins_named(so_far, at) || begins_signal(so_far, at) || begins_at(so_far, at)
}

/// `at 1.5:`, with an expression before the colon, behind a text that is complete.
fn begins_at(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    if so_far.tokens[at].text != "at" || !can_begin(so_far, at) {
        return false;
    }
    let (mut open, mut follows_value) = (0, false);
    for (count, token) in so_far.tokens[at + 1..so_far.end].iter().take(LONGEST_TIME).enumerate() {
        let is_value = matches!(token.kind, Kind::Word | Kind::Number);
        match token.text {
            ":" if open == 0 => return count > 0,
            _ if token.kind == Kind::Open => open += 1,
            _ if token.kind == Kind::Close => open -= 1,
            _ if open > 0 => {}
            "+" | "-" | "*" | "/" | "^" | "." | "'" => {}
            word if words::always_begins(word) && so_far.is_name_here(at + 1 + count) => {}
            _ if !is_value || follows_value || words::always_begins(token.text) => return false,
            _ => {}
        }
        follows_value = open == 0 && (is_value || token.kind == Kind::Close);
    }
    false
}

/// `fit obs:` and `plot path:`, of which no other item can have a part.
fn begins_named(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    let is_named = match so_far.tokens[at].text {
        "fit" => is_name(so_far, at + 1),
        "plot" => at + 1 < so_far.end && so_far.tokens[at + 1].kind == Kind::Word,
        _ => false,
    };
    is_named && so_far.text(at + 2) == ":"
}

/// `signal r =` and `signal r [m]`, outside of blocks, whose entries also begin with a name.
fn begins_signal(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    let is_in_block = so_far.open.contains(&"}") && !so_far.in_phase();
    so_far.tokens[at].text == "signal"
        && is_name(so_far, at + 1)
        && matches!(so_far.text(at + 2), "=" | "[")
        && !is_in_block
        && can_begin(so_far, at)
}

/// Whether a token is a word that may be a name.
fn is_name(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    let token = so_far.tokens[..so_far.end].get(at);
    token.is_some_and(|it| it.kind == Kind::Word && words::reserved(it.text).is_none())
}

/// Whether a line begins with nearly an item word and a name, as in `stat v`. Two names side by
/// side are never right.
fn is_misspelt_item(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    let token = &so_far.tokens[at];
    let next = so_far.tokens[..so_far.end].get(at + 1);
    token.begins_line
        && next.is_some_and(|next| {
            next.kind == Kind::Word && !next.begins_line && !words::goes_on(next.text)
        })
        && !words::inner_words(so_far.word()).contains(&token.text)
        && words::closest_item(token.text).is_some()
}

/// Whether a line begins with a name behind a text that is complete: no item goes on like that.
/// `unit v`, `dynamcs {`, `m = 2`, `x >= 0`.
fn is_unknown_item(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    let inner_words = words::inner_words(so_far.word());
    so_far.tokens[at].begins_line
        && can_end(so_far, at - 1)
        && !begins_soft(so_far, at - 1)
        && !inner_words.contains(&so_far.tokens[at - 1].text)
        && !inner_words.contains(&so_far.tokens[at].text)
        && !so_far.lacks_brace()
}

/// Whether a line begins with the brace of a block that has lost its word.
fn is_nameless_block(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    let before = &so_far.tokens[at - 1];
    let is_block = words::entry_form(so_far.word()).is_some() || matches!(so_far.word(), "phase");
    let is_switch = at.checked_sub(2).is_some_and(|at| so_far.tokens[at].text == "match");
    so_far.tokens[at].begins_line
        && can_end(so_far, at - 1)
        && !is_switch
        && (!is_block || before.text == "}")
}

fn begins_entry(so_far: &SoFar<'_, '_>, at: usize, block: &str) -> bool {
    let token = &so_far.tokens[at];
    let complete = can_end(so_far, at - 1);
    if looks_like_entry(so_far, at, block)
        && (token.begins_line || (complete && so_far.open.is_empty()))
    {
        return true;
    }
    let is_next = token.kind != Kind::Sign || loses_its_name(so_far, at);
    token.begins_line && so_far.open.is_empty() && complete && is_next
}

/// Whether a sign at the beginning of a line belongs to an entry without a name: `' = v` or, behind
/// an entry that has one, `= 2`.
fn loses_its_name(so_far: &SoFar<'_, '_>, at: usize) -> bool {
    let defines = |text: &str| matches!(text, "=" | ":=" | "in");
    let has_sign = || so_far.tokens[so_far.head..at].iter().any(|token| defines(token.text));
    match so_far.tokens[at].text {
        "'" => true,
        sign => defines(sign) && has_sign(),
    }
}

/// Whether an entry of the block certainly begins here.
fn looks_like_entry(so_far: &SoFar<'_, '_>, at: usize, block: &str) -> bool {
    let [first, second, third, fourth] = [at, at + 1, at + 2, at + 3].map(|at| so_far.text(at));
    let is_name = so_far.tokens[at].kind == Kind::Word && words::reserved(first).is_none();
    match block {
        "dynamics" => {
            is_name
                && so_far.text(at - 1) != "*"
                && (second == "'" || (second == "*" && fourth == "'"))
        }
        "guess" | "report" | "sweep" => is_name && second == "=",
        "link" if first == "same" && second != ":=" => true,
        "jump" | "link" => is_name && (second == ":=" || (second == "." && fourth == ":=")),
        "method" => {
            let is_key = is_name && second == "=" && so_far.tokens[at].begins_line;
            is_key || (["smooth", "grid", "continue"].contains(&first) && third == "=")
        }
        _ => false,
    }
}
