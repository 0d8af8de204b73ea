//! A word or a sign that stands twice: `param param m`, `in in [0, 1]`, `x = = 2`.

use super::Rule;
use super::messages::Place;
use super::tokens::{Kind, Token};
use super::words;
use crate::{Code, Diagnostic, Fix};

/// FDC0002, if the piece broke off at the second of two equal words or signs, or just behind them.
pub(super) fn doubled(place: &Place<'_, '_>) -> Option<Diagnostic> {
    let (previous, next) = (place.previous()?, place.next()?);
    if previous.text == next.text && is_repeated(place, next) {
        return Some(stands_twice(next));
    }
    // The first of the two was taken for a name.
    let first = place.at.checked_sub(2).filter(|at| *at >= place.piece.start)?;
    let swallowed = words::inner_words(place.word).contains(&previous.text);
    (place.text(first) == previous.text && swallowed).then(|| stands_twice(previous))
}

fn is_repeated(place: &Place<'_, '_>, second: &Token<'_>) -> bool {
    let behind = place.text(place.at + 1);
    match second.kind {
        Kind::Sign => second.text != "*",
        // `param time = 1` and `let a = state` are names that cannot be; `start start x` is not.
        Kind::Word if words::reserved(second.text).is_some() => {
            let is_value = ["=", "in", "[", "(", ")", ""].contains(&behind);
            let always = second.text == "in" || (second.text == "free" && place.word == "state");
            !second.begins_line && (always || !is_value || is_end(place))
        }
        Kind::Word => {
            let is_value =
                place.after_operand() || (place.expects(&[Rule::assigns]) && behind != ":=");
            !second.begins_line && !is_value
        }
        _ => false,
    }
}

/// `x(end end)`
fn is_end(place: &Place<'_, '_>) -> bool {
    matches!(place.text(place.at), "end" | "start") && place.innermost_bracket() == Some("(")
}

fn stands_twice(second: &Token<'_>) -> Diagnostic {
    let message = format!("`{}` stands twice", second.text);
    Diagnostic::new(Code::Unfinished, message, second.span(), "one is enough")
        .help(format!("remove one of the two `{}`", second.text))
        .fix(Fix::certain("remove one of the two").remove(second.span()))
}
