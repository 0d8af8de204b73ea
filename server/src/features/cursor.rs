//! Where a cursor stands, found from the text before it alone: what is being written can seldom be
//! read.

use fdcc_grammar::words;

/// An open bracket.
#[derive(Clone, Copy, Debug)]
pub struct Open<'t> {
    /// `(`, `[` or `{`
    pub bracket: char,
    /// The word or sign before it.
    pub before: &'t str,
    /// Whether it stands close to that.
    pub is_close: bool,
    /// For a brace: what it is the block of, such as `dynamics` or `piecewise`.
    pub block: &'t str,
    /// Commas inside so far.
    pub commas: usize,
}

/// What stands before a cursor.
#[derive(Clone, Debug, Default)]
pub struct CursorContext<'t> {
    /// What the word that is being written is a part of: `coast`, `pos` before `coast.pos.x`.
    pub path: Vec<&'t str>,
    /// The words and signs before that word, the last ones last.
    pub before: Vec<&'t str>,
    /// The open brackets, the innermost last.
    pub open: Vec<Open<'t>>,
    /// The word that begins the item around it.
    pub item: &'t str,
    /// The name of the phase around it.
    pub phase: Option<&'t str>,
    /// Whether nothing stands before it on its line.
    pub begins_line: bool,
    /// Whether it is inside a comment or a string.
    pub is_silent: bool,
}

impl<'t> CursorContext<'t> {
    /// Of the end of a text.
    pub fn at_end_of(text: &'t str) -> CursorContext<'t> {
        let start = text
            .rfind(|c| !is_of_word(c))
            .map_or(0, |at| at + text[at..].chars().next().map_or(1, char::len_utf8));
        // `3x` is no beginning of a name.
        let start = if text[start..].starts_with(|c: char| c.is_ascii_digit()) {
            text.len()
        } else {
            start
        };
        let mut place = CursorContext::default();
        place.read(&text[..start]);
        place.path = path(&place.before);
        place
    }

    /// The word or sign before the word that is being written, counted backwards from 0.
    pub fn back(&self, at: usize) -> &'t str {
        self.before.iter().rev().nth(at).copied().unwrap_or("")
    }

    /// The innermost open bracket.
    pub fn inside(&self) -> Option<&Open<'t>> {
        self.open.last()
    }

    /// The innermost block that is no phase, and nothing else is open in it.
    pub fn block(&self) -> Option<&'t str> {
        self.inside().filter(|it| it.bracket == '{' && it.block != "phase").map(|it| it.block)
    }

    /// Whether an item may begin here.
    pub fn is_among_items(&self) -> bool {
        self.inside().is_none_or(|it| it.bracket == '{' && it.block == "phase")
    }

    fn read(&mut self, text: &'t str) {
        let mut at = 0;
        self.begins_line = true;
        while let Some(first) = text[at..].chars().next() {
            if matches!(first, '\n' | '\r') {
                self.begins_line = true;
            }
            let length = if first.is_whitespace() || first == '\u{FEFF}' {
                first.len_utf8()
            } else {
                self.token(text, at, first)
            };
            at += length;
        }
    }

    /// Takes the token at a byte; gives its length.
    fn token(&mut self, text: &'t str, at: usize, first: char) -> usize {
        let rest = &text[at..];
        let line_end = || rest.find(['\n', '\r']);
        let length = match first {
            '#' => {
                self.is_silent = line_end().is_none();
                return line_end().unwrap_or(rest.len());
            }
            '"' => match rest[1..].find(['"', '\n']) {
                Some(end) => end + 2,
                None => {
                    self.is_silent = true;
                    rest.len()
                }
            },
            _ if is_of_word(first) => rest.find(|c| !is_of_word(c)).unwrap_or(rest.len()),
            _ => first.len_utf8(),
        };
        let word = &rest[..length];
        let is_close = !text[..at].ends_with(char::is_whitespace);
        match first {
            '(' | '[' | '{' => self.opened(first, is_close),
            ')' | ']' | '}' => self.closed(),
            ',' => self.open.iter_mut().last().into_iter().for_each(|it| it.commas += 1),
            _ => self.word(word),
        }
        self.before.push(word);
        self.begins_line = false;
        length
    }

    fn opened(&mut self, bracket: char, is_close: bool) {
        let block =
            match self.before.iter().rev().take(3).find(|it| matches!(**it, "piecewise" | "match"))
            {
                Some(word) => word,
                None => self.item,
            };
        if bracket == '{' && block == "phase" {
            let word = self.before.iter().rposition(|it| *it == "phase");
            let own = word.and_then(|at| self.before.get(at + 1)).copied();
            // What it takes over from another phase has the names of that.
            self.phase = if self.back(1) == "like" { Some(self.back(0)) } else { own };
        }
        self.open.push(Open { bracket, before: self.back(0), is_close, block, commas: 0 });
    }

    fn closed(&mut self) {
        let closed = self.open.pop();
        if closed.is_some_and(|it| it.bracket == '{' && it.block == "phase") {
            self.phase = None;
        }
    }

    /// An item begins with its word; `start`, `end`, `free` and `guess` also stand inside of
    /// others, and so do words that may be names.
    fn word(&mut self, word: &'t str) {
        let Some(known) = words::items().find(|it| it.text == word) else { return };
        let may_be_inner = !known.is_reserved || matches!(word, "start" | "end" | "free" | "guess");
        if self.is_among_items() && (self.begins_line || !may_be_inner) {
            self.item = word;
        }
    }
}

/// Whether a character may be part of a name or a number.
fn is_of_word(character: char) -> bool {
    character.is_alphanumeric() || character == '_'
}

/// `coast`, `pos` of `coast.pos.`; `run` of `run[2].`
fn path<'t>(before: &[&'t str]) -> Vec<&'t str> {
    let mut path = Vec::new();
    let mut rest = before;
    while let [outer @ .., name, "[", _, "]", "."] | [outer @ .., name, "."] = rest {
        if !name.starts_with(|c: char| c.is_alphabetic() || c == '_') {
            break;
        }
        path.insert(0, *name);
        rest = outer;
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_told_by_what_stands_before_it() {
        let place = CursorContext::at_end_of("state x start 0 # [\ndynamics {\n  x' = si");
        assert_eq!((place.block(), place.back(0)), (Some("dynamics"), "="));
        let place = CursorContext::at_end_of("phase boost {\n  state h start 0\n  end coast.pos.");
        assert_eq!(
            (place.path.clone(), place.phase, place.item),
            (vec!["coast", "pos"], Some("boost"), "end")
        );
        let place = CursorContext::at_end_of(
            "phase run for each csv(\"a*.csv\") columns t [s], x [m] {\n  fit run: run[2].",
        );
        assert_eq!((place.path.clone(), place.phase), (vec!["run"], Some("run")));
        let place = CursorContext::at_end_of("let a = f(1, g(2), ");
        assert_eq!(place.inside().map(|it| (it.before, it.commas)), Some(("f", 2)));
        assert!(CursorContext::at_end_of("param a = 1 # abo").is_silent);
        assert!(CursorContext::at_end_of("param a = 1\npa").begins_line);
    }
}
