//! Why a region cannot be read, in our own words.
//!
//! The grammar says where it gave up and what it would have gone on with; the tokens say what
//! stands around that place. Together they choose one message: what is missing or superfluous,
//! where, and how the right form looks.

use super::{adjacent, brackets, duplicate, missing, typos, unknown};
use crate::parse::grammar::Rule;
use crate::parse::lexical::items::Region;
use crate::parse::lexical::limits::{Failure, MOST_BRACKETS, MOST_LETTERS, MOST_TOKENS};
use crate::parse::lexical::tokens::{Kind, Token};
use crate::parse::lexical::words::{self, Form};
use crate::{Code, Diagnostic, Span};

/// The place where the grammar gave up.
pub(super) struct ErrorContext<'p, 't> {
    /// All tokens of the file.
    pub tokens: &'p [Token<'t>],
    /// The region that cannot be read.
    pub region: &'p Region,
    /// The word of its item, or of the block that it is an entry of.
    pub word: &'t str,
    /// How messages speak of the region.
    pub form: Option<&'static Form>,
    /// The first token that was not understood; one past the region if it ended too early.
    pub at: usize,
    /// What the grammar would have gone on with.
    pub expected: &'p [Rule],
    /// A closing bracket behind the region that closes nothing.
    pub closer: Option<&'p Token<'t>>,
}

impl<'t> ErrorContext<'_, 't> {
    /// The first token that was not understood.
    pub fn next(&self) -> Option<&Token<'t>> {
        self.tokens[..self.region.end].get(self.at)
    }

    /// The last token that was.
    pub fn previous(&self) -> Option<&Token<'t>> {
        (self.at > self.region.start).then(|| &self.tokens[self.at - 1])
    }

    /// The text of a token, inside the region or beside it.
    pub fn text(&self, at: usize) -> &'t str {
        self.tokens.get(at).map_or("", |token| token.text)
    }

    /// The tokens of the region that stand before the place.
    pub fn before(&self) -> &[Token<'t>] {
        &self.tokens[self.region.start..self.at]
    }

    /// Whether the grammar would have gone on with one of these.
    pub fn expects(&self, rules: &[Rule]) -> bool {
        self.expected.iter().any(|rule| rules.contains(rule))
    }

    /// Whether an operand is complete, so that an operator could follow.
    pub fn after_operand(&self) -> bool {
        self.expects(&[Rule::operator, Rule::scaling, Rule::times])
    }

    /// Whether an operand should follow.
    pub fn expects_operand(&self) -> bool {
        self.expects(OPERANDS)
    }

    /// The bracket that is open at the place.
    pub fn innermost_bracket(&self) -> Option<&'t str> {
        let mut open = Vec::new();
        for token in &self.tokens[self.region.start..self.at] {
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
            _ if self.is_for_each() => diagnostic.help(EACH),
            Some(form) => {
                diagnostic.help(format!("{} looks like this: `{}`", form.noun, form.example))
            }
            None => diagnostic,
        }
    }

    /// Whether it is the head of a phase for each file.
    fn is_for_each(&self) -> bool {
        self.word == "phase" && self.before().iter().any(|token| token.text == "for")
    }
}

const EACH: &str = "a phase for each file looks like this: \
                    `phase run for each csv(\"runs*.csv\") columns t [s], x [m] { ... }`";

const OPERANDS: &[Rule] =
    &[Rule::expression, Rule::operand, Rule::negation, Rule::argument, Rule::factor, Rule::arm];

pub(super) const PIECEWISE: &str =
    "a piecewise looks like this: `piecewise { x <= 1 => 0  otherwise => x - 1 }`";
const MATCH: &str = "a match looks like this: `match boost { below => u, above => 3*u }`";

/// What can be missing, in the order in which it is looked for, and help where it is not the item's
/// own form.
#[rustfmt::skip]
const MISSING: &[(&[Rule], &str, Option<&str>)] = &[
    (&[Rule::relation], "a comparison (`<=`, `>=` or `==`)", None),
    (&[Rule::guard_relation], "a comparison", Some(PIECEWISE)),
    (&[Rule::becomes], "`=` or `in`", None),
    (&[Rule::kw_sd], "`sd` with a standard deviation", None),
    (&[Rule::kw_over], "`over` with what lies on the other axis", None),
    (&[Rule::equals], "`=`", None),
    (&[Rule::assigns], "`:=`", None),
    (&[Rule::implies], "`=>`", Some(PIECEWISE)),
    (&[Rule::arrow], "`->`", None),
    (&[Rule::kw_otherwise], "`otherwise => ...`", Some(PIECEWISE)),
    (&[Rule::kw_below], "`below => ...`", Some(MATCH)),
    (&[Rule::kw_above], "`above => ...`", Some(MATCH)),
    (&[Rule::kw_on], "`on`", None),
    (&[Rule::direction], "`falling` or `rising`", None),
    (&[Rule::kw_most], "`most`", None),
    (&[Rule::kw_hold], "`hold`", None),
    (&[Rule::kw_each], "`each`", None),
    (&[Rule::kw_csv], "`csv(\"...\")`", None),
    (&[Rule::kw_columns], "`columns`", None),
    (&[Rule::kw_sigma], "`sigma`", Some("only the smoothing is continued: `continue sigma = 0.1, \
                                         0.05, 0.025`")),
    (&[Rule::string], "a file name in quotes", None),
    (&[Rule::interval], "a range `[from, to]`", None),
    (OPERANDS, "a value", None),
    (&[Rule::derivative], "a derivative such as `x'`", None),
    (&[Rule::unit_factor, Rule::unit_name], "a unit", None),
    (&[Rule::digits, Rule::exponent], "a whole number", None),
    (&[Rule::colon], "`:`", None),
    (&[Rule::left_brace], "`{`", None),
    (&[Rule::comma], "`,`", None),
    (&[Rule::prime], "the `'` of a derivative", None),
    (&[Rule::names, Rule::left_parenthesis], "`(`", None),
    (&[Rule::name, Rule::weight, Rule::column, Rule::entry, Rule::fitted], "a name", None),
    (&[Rule::kw_in], "a range `in [from, to]`", None),
    (&[Rule::right_parenthesis], "`)`", None),
    (&[Rule::right_bracket], "`]`", None),
    (&[Rule::right_brace], "`}`", None),
];

/// One diagnostic for a region, and whether another one says it already.
pub(super) fn explain(
    tokens: &[Token<'_>],
    region: &Region,
    block: Option<&str>,
    failure: &Failure,
    closer: Option<&Token<'_>>,
) -> (Diagnostic, bool) {
    let (stopped, expected) = match failure {
        Failure::TooDeep(bracket) => return (too_many_brackets(&tokens[*bracket]), false),
        Failure::TooLong => return (too_long(&tokens[region.start]), false),
        Failure::LongWord(word) => return (long_word(&tokens[*word]), false),
        Failure::Stopped(at, expected) => (*at, expected),
    };
    let word = block.unwrap_or(tokens[region.start].text);
    let form = block.map_or_else(|| words::form(word), words::entry_form);
    let at = region.start + tokens[region.clone()].partition_point(|token| token.end() <= stopped);
    let context = ErrorContext { tokens, region, word, form, at, expected, closer };
    let is_renamed = context.next().is_some_and(|token| typos::is_renamed_elsewhere(tokens, token));
    let name = typos::reserved_name(&context).filter(|_| is_renamed);
    let is_told = is_renamed && name.is_none();
    (name.unwrap_or_else(|| reason(&context)), is_told)
}

/// What is wrong at a place: the first reason that fits, or else what is missing or superfluous.
fn reason(context: &ErrorContext<'_, '_>) -> Diagnostic {
    let reasons: &[fn(&ErrorContext<'_, '_>) -> Option<Diagnostic>] = &[
        unknown::unknown_item,
        unknown::nameless_entry,
        typos::foreign_character,
        typos::foreign_comment,
        brackets::unopened_after,
        typos::second_derivative,
        duplicate::duplicate,
        typos::wrong_sign,
        typos::reserved_name,
        missing::before_ends,
        brackets::unbalanced,
        typos::misspelt_word,
        missing::in_header,
        missing::of_range,
        missing::of_value,
        missing::of_switch,
        missing::comparison,
        missing::comma,
        adjacent::missing_operator,
        typos::wrong_range,
        typos::wrong_vector,
        typos::second_equation,
        typos::second_value,
        typos::misplaced_item,
    ];
    let reason = reasons.iter().find_map(|reason| reason(context));
    reason.or_else(|| missing(context)).unwrap_or_else(|| superfluous(context))
}

/// FDC0004, before the grammar has seen the region.
fn too_many_brackets(bracket: &Token<'_>) -> Diagnostic {
    let message = format!("more than {MOST_BRACKETS} brackets inside each other");
    Diagnostic::new(Code::TooDeep, message, bracket.span(), "one bracket more than can be read")
        .help("name the inner parts with `let` and write the expression in terms of those names")
}

/// FDC0009 for a single item.
fn too_long(first: &Token<'_>) -> Diagnostic {
    let message = format!("an item of more than {MOST_TOKENS} words and signs");
    Diagnostic::new(Code::TooLarge, message, first.span(), "this item is too long to be read").help(
        "measurements belong in a CSV file, read with `data`; long expressions fall into parts \
         with `let`",
    )
}

/// FDC0009 for a single word or number.
fn long_word(word: &Token<'_>) -> Diagnostic {
    let (what, parts, help) = match word.kind {
        Kind::Number => {
            ("number", "digits", "write it with fewer digits and an exponent, such as `1.5e20`")
        }
        _ => ("word", "letters", "choose a shorter name"),
    };
    let message = format!("a {what} of more than {MOST_LETTERS} {parts}");
    let first =
        Span::new(word.start, word.start + word.text.chars().next().map_or(0, char::len_utf8));
    Diagnostic::new(Code::TooLarge, message, first, format!("this {what} is too long to be read"))
        .help(help)
}

/// FDC0002: the region stopped too early. A parameter may end after its name, but not go on without
/// `=`.
fn missing(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    if context.expects(&[Rule::EOI])
        && !(context.expects(&[Rule::equals]) && context.next().is_some())
    {
        return None;
    }
    let (_, thing, help) = MISSING.iter().find(|(rules, ..)| context.expects(rules))?;
    let previous = context.previous()?;
    let message = format!("{thing} is missing after `{}`", previous.text);
    let diagnostic = Diagnostic::new(
        Code::Unfinished,
        message,
        previous.span(),
        format!("{thing} should follow"),
    );
    let before_previous = context.at.checked_sub(2).map_or("", |at| context.text(at));
    Some(match help {
        _ if matches!(previous.text, "below" | "above" | "match") => diagnostic.help(MATCH),
        _ if before_previous == "match" => diagnostic.help(MATCH),
        _ if previous.text == "piecewise" => diagnostic.help(PIECEWISE),
        Some(help) => diagnostic.help(*help),
        None => context.example(diagnostic),
    })
}

/// FDC0002: the region goes on after its end.
fn superfluous(context: &ErrorContext<'_, '_>) -> Diagnostic {
    let token = context.next().unwrap_or(&context.tokens[context.region.end - 1]);
    let label = match context.form {
        Some(form) => format!("{} ends before this", form.noun),
        None => "this does not belong here".to_owned(),
    };
    let message = format!("`{}` cannot stand here", token.text);
    let found = Diagnostic::new(Code::Unfinished, message, token.span(), label);
    match word_before_range(context, token) {
        Some(word) => found.help(format!("`in` and its range stand before `{word}`")),
        None => context.example(found),
    }
}

/// `start` or `guess`, if the range of a declaration stands behind it.
fn word_before_range<'t>(context: &ErrorContext<'_, 't>, token: &Token<'_>) -> Option<&'t str> {
    let before = &context.tokens[context.region.start..context.at];
    let item = before.first().filter(|it| matches!(it.text, "state" | "control" | "free"));
    let word = before.iter().find(|it| matches!(it.text, "start" | "guess"));
    word.filter(|_| item.is_some() && token.text == "in").map(|it| it.text)
}
