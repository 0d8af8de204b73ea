//! The layout of `fdcc fmt`, as the changes of blanks that it takes: the cursor stays at its word.

use crate::client::Failure;
use crate::context::Context;
use fdcc_grammar::{Edit, Span, format};
use lsp_types::{
    DocumentFormattingParams, DocumentOnTypeFormattingParams, DocumentRangeFormattingParams,
    TextEdit,
};

/// `textDocument/formatting`
pub fn whole(
    context: &Context<'_>,
    _: DocumentFormattingParams,
) -> Result<Option<Vec<TextEdit>>, Failure> {
    let all = Span::new(0, context.snapshot().text.text.len());
    Ok(within(context, all))
}

/// `textDocument/rangeFormatting`
pub fn range(
    context: &Context<'_>,
    params: DocumentRangeFormattingParams,
) -> Result<Option<Vec<TextEdit>>, Failure> {
    Ok(within(context, context.snapshot().text.span(params.range)))
}

/// `textDocument/onTypeFormatting`: after a closing brace or a new line, what stands on the line
/// before is laid out.
pub fn on_type(
    context: &Context<'_>,
    params: DocumentOnTypeFormattingParams,
) -> Result<Option<Vec<TextEdit>>, Failure> {
    let text = &context.snapshot().text;
    let line = match params.ch.as_str() {
        "\n" => params.position.line.saturating_sub(1),
        _ => params.position.line,
    };
    Ok(within(context, text.line_span(line)))
}

/// The changes inside a range; none where the text cannot be read.
fn within(context: &Context<'_>, wanted: Span) -> Option<Vec<TextEdit>> {
    let text = &context.snapshot().text.text;
    let formatted = format(text).ok()?;
    let inside = |it: &Edit| wanted.start <= it.span.start && it.span.end <= wanted.end;
    let edits = changes(text, &formatted).into_iter().filter(inside);
    Some(edits.map(|it| context.text_edit(&it)).collect())
}

/// What has to be changed where two texts differ in blanks only; the whole text if they differ in
/// more.
fn changes(old: &str, new: &str) -> Vec<Edit> {
    let mut edits = Vec::new();
    let (mut at, mut there) = (0, 0);
    loop {
        let (gap, other) = (blanks(&old[at..]), blanks(&new[there..]));
        if gap != other {
            edits.push(Edit { span: Span::new(at, at + gap.len()), replacement: other.into() });
        }
        (at, there) = (at + gap.len(), there + other.len());
        let (word, same) = (word(&old[at..]), word(&new[there..]));
        if word != same {
            return vec![Edit { span: Span::new(0, old.len()), replacement: new.into() }];
        }
        if word.is_empty() {
            return edits;
        }
        (at, there) = (at + word.len(), there + word.len());
    }
}

fn is_blank(character: char) -> bool {
    matches!(character, ' ' | '\t' | '\r' | '\n' | '\u{FEFF}' | '\u{A0}')
}

fn blanks(text: &str) -> &str {
    &text[..text.find(|c| !is_blank(c)).unwrap_or(text.len())]
}

/// A character at a time: what stood together may be set apart.
fn word(text: &str) -> &str {
    &text[..text.chars().next().map_or(0, char::len_utf8)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_blanks_are_changed() {
        let edits = changes("param  a=1\r\n", "param a = 1\n");
        let texts: Vec<(u32, u32, &str)> =
            edits.iter().map(|it| (it.span.start, it.span.end, it.replacement.as_str())).collect();
        assert_eq!(texts, [(5, 7, " "), (8, 8, " "), (9, 9, " "), (10, 12, "\n")]);
    }
}
