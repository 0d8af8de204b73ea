//! Repairs: every fix of every finding, and all certain ones at once.

use crate::client::Failure;
use crate::context::Context;
use crate::features::diagnostics::shown;
use fdcc::language::repair;
use fdcc_grammar::{Diagnostic, Edit, Fix, Span};
use lsp_types::{CodeAction, CodeActionKind, CodeActionParams, CodeActionResponse};

/// `textDocument/codeAction`
pub fn actions(
    context: &Context<'_>,
    params: CodeActionParams,
) -> Result<Option<Vec<CodeActionResponse>>, Failure> {
    let snapshot = context.snapshot();
    let wanted = snapshot.text.span(params.range);
    let asked = |kind: &CodeActionKind| {
        let is_asked = |only: &Vec<CodeActionKind>| only.iter().any(|it| is_kind(kind, it));
        params.context.only.as_ref().is_none_or(is_asked)
    };
    let mut all: Vec<CodeActionResponse> = Vec::new();
    if asked(&CodeActionKind::QuickFix) {
        let touched = |it: &&Diagnostic| it.labels.iter().any(|label| touches(label.span, wanted));
        for found in snapshot.diagnostics().iter().filter(touched) {
            all.extend(found.fixes.iter().map(|fix| quick_fix(context, found, fix).into()));
        }
    }
    if asked(&CodeActionKind::SourceFixAll) {
        all.extend(fix_all(context).map(CodeActionResponse::from));
    }
    Ok(Some(all))
}

/// `source.fixAll` is a `source`.
fn is_kind(kind: &CodeActionKind, asked: &CodeActionKind) -> bool {
    let (kind, asked) = (kind.to_string(), asked.to_string());
    asked.is_empty() || kind == asked || kind.starts_with(&format!("{asked}."))
}

fn touches(one: Span, other: Span) -> bool {
    one.start <= other.end && other.start <= one.end
}

fn quick_fix(context: &Context<'_>, found: &Diagnostic, fix: &Fix) -> CodeAction {
    let diagnostic = shown(found, context.snapshot(), &context.document.uri, &context.state.agreed);
    CodeAction {
        title: sentence(&fix.title),
        kind: Some(CodeActionKind::QuickFix),
        diagnostics: Some(vec![diagnostic]),
        is_preferred: fix.certain.then_some(true),
        edit: Some(context.workspace_edit(&fix.edits)),
        ..CodeAction::default()
    }
}

/// What `fdcc fix` would do.
fn fix_all(context: &Context<'_>) -> Option<CodeAction> {
    let text = &context.snapshot().text.text;
    let is_certain = |it: &Diagnostic| it.fixes.iter().any(|fix| fix.certain);
    if !context.snapshot().diagnostics().iter().any(is_certain) {
        return None;
    }
    let edit = difference(text, &repair(text, false))?;
    Some(CodeAction {
        title: "Apply all certain repairs".into(),
        kind: Some(CodeActionKind::SourceFixAll),
        edit: Some(context.workspace_edit(&[edit])),
        ..CodeAction::default()
    })
}

/// One change that holds all differences of two texts.
fn difference(old: &str, new: &str) -> Option<Edit> {
    if old == new {
        return None;
    }
    let same = |a: (char, char)| a.0 == a.1;
    let head: usize =
        old.chars().zip(new.chars()).take_while(|it| same(*it)).map(|it| it.0.len_utf8()).sum();
    let backwards = old[head..].chars().rev().zip(new[head..].chars().rev());
    let tail: usize = backwards.take_while(|it| same(*it)).map(|it| it.0.len_utf8()).sum();
    let span = Span::new(head, old.len() - tail);
    Some(Edit { span, replacement: new[head..new.len() - tail].into() })
}

/// With a capital, as titles in menus are.
fn sentence(text: &str) -> String {
    let mut rest = text.chars();
    rest.next().map_or(String::new(), |first| first.to_uppercase().chain(rest).collect())
}
