//! Another name for something, wherever it stands. Done only if every name means afterwards what it
//! meant before.

use crate::client::Failure;
use crate::context::Context;
use crate::snapshot::Snapshot;
use fdcc::language::{Meaning, Names, Occurrence, Role};
use fdcc_grammar::ast::{Item, ItemKind};
use fdcc_grammar::{Edit, parse};
use lsp_types::{
    PrepareRenameParams, PrepareRenamePlaceholder, PrepareRenameResult, RenameParams, WorkspaceEdit,
};

/// `textDocument/prepareRename`
pub fn prepare(
    context: &Context<'_>,
    params: PrepareRenameParams,
) -> Result<Option<PrepareRenameResult>, Failure> {
    let names = context.snapshot().names();
    let offset = context.offset(params.text_document_position_params.position);
    let Some(occurrence) = names.at(offset) else { return Ok(None) };
    let definition = renamable(context.snapshot(), offset)?;
    let placeholder = names.definitions[definition].name.clone();
    Ok(Some(PrepareRenamePlaceholder { range: context.range(occurrence.span), placeholder }.into()))
}

/// `textDocument/rename`
pub fn rename(
    context: &Context<'_>,
    params: RenameParams,
) -> Result<Option<WorkspaceEdit>, Failure> {
    let snapshot = context.snapshot();
    let offset = context.offset(params.text_document_position_params.position);
    let definition = renamable(snapshot, offset)?;
    let new_name = params.new_name.trim();
    check_name(new_name)?;
    let edits = edits(snapshot.names(), definition, new_name);
    check_meaning(snapshot, &edits, new_name)?;
    Ok(Some(context.workspace_edit(&edits)))
}

/// What can be renamed at a byte.
fn renamable(snapshot: &Snapshot, offset: u32) -> Result<usize, Failure> {
    let names = snapshot.names();
    match names.at(offset).map(|it| it.meaning) {
        Some(Meaning::Declared(_)) if !snapshot.is_readable() => Err(Failure::request(
            "this text has mistakes of syntax, and a name in what cannot be read would be missed; \
             mend them first",
        )),
        Some(Meaning::Declared(definition)) => Ok(definition),
        Some(Meaning::Unknown) => {
            Err(Failure::request("this name is not declared, so there is nothing to rename"))
        }
        Some(_) => Err(Failure::request("this word belongs to the language and has no other name")),
        None => Err(Failure::request("there is no name here")),
    }
}

/// The grammar decides what is a name.
fn check_name(name: &str) -> Result<(), Failure> {
    let parsed = parse(&format!("param {name} = 1"));
    let is_it =
        |item: &Item| matches!(&item.kind, ItemKind::Param { name: it, .. } if it.name == name);
    let is_name =
        parsed.diagnostics.is_empty() && matches!(&parsed.tree.items[..], [item] if is_it(item));
    let why = parsed.diagnostics.first().map_or("a name is one word", |it| it.message.as_str());
    if is_name {
        Ok(())
    } else {
        Err(Failure::request(format!("`{name}` cannot be a name: {why}")))
    }
}

/// A column that has the name of its signal keeps it: it is named then.
fn edits(names: &Names, definition: usize, new_name: &str) -> Vec<Edit> {
    let old_name = &names.definitions[definition].name;
    let has_column = |end: u32| {
        let is_it = |it: &Occurrence| (it.span.start, it.span.end) == (end, end);
        names.occurrences.iter().any(is_it)
    };
    let edit = |it: &Occurrence| {
        let replacement = match it.span {
            span if span.start == span.end => format!(" = {new_name}"),
            span if has_column(span.end) => format!("{new_name} = {old_name}"),
            _ => new_name.into(),
        };
        Edit { span: it.span, replacement }
    };
    names.of(definition).map(edit).collect()
}

/// Whether all names stand for the same things in the new text.
fn check_meaning(snapshot: &Snapshot, edits: &[Edit], new_name: &str) -> Result<(), Failure> {
    let mut text = snapshot.text.text.to_string();
    for edit in edits.iter().rev() {
        text.replace_range(edit.span.range(), &edit.replacement);
    }
    let after = Names::new(&parse(&text).tree);
    let meanings = |names: &Names| -> Vec<(Meaning, Role)> {
        names.occurrences.iter().map(|it| (it.meaning, it.role)).collect()
    };
    let is_free = snapshot.names().definitions.iter().all(|it| it.name != new_name)
        || !declares_twice(&after);
    match is_free && meanings(snapshot.names()) == meanings(&after) {
        true => Ok(()),
        false => Err(Failure::request(format!(
            "`{new_name}` already means something here; choose another name"
        ))),
    }
}

/// Whether two names of one kind of place are the same.
fn declares_twice(names: &Names) -> bool {
    let all = &names.definitions;
    (0..all.len())
        .any(|at| all[..at].iter().any(|it| it.name == all[at].name && it.within == all[at].within))
}
