//! A quick reading of a text into words, numbers, brackets and signs, without any grammar.
//!
//! The grammar reads what is right. Tokens are for what is wrong: where a broken item ends, which
//! bracket has no partner, what stands before and after the place where the grammar gave up.

use crate::Span;
use pest::unicode::{XID_CONTINUE, XID_START};

/// What a token looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Word,
    Number,
    Text,
    Open,
    Close,
    Sign,
    /// A character that the language does not use, such as `;`.
    Foreign,
}

/// One token.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Token<'t> {
    pub kind: Kind,
    pub text: &'t str,
    pub start: usize,
    /// Whether it is the first of its line.
    pub begins_line: bool,
}

impl Token<'_> {
    /// One past its last byte.
    pub fn end(&self) -> usize {
        self.start + self.text.len()
    }

    /// Where it stands.
    pub fn span(&self) -> Span {
        Span::new(self.start, self.end())
    }

    /// The bracket that this one would close.
    pub fn opener(&self) -> &'static str {
        match self.text {
            ")" => "(",
            "]" => "[",
            _ => "{",
        }
    }

    /// The bracket that would close this one.
    pub fn closer(&self) -> &'static str {
        match self.text {
            "(" => ")",
            "[" => "]",
            _ => "}",
        }
    }
}

const TWO_CHARACTER_SIGNS: &[&str] = &["<=", ">=", "==", "=>", ":=", "->", "!=", "**", "&&", "||"];

/// All tokens of a text.
pub(crate) fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let (mut at, mut begins_line) = (0, true);
    while let Some(first) = text[at..].chars().next() {
        if first == '\n' || first == '\r' {
            begins_line = true;
        }
        if is_blank(first) {
            at += first.len_utf8();
        } else if first == '#' {
            at += text[at..].find(['\n', '\r']).unwrap_or(text.len() - at);
        } else {
            let (kind, length) = token_at(&text[at..], first);
            tokens.push(Token { kind, text: &text[at..at + length], start: at, begins_line });
            begins_line = false;
            at += length;
        }
    }
    tokens
}

/// The places of all comments, from `#` to the end of the line.
pub fn comments(text: &str) -> Vec<Span> {
    let mut found = Vec::new();
    let mut from = 0;
    let ends = tokens(text).into_iter().map(|token| (token.start, token.end()));
    for (start, end) in ends.chain([(text.len(), text.len())]) {
        while let Some(at) = text[from..start].find('#').map(|at| from + at) {
            from = text[at..start].find(['\n', '\r']).map_or(start, |length| at + length);
            found.push(Span::new(at, at + text[at..from].trim_end().len()));
        }
        from = end;
    }
    found
}

/// What the grammar calls WHITESPACE.
fn is_blank(character: char) -> bool {
    matches!(character, ' ' | '\t' | '\n' | '\r' | '\u{FEFF}' | '\u{A0}')
}

/// Kind and length in bytes of the token that a text begins with.
fn token_at(text: &str, first: char) -> (Kind, usize) {
    let second_is_digit = text[first.len_utf8()..].starts_with(|c: char| c.is_ascii_digit());
    match first {
        '(' | '[' | '{' => (Kind::Open, 1),
        ')' | ']' | '}' => (Kind::Close, 1),
        '"' => string_length(text).map_or((Kind::Foreign, 1), |length| (Kind::Text, length)),
        '0'..='9' => (Kind::Number, number_length(text)),
        '.' if second_is_digit => (Kind::Number, number_length(text)),
        _ if XID_START(first) || first == '_' => (Kind::Word, word_length(text)),
        _ if TWO_CHARACTER_SIGNS.iter().any(|sign| text.starts_with(sign)) => (Kind::Sign, 2),
        '+' | '-' | '*' | '/' | '^' | '=' | '<' | '>' | ',' | ':' | '.' | '\'' => (Kind::Sign, 1),
        _ => (Kind::Foreign, first.len_utf8()),
    }
}

fn word_length(text: &str) -> usize {
    // As in the grammar.
    let continues = |c: char| XID_CONTINUE(c) && c != '·';
    text.find(|c: char| !continues(c)).unwrap_or(text.len())
}

/// The length of a string with its quotes, if it ends on its line.
fn string_length(text: &str) -> Option<usize> {
    let end = 1 + text[1..].find(['"', '\n', '\r'])?;
    text[end..].starts_with('"').then_some(end + 1)
}

/// The length of `12`, `1.5`, `.5`, `1e-3`.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits =
        |from: usize| from + bytes[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            return exponent;
        }
    }
    end
}
