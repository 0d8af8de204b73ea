//! Why a piece cannot be read, in our own words.
//!
//! The grammar says where it gave up and what it would have gone on with; the tokens say what stands around that
//! place. Together they choose one message: what is missing or superfluous, where, and how the right form looks.

use super::cut::Piece;
use super::limits::{Failure, MOST_BRACKETS, MOST_TOKENS};
use super::tokens::{Kind, Token};
use super::words::{self, Form};
use super::{Rule, slips};
use crate::{Code, Diagnostic};

/// The place where the grammar gave up.
pub(super) struct Place<'p, 't> {
    /// All tokens of the file.
    pub tokens: &'p [Token<'t>],
    /// The piece that cannot be read.
    pub piece: &'p Piece,
    /// The word of its item, or of the block that it is an entry of.
    pub word: &'t str,
    /// How messages speak of the piece.
    pub form: Option<&'static Form>,
    /// The first token that was not understood; one past the piece if it ended too early.
    pub at: usize,
    /// What the grammar would have gone on with.
    pub expected: &'p [Rule],
}

impl<'t> Place<'_, 't> {
    /// The first token that was not understood.
    pub fn next(&self) -> Option<&Token<'t>> {
        self.tokens[..self.piece.end].get(self.at)
    }

    /// The last token that was.
    pub fn previous(&self) -> Option<&Token<'t>> {
        (self.at > self.piece.start).then(|| &self.tokens[self.at - 1])
    }

    /// Whether the grammar would have gone on with one of these.
    pub fn expects(&self, rules: &[Rule]) -> bool {
        self.expected.iter().any(|rule| rules.contains(rule))
    }

    /// Whether an operand is complete, so that an operator could follow.
    pub fn after_operand(&self) -> bool {
        self.expects(&[Rule::operator, Rule::scaling])
    }

    /// Whether an operand should follow.
    pub fn expects_operand(&self) -> bool {
        self.expects(OPERANDS)
    }

    /// The bracket that is open at the place.
    fn innermost_bracket(&self) -> Option<&'t str> {
        let mut open = Vec::new();
        for token in &self.tokens[self.piece.start..self.at] {
            match token.kind {
                Kind::Open => open.push(token.text),
                Kind::Close => drop(open.pop()),
                _ => {}
            }
        }
        open.pop()
    }

    /// The right form, as help.
    pub fn example(&self, diagnostic: Diagnostic) -> Diagnostic {
        match self.form {
            Some(form) => diagnostic.help(format!("{} looks like this: `{}`", form.noun, form.example)),
            None => diagnostic,
        }
    }
}

const OPERANDS: &[Rule] = &[Rule::expression, Rule::operand, Rule::negation, Rule::argument, Rule::factor, Rule::arm];

const PIECEWISE: &str = "a piecewise looks like this: `piecewise { x <= 1 => 0  otherwise => x - 1 }`";
const MATCH: &str = "a match looks like this: `match boost { below => u, above => 3*u }`";

/// What can be missing, in the order in which it is looked for, and help where it is not the item's own form.
#[rustfmt::skip]
const MISSING: &[(&[Rule], &str, Option<&str>)] = &[
    (&[Rule::relation], "a comparison (`<=`, `>=` or `==`)", None),
    (&[Rule::guard_relation], "a comparison", Some(PIECEWISE)),
    (&[Rule::becomes], "`=` or `in`", None),
    (&[Rule::equals], "`=`", None),
    (&[Rule::assigns], "`:=`", None),
    (&[Rule::implies], "`=>`", Some(PIECEWISE)),
    (&[Rule::arrow], "`->`", None),
    (&[Rule::kw_otherwise], "`otherwise => ...`", Some(PIECEWISE)),
    (&[Rule::kw_below], "`below => ...`", Some(MATCH)),
    (&[Rule::kw_above], "`above => ...`", Some(MATCH)),
    (&[Rule::kw_on], "`on` and a surface", None),
    (&[Rule::direction], "`falling` or `rising`", None),
    (&[Rule::kw_most], "`most`", None),
    (&[Rule::kw_hold], "`hold`", None),
    (&[Rule::kw_csv], "`csv(\"...\")`", None),
    (&[Rule::kw_columns], "`columns` and their names", None),
    (&[Rule::kw_sigma], "`sigma`", Some("only the smoothing is continued: `continue sigma = 0.1, 0.05, 0.025`")),
    (&[Rule::string], "a file name in quotes", None),
    (&[Rule::interval], "a range `[from, to]`", None),
    (OPERANDS, "a value", None),
    (&[Rule::derivative], "a derivative such as `x'`", None),
    (&[Rule::unit_factor, Rule::unit_name], "a unit", None),
    (&[Rule::exponent], "a whole number", None),
    (&[Rule::colon], "`:`", None),
    (&[Rule::comma], "`,`", None),
    (&[Rule::prime], "the `'` of a derivative", None),
    (&[Rule::names, Rule::left_parenthesis], "`(`", None),
    (&[Rule::left_brace], "`{`", None),
    (&[Rule::name, Rule::weight, Rule::column, Rule::entry], "a name", None),
    (&[Rule::kw_in], "a range `in [from, to]`", None),
    (&[Rule::right_parenthesis], "`)`", None),
    (&[Rule::right_bracket], "`]`", None),
    (&[Rule::right_brace], "`}`", None),
];

/// One diagnostic for a piece; none where another one has said it already.
pub(super) fn explain(
    tokens: &[Token<'_>],
    piece: &Piece,
    block: Option<&str>,
    failure: &Failure,
) -> Option<Diagnostic> {
    let (stopped, expected) = match failure {
        Failure::TooDeep(bracket) => return Some(too_many_brackets(&tokens[*bracket])),
        Failure::TooLong => return Some(too_long(&tokens[piece.start])),
        Failure::Stopped(at, expected) => (*at, expected),
    };
    let word = block.unwrap_or(tokens[piece.start].text);
    let form = block.map_or_else(|| words::form(word), words::entry_form);
    let at = piece.start + tokens[piece.clone()].partition_point(|token| token.end() <= stopped);
    let place = Place { tokens, piece, word, form, at, expected };
    if place.next().is_some_and(|token| slips::is_renamed_elsewhere(tokens, token)) {
        return slips::reserved_name(&place);
    }
    let reasons: &[fn(&Place<'_, '_>) -> Option<Diagnostic>] = &[
        slips::unknown_item,
        slips::foreign_character,
        slips::reserved_name,
        slips::wrong_sign,
        unbalanced,
        slips::misspelt_word,
        missing_operator,
        slips::second_derivative,
        slips::wrong_range,
        slips::wrong_vector,
        slips::misplaced_item,
    ];
    let reason = reasons.iter().find_map(|reason| reason(&place));
    Some(reason.or_else(|| missing(&place)).unwrap_or_else(|| superfluous(&place)))
}

/// FDC0004, before the grammar has seen the piece.
fn too_many_brackets(bracket: &Token<'_>) -> Diagnostic {
    let message = format!("more than {MOST_BRACKETS} brackets inside each other");
    Diagnostic::new(Code::TooDeep, message, bracket.span(), "one bracket more than can be read")
        .help("name the inner parts with `let` and write the expression in terms of those names")
}

/// FDC0009 for a single item.
fn too_long(first: &Token<'_>) -> Diagnostic {
    let message = format!("an item of more than {MOST_TOKENS} words and signs");
    Diagnostic::new(Code::TooLarge, message, first.span(), "this item is too long to be read")
        .help("measurements belong in a CSV file, read with `data`; long expressions fall into parts with `let`")
}

/// FDC0001: two values side by side on one line.
fn missing_operator(place: &Place<'_, '_>) -> Option<Diagnostic> {
    let (previous, next) = (place.previous()?, place.next()?);
    let in_range = place.expects(&[Rule::comma]) && place.innermost_bracket() == Some("[");
    if !place.after_operand() || next.begins_line || !begins_value(next) || in_range {
        return None;
    }
    let (left, right) = (value_before(place), value_after(place));
    let (first, last) = (&place.tokens[left], &place.tokens[right]);
    let [left, right] = [short(place, left, place.at - 1, previous), short(place, place.at, right, next)];
    let message = format!("missing operator between `{left}` and `{right}`");
    let help = format!("write `{left} * {right}` or `{left} / {right}`; fdc has no implicit multiplication");
    let span = first.span().to(last.span());
    Some(Diagnostic::new(Code::MissingOperator, message, span, "two values side by side").help(help))
}

fn begins_value(token: &Token<'_>) -> bool {
    match token.kind {
        Kind::Word => words::reserved(token.text).is_none(),
        Kind::Number => true,
        Kind::Open => token.text == "(",
        _ => false,
    }
}

/// The first token of the value that ends before the place: `sin(x)`, `pos.x`, `(a + b)`, `3`.
fn value_before(place: &Place<'_, '_>) -> usize {
    let mut first = place.at - 1;
    if place.tokens[first].kind == Kind::Close {
        first = partner(place, first, -1).unwrap_or(first);
    }
    let before = |back: usize| first.checked_sub(back).filter(|at| *at >= place.piece.start).map(|at| &place.tokens[at]);
    let is_call = place.tokens[first].kind == Kind::Open && before(1).is_some_and(begins_value);
    let is_part = before(1).is_some_and(|token| token.text == ".") && before(2).is_some_and(begins_value);
    first - usize::from(is_call) - 2 * usize::from(is_part)
}

/// The last token of the value that begins at the place.
fn value_after(place: &Place<'_, '_>) -> usize {
    let opens = |at: usize| at < place.piece.end && place.tokens[at].text == "(";
    let mut last = place.at;
    while place.tokens[..place.piece.end].get(last + 1).is_some_and(|token| token.text == ".") {
        last = (last + 2).min(place.piece.end - 1);
    }
    let open = if opens(last) { Some(last) } else { Some(last + 1).filter(|at| opens(*at)) };
    open.and_then(|open| partner(place, open, 1)).unwrap_or(last)
}

/// The other bracket of a pair inside the piece.
fn partner(place: &Place<'_, '_>, from: usize, step: isize) -> Option<usize> {
    let (mut depth, mut at) = (0_isize, from);
    loop {
        match place.tokens[at].kind {
            Kind::Open => depth += 1,
            Kind::Close => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(at);
        }
        at = at.checked_add_signed(step).filter(|at| place.piece.contains(at))?;
    }
}

/// The text of a range of tokens if it fits into a sentence, or else of one of them.
fn short(place: &Place<'_, '_>, first: usize, last: usize, otherwise: &Token<'_>) -> String {
    const LONGEST: usize = 12;
    let tokens = &place.tokens[first..=last];
    if tokens.len() > LONGEST {
        return otherwise.text.to_owned();
    }
    tokens.iter().map(|token| token.text).collect()
}

/// FDC0006: a bracket without its partner.
fn unbalanced(place: &Place<'_, '_>) -> Option<Diagnostic> {
    let mut open: Vec<&Token<'_>> = Vec::new();
    for token in &place.tokens[place.piece.clone()] {
        match token.kind {
            Kind::Open => open.push(token),
            Kind::Close => match open.pop() {
                Some(opener) if opener.closer() == token.text => {}
                Some(opener) => return Some(mismatched(opener, token)),
                None => return Some(unopened(token)),
            },
            _ => {}
        }
    }
    open.last().map(|opener| unclosed(opener))
}

fn unclosed(opener: &Token<'_>) -> Diagnostic {
    let message = format!("`{}` is never closed", opener.text);
    Diagnostic::new(Code::Unclosed, message, opener.span(), "opened here")
        .help(format!("add `{}` where it should end", opener.closer()))
}

fn mismatched(opener: &Token<'_>, closer: &Token<'_>) -> Diagnostic {
    let message = format!("`{}` is closed by `{}`", opener.text, closer.text);
    Diagnostic::new(Code::Unclosed, message, opener.span(), "opened here")
        .label(closer.span(), format!("`{}` should come first", opener.closer()))
        .help(format!("add `{}` where it should end", opener.closer()))
}

fn unopened(closer: &Token<'_>) -> Diagnostic {
    let message = format!("`{}` closes nothing", closer.text);
    Diagnostic::new(Code::Unclosed, message, closer.span(), "nothing is open here")
        .help("remove it, or open its partner before")
}

/// FDC0002: the piece stopped too early. A parameter may end after its name, but not go on without `=`.
fn missing(place: &Place<'_, '_>) -> Option<Diagnostic> {
    if place.expects(&[Rule::EOI]) && !(place.expects(&[Rule::equals]) && place.next().is_some()) {
        return None;
    }
    let (_, thing, help) = MISSING.iter().find(|(rules, ..)| place.expects(rules))?;
    let previous = place.previous()?;
    let message = format!("{thing} is missing after `{}`", previous.text);
    let diagnostic = Diagnostic::new(Code::Unfinished, message, previous.span(), format!("{thing} should follow"));
    Some(match help {
        Some(help) => diagnostic.help(*help),
        None => place.example(diagnostic),
    })
}

/// FDC0002: the piece goes on after its end.
fn superfluous(place: &Place<'_, '_>) -> Diagnostic {
    let token = place.next().unwrap_or(&place.tokens[place.piece.end - 1]);
    let label = match place.form {
        Some(form) => format!("{} ends before this", form.noun),
        None => "this does not belong here".to_owned(),
    };
    let message = format!("`{}` cannot stand here", token.text);
    place.example(Diagnostic::new(Code::Unfinished, message, token.span(), label))
}
