//! What a gradient is taken of: an expression given as text, in the place of the objective.
//!
//! The text is read as if it stood behind that of the model, so that no two places are the same.

use super::{Checked, check_with};
use crate::data::Files;
use crate::syntax::functions::is_function;
use crate::syntax::{closest, scope, walk};
use fdcc_grammar::ast::{self, Binding, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Span, parse};

/// What makes an expression an item.
const WORD: &str = "minimize ";

/// What a tree without errors means with another objective: any expression that has a value once
/// the run is over. A `report` may stand in it by name. The diagnostics are about that expression
/// alone, and so are their places.
pub fn check_with_objective(tree: &ast::Model, of: &str, files: Option<&dyn Files>) -> Checked {
    let start = tree.items.iter().map(|item| item.span.end as usize).max().unwrap_or(0) + 1;
    let parsed = parse(&format!("{:start$}{WORD}{of}", ""));
    let first = (start + WORD.len()) as u32;
    let mut diagnostics = parsed.diagnostics;
    let mut model = None;
    let mut units = Vec::new();
    match parsed.tree.items.as_slice() {
        _ if !diagnostics.is_empty() => {}
        [asked @ Item { kind: ItemKind::Objective { value, .. }, .. }] => {
            let checked = check_with(&with_objective(tree, asked, value), files);
            model = checked.model;
            diagnostics = checked.diagnostics;
            units = checked.units;
        }
        items => diagnostics.push(superfluous(items)),
    }
    diagnostics.retain(|it| it.span().start >= first);
    diagnostics.iter_mut().for_each(|it| moved(it, first));
    // Nobody has written an objective.
    diagnostics
        .iter_mut()
        .for_each(|it| it.message = it.message.replace(" in the objective", " here"));
    Checked { model, diagnostics, units }
}

fn with_objective(tree: &ast::Model, asked: &Item, value: &ast::Expr) -> ast::Model {
    let mut tree = tree.clone();
    tree.items
        .retain(|item| !matches!(item.kind, ItemKind::Objective { .. } | ItemKind::Fit { .. }));
    let lets: Vec<Item> =
        reports(&tree).filter(|report| is_let(&tree, report, value)).map(as_let).collect();
    tree.items.extend(lets);
    tree.items.push(asked.clone());
    tree
}

fn reports(tree: &ast::Model) -> impl Iterator<Item = &Binding> {
    tree.items.iter().flat_map(|item| match &item.kind {
        ItemKind::Report { bindings } => bindings.as_slice(),
        _ => &[],
    })
}

/// Whether a report is meant by its name, perhaps misspelt, and nothing else is called so.
fn is_let(tree: &ast::Model, report: &Binding, value: &ast::Expr) -> bool {
    let name = &report.name.name;
    let is_declared =
        tree.items.iter().filter_map(scope::declared).any(|other| other.name == *name);
    let is_first = reports(tree).find(|other| other.name.name == *name) == Some(report);
    let mut is_meant = false;
    walk::names(value, &mut |used, _| {
        is_meant |= used == name || closest(used, [name.as_str()].into_iter()).is_some()
    });
    is_meant && is_first && !is_declared && !is_function(name)
}

fn as_let(report: &Binding) -> Item {
    let Binding { name, value } = report.clone();
    let span = name.span.to(value.span);
    Item { kind: ItemKind::Let { name, unit: None, value }, span }
}

fn superfluous(items: &[Item]) -> Diagnostic {
    let span = items.get(1).map_or(Span::default(), |item| item.span);
    Diagnostic::new(Code::Unfinished, "one expression is enough", span, "what is this?").help(
        "it takes any expression that has a value at the end, for example `x(end)` or \
               `integral(x^2)`",
    )
}

/// Places in the expression; those in the text of the model have no line there.
fn moved(diagnostic: &mut Diagnostic, first: u32) {
    diagnostic.labels.retain(|label| label.span.start >= first);
    for label in &mut diagnostic.labels {
        label.span = Span { start: label.span.start - first, end: label.span.end - first };
    }
}
