//! FDC0005 and its like: a line that begins with a word which introduces nothing, and an entry
//! without its name.

use super::messages::ErrorContext;
use crate::parse::lexical::tokens::Kind;
use crate::parse::lexical::words;
use crate::{Code, Diagnostic, Fix};

/// FDC0005: a line that begins with a word which introduces nothing.
pub(super) fn unknown_item(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let first = &context.tokens[context.region.start];
    if context.form.is_some() || context.at != context.region.start {
        return None;
    }
    if first.text == "{" {
        let found = Diagnostic::new(
            Code::UnknownItem,
            "a block without its word",
            first.span(),
            "which block is it?",
        );
        return Some(
            found.help(
                "a block begins with its word, such as `dynamics {`, `guess {` or `method {`",
            ),
        );
    }
    if first.kind != Kind::Word {
        return None;
    }
    let message = format!("`{}` does not begin an item", first.text);
    let (label, help) = meant(context, first.text);
    let found = Diagnostic::new(Code::UnknownItem, message, first.span(), label).help(help);
    let next =
        context.tokens[..context.region.end].get(context.at + 1).map_or("", |token| token.text);
    Some(match words::closest_item(first.text).filter(|_| !DEFINES.contains(&next)) {
        Some(word) => {
            found.fix(Fix::certain(format!("write `{word}`")).replace(first.span(), word))
        }
        None => found,
    })
}

/// Signs that say more than the likeness of a word: `min = 2` is no objective.
const DEFINES: &[&str] = &["'", "=", ":="];

/// Label and help, by what follows the word.
fn meant(context: &ErrorContext<'_, '_>, word: &str) -> (String, String) {
    let next = if context.region.len() > 1 { context.text(context.region.start + 1) } else { "" };
    let which = || "which kind of item is it?".to_owned();
    let relations = ["<=", ">=", "==", "<", ">"];
    let has = |signs: &[&str]| {
        context.tokens[context.region.clone()].iter().any(|it| signs.contains(&it.text))
    };
    match (words::closest_item(word), next) {
        (_, "'") => ("an equation outside `dynamics`".into(), format!("write `dynamics {{ {word}' \
            = ... }}`")),
        (_, "=") => (which(), format!("write `let {word} = ...` for an expression, `param {word} = \
                                       ...` for a number")),
        (_, ":=") => ("an assignment outside `jump` and `link`".into(), format!("write `let {word} \
            = ...` for a definition")),
        (Some(meant), _) => (format!("did you mean `{meant}`?"), format!("change `{word}` to \
            `{meant}`")),
        (_, "->") => (which(), format!("write `link {word} -> ...`")),
        (_, "on") => (which(), format!("write `jump {word} on ...`")),
        (_, "{") => (which(), format!("write `phase {word} {{ ... }}` for a phase")),
        (_, ":") if has(&relations) => (which(), format!("write `path {word}: ...` for a condition \
                                                          with a name")),
        (_, ":") => (which(), format!("write `metric {word}: ...` for a weight")),
        (_, "(") if has(&["="]) => (which(), format!("write `fn {word}(...) = ...` for a \
                                                      function")),
        (_, "(") if has(&["start"]) => (which(), format!("write `state {word}(...) start ...`")),
        (_, "[") if has(&["="]) => (which(), format!("write `let {word} [...] = ...` for an \
                                                      expression")),
        (_, "[") if has(&["start"]) => (which(), format!("write `state {word} [...] start ...`")),
        (_, "[") if has(&["in"]) => (which(), format!("write `control {word} [...] in ...` for a \
                                                       control")),
        (_, "in") => (which(), format!("write `control {word} in ...`, `free {word} in ...` or \
                                        `time {word} in ...`")),
        (_, "start") => (which(), format!("write `state {word} start ...`")),
        _ if has(&relations) => {
            ("a condition: at which time?".into(), "begin with `path` for all times, `start` or \
                                                    `end` for one".into())
        }
        _ => (
            "no item begins with this word".into(),
            "an item begins with a word such as `param`, `state`, `control`, `dynamics`, `path` or \
             `minimize`".into(),
        ),
    }
}

/// FDC0002: an entry of a block that begins with the sign behind its name: `' = v`, `= 2`, `:= 3`.
pub(super) fn nameless_entry(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let first =
        context.next().filter(|_| context.at == context.region.start && context.form.is_some())?;
    if !["'", "=", ":="].contains(&first.text) {
        return None;
    }
    let message = format!("a name is missing before `{}`", first.text);
    let found =
        Diagnostic::new(Code::Unfinished, message, first.span(), "a name should stand before this");
    Some(context.example(found))
}
