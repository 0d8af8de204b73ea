//! What is known about the word under the cursor: what it is, in which unit, within which bounds,
//! how it varies.
//!
//! Where the text has mistakes at the moment, the last model without any is asked.

mod names;
mod settings;

use crate::client::Failure;
use crate::context::Context;
use fdcc::language::vocabulary;
use fdcc::language::{Meaning, Occurrence};
use lsp_types::{Contents, Hover, HoverParams, MarkupContent, MarkupKind};

/// `textDocument/hover`
pub fn hover(context: &Context<'_>, params: HoverParams) -> Result<Option<Hover>, Failure> {
    let offset = context.offset(params.text_document_position_params.position);
    let Some(found) = context.snapshot().names().at(offset) else { return Ok(None) };
    let word = &context.snapshot().text.text[found.span.range()];
    let text = match found.meaning {
        Meaning::Declared(definition) => Some(names::told(context, definition)),
        Meaning::BuiltIn => function(word),
        Meaning::Unit => vocabulary::unit(word),
        Meaning::Setting => settings::told(context, word),
        Meaning::Value => vocabulary::setting_word(word),
        Meaning::Unknown => None,
    };
    Ok(text.map(|text| shown(context, found, text)))
}

fn shown(context: &Context<'_>, found: &Occurrence, value: String) -> Hover {
    let contents = Contents::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value });
    Hover { contents, range: Some(context.range(found.span)) }
}

fn function(name: &str) -> Option<String> {
    if let Some((_, doc)) = vocabulary::NUMBERS.iter().find(|it| it.0 == name) {
        return Some(format!("```fdc\n{name}\n```\n{doc}"));
    }
    let it = vocabulary::function(name)?;
    Some(format!("```fdc\n{name}({})\n```\n{}", it.arguments.join(", "), it.doc))
}
