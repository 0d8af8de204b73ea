//! What can be done with a model as a whole, above its first line.

use crate::client::Failure;
use crate::commands::COMMANDS;
use crate::context::Context;
use fdcc_grammar::Span;
use lsp_types::{CodeLens, CodeLensParams, Command};

/// `textDocument/codeLens`: nothing for a model that has mistakes.
pub fn lenses(context: &Context<'_>, _: CodeLensParams) -> Result<Option<Vec<CodeLens>>, Failure> {
    let snapshot = context.snapshot();
    if !snapshot.has_meaning() {
        return Ok(Some(Vec::new()));
    }
    let first = snapshot.tree().items.first().map_or(0, |item| item.span.start);
    let start = snapshot.tree().name.as_ref().map_or(first, |name| name.span.start.min(first));
    let range = context.range(Span { start, end: start });
    let lens = |(name, title): &(&str, &str)| CodeLens {
        range,
        command: Some(Command {
            title: (*title).to_owned(),
            command: (*name).to_owned(),
            arguments: Some(vec![context.document.uri.0.clone().into()]),
            tooltip: None,
        }),
        data: None,
    };
    Ok(Some(COMMANDS.iter().map(lens).collect()))
}
