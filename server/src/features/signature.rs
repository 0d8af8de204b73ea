//! The arguments of the call in which the cursor stands.

use crate::client::Failure;
use crate::context::Context;
use crate::features::cursor::CursorContext;
use crate::snapshot::Snapshot;
use fdcc::language::Kind;
use fdcc::language::vocabulary;
use lsp_types::{
    MarkupContent, MarkupKind, ParameterInformation, SignatureHelp, SignatureHelpParams,
    SignatureInformation,
};

/// `textDocument/signatureHelp`
pub fn help(
    context: &Context<'_>,
    params: SignatureHelpParams,
) -> Result<Option<SignatureHelp>, Failure> {
    let offset = context.offset(params.text_document_position_params.position) as usize;
    let place = CursorContext::at_end_of(&context.snapshot().text.text[..offset]);
    let calls = place.open.iter().rev().filter(|it| it.bracket == '(');
    let found = calls.into_iter().find_map(|it| Some((signature(context, it.before)?, it.commas)));
    Ok(found.map(|(signature, commas)| SignatureHelp {
        active_parameter: Some((commas as u32).into()),
        active_signature: Some(0),
        signatures: vec![signature],
    }))
}

/// A function of the model, or one of the language.
fn signature(context: &Context<'_>, name: &str) -> Option<SignatureInformation> {
    own(context, name).or_else(|| {
        let it = vocabulary::function(name)?;
        Some(information(name, &it.arguments, it.doc.into()))
    })
}

fn own(context: &Context<'_>, name: &str) -> Option<SignatureInformation> {
    let snapshots = std::iter::once(context.document.snapshot()).chain(context.document.readable());
    snapshots.into_iter().find_map(|snapshot| declared(snapshot, name))
}

fn declared(snapshot: &Snapshot, name: &str) -> Option<SignatureInformation> {
    let names = snapshot.names();
    let at =
        names.definitions.iter().position(|it| it.kind == Kind::Function && it.name == name)?;
    let arguments: Vec<&str> =
        names.parts_of(at).map(|at| names.definitions[at].name.as_str()).collect();
    let declaration = &snapshot.text.text[names.definitions[at].item.range()];
    Some(information(name, &arguments, format!("```fdc\n{declaration}\n```")))
}

fn information(name: &str, arguments: &[&str], doc: String) -> SignatureInformation {
    let parameter =
        |it: &&str| ParameterInformation { label: (*it).to_owned().into(), documentation: None };
    let documentation = Some(MarkupContent { kind: MarkupKind::Markdown, value: doc }.into());
    SignatureInformation {
        label: format!("{name}({})", arguments.join(", ")),
        documentation,
        parameters: Some(arguments.iter().map(parameter).collect()),
        active_parameter: None,
    }
}
