//! What a text declares.

use super::{Definition, Kind, Meaning, Names, Occurrence, Role};
use crate::syntax::scope;
use fdcc_grammar::Span;
use fdcc_grammar::ast::{self, Each, Ident, Item, ItemKind};

/// Adds all definitions.
pub(super) fn collect(tree: &ast::Model, names: &mut Names) {
    if let Some(name) = &tree.name {
        declare(names, name, Kind::Model, name.span, None);
    }
    items(&tree.items, None, names);
}

fn items(all: &[Item], phase: Option<usize>, names: &mut Names) {
    for item in all {
        own(item, phase, names);
    }
}

fn own(item: &Item, phase: Option<usize>, names: &mut Names) {
    let entry =
        |names: &mut Names, name: &Ident, kind| declare(names, name, kind, item.span, phase);
    match &item.kind {
        ItemKind::Fn { name, arguments, .. } => {
            let function = entry(names, name, Kind::Function);
            for argument in arguments {
                declare(names, argument, Kind::Argument, item.span, Some(function));
            }
        }
        ItemKind::Data { name, columns, .. } => {
            let data = entry(names, name, Kind::Data);
            for (column, _) in columns {
                declare(names, column, Kind::Column, item.span, Some(data));
            }
        }
        ItemKind::Phase { name, each, items: inner, .. } => {
            let phase = entry(names, name, Kind::Phase);
            if let Some(each) = each {
                // Within it, its name is that of the rows of its file.
                let head = Span { end: end_of(each), ..item.span };
                let rows = declare(names, name, Kind::Data, head, Some(phase));
                for (column, _) in &each.columns {
                    declare(names, column, Kind::Column, head, Some(rows));
                }
            }
            items(inner, Some(phase), names);
        }
        ItemKind::Jump { name, .. } => {
            entry(names, name, Kind::Jump);
        }
        ItemKind::Path { name: Some(name), .. } => {
            entry(names, name, Kind::Path);
        }
        ItemKind::Plot { name, .. } => {
            entry(names, name, Kind::Plot);
        }
        ItemKind::Report { bindings } => {
            for it in bindings {
                declare(names, &it.name, Kind::Report, it.name.span.to(it.value.span), phase);
            }
        }
        _ => {
            let (Some(name), Some(kind)) = (scope::declared(item), kind(item)) else { return };
            let vector = entry(names, name, kind);
            for part in scope::parts(item) {
                declare(names, part, Kind::Part, item.span, Some(vector));
            }
        }
    }
}

/// Where the head of a phase for each file ends.
fn end_of(each: &Each) -> u32 {
    each.columns
        .last()
        .map_or(each.file_span, |it| it.1.as_ref().map_or(it.0.span, |it| it.span))
        .end
}

/// What a declaration without anything inside declares.
fn kind(item: &Item) -> Option<Kind> {
    Some(match &item.kind {
        ItemKind::Param { .. } => Kind::Param,
        ItemKind::Const { .. } => Kind::Const,
        ItemKind::Let { .. } => Kind::Let,
        ItemKind::Signal { .. } => Kind::Signal,
        ItemKind::Free { .. } => Kind::Free,
        ItemKind::Time { .. } => Kind::Time,
        ItemKind::State { .. } => Kind::State,
        ItemKind::Control { .. } => Kind::Control,
        ItemKind::Surface { .. } => Kind::Surface,
        _ => return None,
    })
}

/// Adds a definition, with its own place among the occurrences.
pub(super) fn declare(
    names: &mut Names,
    name: &Ident,
    kind: Kind,
    item: Span,
    within: Option<usize>,
) -> usize {
    let at = names.definitions.len();
    names.definitions.push(Definition {
        name: name.name.clone(),
        kind,
        span: name.span,
        item,
        within,
    });
    let (span, meaning) = (name.span, Meaning::Declared(at));
    names.occurrences.push(Occurrence { span, meaning, role: Role::Definition });
    at
}
