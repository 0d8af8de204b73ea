//! A word or a sign that stands twice: `param param m`, `in in [0, 1]`, `x = = 2`.

use super::messages::ErrorContext;
use crate::parse::grammar::Rule;
use crate::parse::lexical::tokens::{Kind, Token};
use crate::parse::lexical::words;
use crate::{Code, Diagnostic, Fix};

/// FDC0002, if the region broke off at the second of two equal words or signs, or just behind them.
pub(super) fn duplicate(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let (previous, next) = (context.previous()?, context.next()?);
    if previous.text == next.text && is_repeated(context, next) {
        return Some(stands_twice(next));
    }
    // The first of the two was taken for a name.
    let first = context.at.checked_sub(2).filter(|at| *at >= context.region.start)?;
    let swallowed = words::inner_words(context.word).contains(&previous.text);
    (context.text(first) == previous.text && swallowed).then(|| stands_twice(previous))
}

fn is_repeated(context: &ErrorContext<'_, '_>, second: &Token<'_>) -> bool {
    let behind = context.text(context.at + 1);
    match second.kind {
        Kind::Sign => second.text != "*",
        // `param time = 1` and `let a = state` are names that cannot be; `start start x` is not.
        Kind::Word if words::reserved(second.text).is_some() => {
            let is_value = ["=", "in", "[", "(", ")", ""].contains(&behind);
            let always = second.text == "in" || (second.text == "free" && context.word == "state");
            !second.begins_line && (always || !is_value || is_end(context))
        }
        Kind::Word => {
            let is_value =
                context.after_operand() || (context.expects(&[Rule::assigns]) && behind != ":=");
            !second.begins_line && !is_value
        }
        _ => false,
    }
}

/// `x(end end)`
fn is_end(context: &ErrorContext<'_, '_>) -> bool {
    matches!(context.text(context.at), "end" | "start") && context.innermost_bracket() == Some("(")
}

fn stands_twice(second: &Token<'_>) -> Diagnostic {
    let message = format!("`{}` stands twice", second.text);
    Diagnostic::new(Code::Unfinished, message, second.span(), "one is enough")
        .help(format!("remove one of the two `{}`", second.text))
        .fix(Fix::certain("remove one of the two").remove(second.span()))
}
