//! Two values side by side: FDC0001, the most common slip of people who write formulas.

use super::messages::ErrorContext;
use crate::parse::grammar::Rule;
use crate::parse::lexical::tokens::{Kind, Token};
use crate::parse::lexical::words;
use crate::{Code, Diagnostic, Fix, Span};

/// FDC0001, if two values stand side by side on one line.
pub(super) fn missing_operator(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let (previous, next) = (context.previous()?, context.next()?);
    let in_range = context.expects(&[Rule::comma]) && context.innermost_bracket() == Some("[");
    let before_derivative = context.expects(&[Rule::prime]) && context.text(context.at + 1) == "'";
    if !(context.after_operand() || before_derivative)
        || next.begins_line
        || !begins_value(next)
        || in_range
    {
        return None;
    }
    let special = || bare_unit(context).or_else(|| foreign_choice(previous));
    if let Some(found) = special().or_else(|| no_colon(context)) {
        return Some(found);
    }
    let (left, right) = (value_before(context), value_after(context));
    let (first, last) = (&context.tokens[left], &context.tokens[right]);
    let [left, right] =
        [short(context, left, context.at - 1, previous), short(context, context.at, right, next)];
    let message = format!("missing operator between `{left}` and `{right}`");
    let comma = if context.innermost_bracket() == Some("(") || context.word == "sweep" {
        "; a comma parts two values"
    } else {
        ""
    };
    let help = format!(
        "write `{left} * {right}` or `{left} / {right}`; fdc has no implicit multiplication{comma}"
    );
    let span = first.span().to(last.span());
    let between = Span { start: previous.span().end, end: next.span().start };
    let fix = Fix::likely("write `*`").replace(between, " * ");
    Some(
        Diagnostic::new(Code::MissingOperator, message, span, "two values side by side")
            .help(help)
            .fix(fix),
    )
}

/// `at 1.5 x <= 3`: two values before any colon.
fn no_colon(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let before = &context.tokens[context.region.start..context.at];
    if context.word != "at" || before.iter().any(|token| token.text == ":") {
        return None;
    }
    let previous = context.previous()?;
    let message = format!("`:` is missing after `{}`", previous.text);
    let fix = Fix::certain("write `:`").insert(previous.span().end, ":");
    let found = Diagnostic::new(Code::Unfinished, message, previous.span(), "`:` should follow");
    Some(found.help("a condition at a time looks like this: `at 1.5: x <= 3`").fix(fix))
}

/// `param l = 50 cm`: what follows the number of a declaration to the end of its line is most
/// likely a unit.
fn bare_unit(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let (number, first) = (context.previous()?, context.next()?);
    let is_declared = matches!(context.word, "param" | "const")
        && context.at.checked_sub(2).is_some_and(|at| context.text(at) == "=");
    if !is_declared || number.kind != Kind::Number || first.kind != Kind::Word {
        return None;
    }
    let rest = context.tokens[context.at + 1..].iter().take_while(|token| !token.begins_line);
    let rest: Vec<&Token<'_>> = rest.collect();
    let is_unit = |token: &&Token<'_>| {
        matches!(token.kind, Kind::Word | Kind::Number)
            || matches!(token.text, "/" | "*" | "^" | "-")
    };
    if !rest.iter().all(is_unit) || rest.iter().any(|token| words::reserved(token.text).is_some()) {
        return None;
    }
    let last = rest.last().map_or(first.span(), |token| token.span());
    let span = first.span().to(last);
    let fix = Fix::likely("put the unit in brackets").insert(span.start, "[").insert(span.end, "]");
    let message = format!("missing brackets around the unit of `{}`", number.text);
    let unit = rest.iter().fold(first.text.to_owned(), |unit, token| {
        let blank = if token.kind == Kind::Word && unit.ends_with(char::is_alphanumeric) {
            " "
        } else {
            ""
        };
        unit + blank + token.text
    });
    let help = format!("a unit stands in brackets: `{} [{unit}]`", number.text);
    Some(
        Diagnostic::new(Code::MissingOperator, message, span, "meant as a unit?")
            .help(help)
            .fix(fix),
    )
}

/// `if x > 0 then a else b`: a choice as other languages write it.
fn foreign_choice(word: &Token<'_>) -> Option<Diagnostic> {
    if !matches!(word.text, "if" | "If" | "IF") {
        return None;
    }
    let message = format!("`{}` has no meaning in fdc", word.text);
    let help = "write `piecewise { x <= 0 => a  otherwise => b }`; where the right side of an \
                equation jumps, declare a `surface` and `match` on it";
    Some(Diagnostic::new(Code::Unfinished, message, word.span(), "meant as a choice?").help(help))
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
fn value_before(context: &ErrorContext<'_, '_>) -> usize {
    let mut first = context.at - 1;
    if context.tokens[first].kind == Kind::Close {
        first = partner(context, first, -1).unwrap_or(first);
    }
    let before = |back: usize| {
        first
            .checked_sub(back)
            .filter(|at| *at >= context.region.start)
            .map(|at| &context.tokens[at])
    };
    let is_call = context.tokens[first].kind == Kind::Open && before(1).is_some_and(begins_value);
    let is_part =
        before(1).is_some_and(|token| token.text == ".") && before(2).is_some_and(begins_value);
    first - usize::from(is_call) - 2 * usize::from(is_part)
}

/// The last token of the value that begins at the place.
fn value_after(context: &ErrorContext<'_, '_>) -> usize {
    let opens = |at: usize| at < context.region.end && context.tokens[at].text == "(";
    let mut last = context.at;
    while context.tokens[..context.region.end].get(last + 1).is_some_and(|token| token.text == ".")
    {
        last = (last + 2).min(context.region.end - 1);
    }
    let open = if opens(last) { Some(last) } else { Some(last + 1).filter(|at| opens(*at)) };
    open.and_then(|open| partner(context, open, 1)).unwrap_or(last)
}

/// The other bracket of a pair inside the region.
fn partner(context: &ErrorContext<'_, '_>, from: usize, step: isize) -> Option<usize> {
    let (mut depth, mut at) = (0_isize, from);
    loop {
        match context.tokens[at].kind {
            Kind::Open => depth += 1,
            Kind::Close => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(at);
        }
        at = at.checked_add_signed(step).filter(|at| context.region.contains(at))?;
    }
}

/// The text of a range of tokens if it fits into a sentence, or else of one of them.
fn short(
    context: &ErrorContext<'_, '_>,
    first: usize,
    last: usize,
    otherwise: &Token<'_>,
) -> String {
    const LONGEST: usize = 12;
    let tokens = &context.tokens[first..=last];
    if tokens.len() > LONGEST {
        return otherwise.text.to_owned();
    }
    tokens.iter().map(|token| token.text).collect()
}
