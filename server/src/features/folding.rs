//! What can be folded away, and what grows around a place: both follow the brackets and the tree.

use crate::client::Failure;
use crate::context::Context;
use fdcc::language::enclosing;
use fdcc_grammar::{Span, comments};
use lsp_types::{
    FoldingRange, FoldingRangeKind, FoldingRangeParams, SelectionRange, SelectionRangeParams,
};

/// `textDocument/foldingRange`: blocks, and comments of several lines.
pub fn folding(
    context: &Context<'_>,
    _: FoldingRangeParams,
) -> Result<Option<Vec<FoldingRange>>, Failure> {
    let text = &context.snapshot().text;
    let comments = comments(&text.text);
    let mut all = Vec::new();
    for block in blocks(&text.text, &comments) {
        // The line with the closing brace stays.
        let (first, last) = (text.line(block.start), text.line(block.end - 1));
        all.extend(fold(first, last.saturating_sub(1), None));
    }
    let is_alone = |it: &&Span| {
        text.text[text.line_span(text.line(it.start)).range()].trim_start().starts_with('#')
    };
    let lines: Vec<u32> = comments.iter().filter(is_alone).map(|it| text.line(it.start)).collect();
    for run in lines.chunk_by(|one, next| one + 1 == *next) {
        all.extend(fold(run[0], run[run.len() - 1], Some(FoldingRangeKind::Comment)));
    }
    all.sort_by_key(|it| (it.start_line, it.end_line));
    Ok(Some(all))
}

fn fold(start_line: u32, end_line: u32, kind: Option<FoldingRangeKind>) -> Option<FoldingRange> {
    (start_line < end_line).then(|| FoldingRange {
        start_line,
        end_line,
        kind,
        ..FoldingRange::default()
    })
}

/// Every `{ ... }`, also where the rest cannot be read.
fn blocks(text: &str, comments: &[Span]) -> Vec<Span> {
    let (mut open, mut all) = (Vec::new(), Vec::new());
    let mut comments = comments.iter().peekable();
    for (at, character) in text.char_indices() {
        while comments.next_if(|it| it.end as usize <= at).is_some() {}
        if comments.peek().is_some_and(|it| it.start as usize <= at) {
            continue;
        }
        match character {
            '{' => open.push(at),
            '}' => all.extend(open.pop().map(|start| Span::new(start, at + 1))),
            _ => {}
        }
    }
    all
}

/// `textDocument/selectionRange`: from the innermost expression to the whole text.
pub fn selection(
    context: &Context<'_>,
    params: SelectionRangeParams,
) -> Result<Option<Vec<SelectionRange>>, Failure> {
    let snapshot = context.snapshot();
    let around = |offset: u32| {
        let mut spans = vec![Span::new(0, snapshot.text.text.len())];
        spans.extend(enclosing(snapshot.tree(), offset));
        spans.extend(snapshot.names().at(offset).map(|it| it.span));
        let mut chain: Option<Box<SelectionRange>> = None;
        for span in spans {
            let range = context.range(span);
            if chain.as_ref().is_none_or(|outer| outer.range != range) {
                chain = Some(Box::new(SelectionRange { range, parent: chain }));
            }
        }
        *chain.expect("the whole text is around everything")
    };
    Ok(Some(params.positions.into_iter().map(|it| around(context.offset(it))).collect()))
}
