//! Colours by meaning: states, controls, parameters, unknowns, surfaces and units apart.
//!
//! Words, numbers and comments are coloured by the editor's own grammar; here is what only the
//! meaning tells.

use crate::client::Failure;
use crate::context::Context;
use fdcc::language::{Kind, Meaning, Names, Occurrence, Role};
use fdcc_grammar::Span;
use lsp_types::{
    SemanticToken, SemanticTokens, SemanticTokensLegend, SemanticTokensParams,
    SemanticTokensRangeParams,
};

/// The kinds, in the order of their numbers.
const TYPES: &[&str] = &[
    "state",
    "control",
    "param",
    "free",
    "surface",
    "unit",
    "time",
    "constant",
    "variable",
    "function",
    "parameter",
    "property",
    "data",
    "phase",
    "jump",
    "constraint",
    "setting",
    "value",
    "model",
];
const MODIFIERS: &[&str] = &["declaration", "modification", "defaultLibrary"];

/// What the numbers stand for.
pub fn legend() -> SemanticTokensLegend {
    let owned = |words: &[&str]| words.iter().map(|it| (*it).to_owned()).collect();
    SemanticTokensLegend { token_types: owned(TYPES), token_modifiers: owned(MODIFIERS) }
}

/// `textDocument/semanticTokens/full`
pub fn full(
    context: &Context<'_>,
    _: SemanticTokensParams,
) -> Result<Option<SemanticTokens>, Failure> {
    Ok(Some(within(context, Span::new(0, context.snapshot().text.text.len()))))
}

/// `textDocument/semanticTokens/range`
pub fn range(
    context: &Context<'_>,
    params: SemanticTokensRangeParams,
) -> Result<Option<SemanticTokens>, Failure> {
    Ok(Some(within(context, context.snapshot().text.span(params.range))))
}

fn within(context: &Context<'_>, wanted: Span) -> SemanticTokens {
    let names = context.snapshot().names();
    let (mut data, mut before) = (Vec::new(), lsp_types::Position::default());
    for it in names
        .occurrences
        .iter()
        .filter(|it| it.span.start < it.span.end)
        .filter(|it| wanted.start <= it.span.start && it.span.end <= wanted.end)
    {
        let Some(word) = type_of(names, it) else { continue };
        let range = context.range(it.span);
        let is_same_line = range.start.line == before.line;
        data.push(SemanticToken {
            delta_line: range.start.line - before.line,
            delta_start: range.start.character - if is_same_line { before.character } else { 0 },
            length: range.end.character - range.start.character,
            token_type: TYPES
                .iter()
                .position(|known| *known == word)
                .expect("every kind is in the legend") as u32,
            token_modifiers_bitset: modifiers(it),
        });
        before = range.start;
    }
    SemanticTokens { result_id: None, data }
}

fn type_of(names: &Names, it: &Occurrence) -> Option<&'static str> {
    match it.meaning {
        Meaning::Declared(at) => Some(type_of_kind(whole_of(names, at))),
        Meaning::BuiltIn => Some("function"),
        Meaning::Unit => Some("unit"),
        Meaning::Setting => Some("setting"),
        Meaning::Value => Some("value"),
        Meaning::Unknown => None,
    }
}

/// A part of a state is a state.
fn whole_of(names: &Names, at: usize) -> Kind {
    let it = &names.definitions[at];
    match it.within {
        Some(outer) if it.kind == Kind::Part => names.definitions[outer].kind,
        _ => it.kind,
    }
}

fn type_of_kind(kind: Kind) -> &'static str {
    match kind {
        Kind::State => "state",
        Kind::Control => "control",
        Kind::Param => "param",
        Kind::Free => "free",
        Kind::Surface => "surface",
        Kind::Time => "time",
        Kind::Const => "constant",
        Kind::Let | Kind::Signal | Kind::Report | Kind::Plot => "variable",
        Kind::Function => "function",
        Kind::Argument | Kind::Row => "parameter",
        Kind::Part | Kind::Column => "property",
        Kind::Data => "data",
        Kind::Phase => "phase",
        Kind::Jump => "jump",
        Kind::Path => "constraint",
        Kind::Model => "model",
    }
}

fn modifiers(it: &Occurrence) -> u32 {
    let role = match it.role {
        Role::Definition => 1,
        Role::Write => 2,
        Role::Read => 0,
    };
    role | if it.meaning == Meaning::BuiltIn { 4 } else { 0 }
}
