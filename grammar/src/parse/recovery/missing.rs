//! Missing words, recognised by what stands there without them: `state v 0`, `in`
//! before a range, `then` before `hold`, a comparison between two values.

use super::messages::{ErrorContext, PIECEWISE};
use crate::parse::grammar::Rule;
use crate::parse::lexical::tokens::{Kind, Token};
use crate::parse::lexical::words;
use crate::{Code, Diagnostic, Fix};

/// `word` is missing before a token.
fn missing_before(word: &str, token: &Token<'_>, help: impl Into<String>) -> Diagnostic {
    let message = format!("`{word}` is missing before `{}`", token.text);
    Diagnostic::new(
        Code::Unfinished,
        message,
        token.span(),
        format!("`{word}` should stand before this"),
    )
    .help(help)
    .fix(Fix::certain(format!("write `{word}`")).insert(token.span().start, format!("{word} ")))
}

/// Something is missing after a token.
fn missing_after(context: &ErrorContext<'_, '_>, thing: &str, token: &Token<'_>) -> Diagnostic {
    let message = format!("{thing} is missing after `{}`", token.text);
    context.example(Diagnostic::new(
        Code::Unfinished,
        message,
        token.span(),
        format!("{thing} should follow"),
    ))
}

/// `(end)` without a name before it.
pub(super) fn before_ends(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let next = context.next().filter(|next| matches!(next.text, "end" | "start"))?;
    let opens = context
        .at
        .checked_sub(2)
        .filter(|_| context.text(context.at - 1) == "(" && context.text(context.at + 1) == ")")?;
    if context.text(opens) == "(" {
        return None;
    }
    let message = format!("a name is missing before `({})`", next.text);
    let found = Diagnostic::new(Code::Unfinished, message, next.span(), "the value of what?");
    Some(found.help(format!("the value of `x` at that time is `x({})`", next.text)))
}

/// Neighbours in a jump or a setting between which something is missing, and what.
const BETWEEN: &[(&str, &[&str], &str)] = &[
    ("jump", &["on"], "a name"),
    ("on", &["falling", "rising"], "a surface"),
    ("most", &["then", "{"], "a number"),
    ("steps", &["scheme", "lagged"], "a number"),
    ("scheme", &["lagged", "steps"], "a scheme"),
    ("kernel", &["grid", "continue"], "a kernel"),
    ("=", &["steps", "kernel", "scheme"], "a value"),
];

/// A word, the one that must stand before it, and how it looks.
const PAIRS: &[(&str, &str, &str)] = &[
    ("most", "at", "write `at most 3`"),
    ("hold", "then", "write `then hold ground`, with the surface that is held after the last jump"),
];

/// What is missing between the words of a jump or a setting; those are no reserved words, so they
/// pass for names.
pub(super) fn in_header(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    if !matches!(context.word, "jump" | "method") {
        return None;
    }
    let until = (context.at + 1).min(context.region.end);
    let pairs = context.tokens[context.region.start..until].windows(2);
    for (first, second) in pairs.map(|pair| (&pair[0], &pair[1])) {
        let between =
            |row: &&(&str, &[&str], &str)| row.0 == first.text && row.1.contains(&second.text);
        if let Some((_, _, thing)) = BETWEEN.iter().find(between) {
            return Some(missing_after(context, thing, first));
        }
        if let Some((_, before, help)) =
            PAIRS.iter().find(|row| row.0 == second.text && row.1 != first.text)
        {
            return Some(missing_before(before, second, *help));
        }
    }
    word_of_setting(context)
}

/// `smooth sigma = 0.1 tanh`, `grid N = 100 2 euler (th)`
fn word_of_setting(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let next = context
        .next()
        .filter(|next| !next.begins_line && context.before().iter().any(|it| it.text == "="))?;
    let has =
        |word: &str| context.tokens[context.region.clone()].iter().any(|token| token.text == word);
    let is_name = next.kind == Kind::Word && !words::inner_words("method").contains(&next.text);
    let (word, help) = match context.text(context.region.start) {
        "smooth" if is_name && !has("kernel") => ("kernel", "write `kernel tanh`"),
        "grid" if next.text == "(" && has("scheme") => {
            ("lagged", "write `lagged (th)`, with the states taken at the old time")
        }
        "grid" if is_name && !has("scheme") => ("scheme", "write `scheme euler`"),
        "grid" if next.kind == Kind::Number && !has("steps") => ("steps", "write `steps 2`"),
        _ => return None,
    };
    Some(missing_before(word, next, help))
}

/// `state v [-1, 1]`: brackets with a comma are a range, and it needs `in`.
pub(super) fn of_range(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let is_open = |token: &Token<'_>| token.text == "[";
    let open = match context.next() {
        Some(next) if is_open(next) => context.at,
        _ => context.region.start + context.before().iter().rposition(is_open)?,
    };
    let close = open
        + context.tokens[open..context.region.end].iter().position(|token| token.text == "]")?;
    let has_comma = context.tokens[open..close].iter().any(|token| token.text == ",");
    let before = context.text(open.checked_sub(1)?);
    let declares = matches!(context.word, "param" | "free" | "time" | "state" | "control");
    if !has_comma
        || close < context.at
        || !declares
        || matches!(before, "in" | "=" | "start" | "guess")
    {
        return None;
    }
    let range: Vec<&str> = context.tokens[open..=close].iter().map(|token| token.text).collect();
    let range = range.concat().replace(',', ", ");
    let (first, last) = (&context.tokens[open], &context.tokens[close]);
    let message = "`in` is missing before a range";
    let found = Diagnostic::new(
        Code::Unfinished,
        message,
        first.span().to(last.span()),
        "`in` should stand before this",
    );
    let fix = Fix::certain("write `in`").insert(first.span().start, "in ");
    Some(found.help(format!("write `in {range}`")).fix(fix))
}

/// `state v 0`, `state v free`, `control u 0`: the word before a first value.
pub(super) fn of_value(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let next = context.next().filter(|next| !next.begins_line && context.expects(&[Rule::EOI]))?;
    let begins_value = match next.kind {
        Kind::Number => true,
        Kind::Word => next.text == "free",
        _ => matches!(next.text, "(" | "-"),
    };
    let word = match context.word {
        "state" => "start",
        "free" | "control" => "guess",
        "expect" if context.expects(&[Rule::within]) && next.kind == Kind::Number => "within",
        _ => return None,
    };
    let is_there = context.before().iter().any(|token| token.text == word);
    let help = match next.kind {
        Kind::Number | Kind::Word => format!("write `{word} {}`", next.text),
        _ => format!("write `{word}` before the value"),
    };
    (begins_value && !is_there).then(|| missing_before(word, next, help))
}

/// `w' in boost { below => ... }`, `y = { x <= 1 => ... }`: the word of a block inside an
/// expression.
pub(super) fn of_switch(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let next = context.next().filter(|next| next.text == "{")?;
    let behind = &context.tokens[context.at..context.region.end];
    if !behind.iter().any(|token| token.text == "=>") {
        return None;
    }
    let help = "two sides of a surface: `match boost { below => u, above => 3*u }`; \
                ranges of a number: `piecewise { x <= 1 => 0  otherwise => x - 1 }`";
    let is_name =
        |token: &&Token<'_>| token.kind == Kind::Word && words::reserved(token.text).is_none();
    Some(match context.text(context.at + 1) {
        "below" | "above" => missing_before("match", context.previous().filter(is_name)?, help),
        _ => missing_before("piecewise", next, help),
    })
}

const RELATIONS: &[&str] = &["<=", ">=", "==", "<", ">", "=", "!="];

/// `end x 1`, `x 1 => 0`: two values and no comparison.
pub(super) fn comparison(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let (previous, next) = (context.previous()?, context.next().filter(|next| !next.begins_line)?);
    let is_relation = |token: &Token<'_>| RELATIONS.contains(&token.text);
    let behind = &context.tokens[context.at..context.region.end];
    let guard = behind.split(|token| token.text == "=>").next().unwrap_or(behind);
    let opens = matches!(next.kind, Kind::Word | Kind::Number) || next.text == "(";
    if !opens || words::reserved(next.text).is_some() {
        return None;
    }
    let compares = guard.iter().any(is_relation);
    let begins_arm = compares || guard.iter().any(|token| token.text == "otherwise");
    match () {
        _ if context.expects(&[Rule::implies]) && begins_arm => {
            Some(missing_after(context, "`=>`", previous).help(PIECEWISE))
        }
        _ if context.expects(&[Rule::guard_relation]) && !compares => {
            Some(missing_after(context, "a comparison", previous).help(PIECEWISE))
        }
        _ if context.expects(&[Rule::relation])
            && !behind.iter().chain(context.before()).any(is_relation) =>
        {
            Some(missing_after(context, "a comparison (`<=`, `>=` or `==`)", previous))
        }
        _ => None,
    }
}

/// `metric v1: m1 v2: m2`, `columns t [s] x [m]`
pub(super) fn comma(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let (previous, next) =
        (context.previous()?, context.next().filter(|next| next.kind == Kind::Word)?);
    let is_next = match context.word {
        "metric" => context.text(context.at + 1) == ":",
        "data" | "phase" => context.expects(&[Rule::comma, Rule::column]) && !next.begins_line,
        _ => false,
    };
    is_next.then(|| missing_after(context, "`,`", previous))
}
