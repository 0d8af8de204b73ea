//! Where a name is declared, and where else it stands.

use crate::client::Failure;
use crate::context::Context;
use fdcc::language::{Occurrence, Role};
use lsp_types::{
    Definition, DefinitionParams, DefinitionResponse, DocumentHighlight, DocumentHighlightKind,
    DocumentHighlightParams, Location, ReferenceParams,
};

/// `textDocument/definition`
pub fn definition(
    context: &Context<'_>,
    params: DefinitionParams,
) -> Result<Option<DefinitionResponse>, Failure> {
    let names = context.snapshot().names();
    let found = names.definition_at(context.offset(params.text_document_position_params.position));
    let location = found.map(|at| context.location(names.definitions[at].span));
    Ok(location.map(|it| Definition::Location(it).into()))
}

/// `textDocument/references`
pub fn references(
    context: &Context<'_>,
    params: ReferenceParams,
) -> Result<Option<Vec<Location>>, Failure> {
    let names = context.snapshot().names();
    let offset = context.offset(params.text_document_position_params.position);
    let Some(definition) = names.definition_at(offset) else { return Ok(None) };
    let wanted =
        |it: &&Occurrence| it.role != Role::Definition || params.context.include_declaration;
    Ok(Some(names.of(definition).filter(wanted).map(|it| context.location(it.span)).collect()))
}

/// `textDocument/documentHighlight`
pub fn highlights(
    context: &Context<'_>,
    params: DocumentHighlightParams,
) -> Result<Option<Vec<DocumentHighlight>>, Failure> {
    let names = context.snapshot().names();
    let offset = context.offset(params.text_document_position_params.position);
    let Some(definition) = names.definition_at(offset) else { return Ok(None) };
    let highlight = |it: &Occurrence| {
        let kind = if it.role == Role::Read {
            DocumentHighlightKind::Read
        } else {
            DocumentHighlightKind::Write
        };
        DocumentHighlight { range: context.range(it.span), kind: Some(kind) }
    };
    Ok(Some(names.of(definition).map(highlight).collect()))
}
