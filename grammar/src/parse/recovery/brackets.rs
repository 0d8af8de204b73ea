//! Brackets without a partner: FDC0006.

use super::messages::ErrorContext;
use crate::parse::grammar::Rule;
use crate::parse::lexical::tokens::{Kind, Token};
use crate::parse::lexical::words;
use crate::{Code, Diagnostic, Fix, Span};

/// FDC0006, if a bracket of the region has no partner.
pub(super) fn unbalanced(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let mut open: Vec<&Token<'_>> = Vec::new();
    for token in &context.tokens[context.region.clone()] {
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
    open.last().map(|opener| unclosed(opener, context.tokens[context.region.end - 1].span()))
}

/// FDC0006, if a bracket closes behind the region what was not opened in it: `state v m] start 0`.
pub(super) fn unopened_after(context: &ErrorContext<'_, '_>) -> Option<Diagnostic> {
    let closer = context.closer?;
    let opens = match closer.text {
        "}" => &[Rule::left_brace][..],
        ")" => &[Rule::left_parenthesis, Rule::names],
        _ => &[],
    };
    if context.expects(opens) && !context.expects(&[Rule::EOI]) {
        return None;
    }
    let begins = |token: &&Token<'_>| match token.kind {
        Kind::Word => words::reserved(token.text).is_none(),
        Kind::Number => true,
        _ => token.text == "-",
    };
    let Some(first) = context.next().filter(begins) else { return Some(unopened(closer)) };
    let opener = closer.opener();
    let message = format!("`{opener}` is missing before `{}`", first.text);
    let found = Diagnostic::new(
        Code::Unclosed,
        message,
        first.span(),
        format!("`{opener}` should stand here"),
    );
    Some(
        found
            .label(closer.span(), "this closes it")
            .help(format!("add `{opener}` before `{}`", first.text)),
    )
}

fn unclosed(opener: &Token<'_>, last: Span) -> Diagnostic {
    let message = format!("`{}` is never closed", opener.text);
    Diagnostic::new(Code::Unclosed, message, opener.span(), "opened here")
        .help(format!("add `{}` where it should end", opener.closer()))
        .fix(closed(opener, last.end))
}

/// The bracket that is missing, at the latest place where it can stand.
fn closed(opener: &Token<'_>, at: u32) -> Fix {
    let line = if opener.text == "{" { "\n" } else { "" };
    Fix::likely(format!("add `{}`", opener.closer()))
        .insert(at, format!("{line}{}", opener.closer()))
}

fn mismatched(opener: &Token<'_>, closer: &Token<'_>) -> Diagnostic {
    let message = format!("`{}` is closed by `{}`", opener.text, closer.text);
    Diagnostic::new(Code::Unclosed, message, opener.span(), "opened here")
        .label(closer.span(), format!("`{}` should come first", opener.closer()))
        .help(format!("add `{}` where it should end", opener.closer()))
        .fix(
            Fix::likely(format!("add `{}`", opener.closer()))
                .insert(closer.span().start, opener.closer()),
        )
}

fn unopened(closer: &Token<'_>) -> Diagnostic {
    let message = format!("`{}` closes nothing", closer.text);
    Diagnostic::new(Code::Unclosed, message, closer.span(), "nothing is open here")
        .help("remove it, or open its partner before")
        .fix(Fix::likely("remove it").remove(closer.span()))
}
