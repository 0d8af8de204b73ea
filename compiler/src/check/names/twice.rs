//! FDC0102: what a block says of a name twice, labels that are given twice, and reports that are
//! called like another column of the result.
//!
//! What stands outside of all phases holds in each: a label or a report of a phase may not have the
//! name of one there. Guesses and settings of a phase replace those outside.

use crate::syntax::scope::{declared, kind_word};
use fdcc_grammar::ast::{self, Ident, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Span};
use std::collections::HashMap;

/// Reports what is given twice in a text, and in the same text with all phases written out.
pub(crate) fn check(tree: &ast::Model, written_out: &ast::Model) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let outer = repeated(&tree.items, &Seen::new(), &mut found);
    for items in phases(tree) {
        repeated(items, &outer, &mut found);
    }
    columns(written_out, &mut found);
    found
}

/// What a line gives to a name.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Line {
    Path,
    Jump,
    Report,
    Plot,
    Weight,
    Guess,
    Setting,
    Values,
}

impl Line {
    /// Whether a line outside of all phases stands beside those of each.
    fn is_of_each_phase(self) -> bool {
        matches!(self, Line::Path | Line::Jump | Line::Report | Line::Plot | Line::Weight)
    }

    /// What is wrong with a second one, behind the name, and what to do.
    fn words(self) -> (&'static str, &'static str) {
        match self {
            Line::Path => ("is the name of two path conditions", "rename one of them"),
            Line::Jump => ("is the name of two jumps", "rename one of them"),
            Line::Report => ("is reported twice", "rename one of them, or remove it"),
            Line::Plot => ("is the name of two plots", "rename one of them"),
            Line::Weight => ("has two weights", "keep one of them"),
            Line::Guess => ("is guessed twice", "keep one of them"),
            Line::Setting => ("is set twice", "keep one of them"),
            Line::Values => ("is swept twice", "write all its values into one list"),
        }
    }
}

/// Where each line was given first.
type Seen<'a> = HashMap<(Line, &'a str), Span>;

fn repeated<'a>(items: &'a [Item], outer: &Seen<'a>, found: &mut Vec<Diagnostic>) -> Seen<'a> {
    let mut seen = Seen::new();
    for (line, name) in items.iter().flat_map(lines) {
        let key = (line, name.name.as_str());
        let around = outer.get(&key).filter(|_| line.is_of_each_phase());
        let first = seen.get(&key).or(around).copied();
        found.extend(first.map(|first| twice(line, name, first)));
        seen.entry(key).or_insert(name.span);
    }
    seen
}

fn lines(item: &Item) -> Vec<(Line, &Ident)> {
    match &item.kind {
        ItemKind::Path { name: Some(name), .. } => vec![(Line::Path, name)],
        ItemKind::Jump { name, .. } => vec![(Line::Jump, name)],
        ItemKind::Report { bindings } => {
            bindings.iter().map(|it| (Line::Report, &it.name)).collect()
        }
        ItemKind::Plot { name, .. } => vec![(Line::Plot, name)],
        ItemKind::Metric { weights } => weights.iter().map(|it| (Line::Weight, &it.0)).collect(),
        ItemKind::Guess { bindings } => bindings.iter().map(|it| (Line::Guess, &it.name)).collect(),
        ItemKind::Method { settings } => {
            settings.iter().map(|it| (Line::Setting, &it.key)).collect()
        }
        ItemKind::Sweep { lists } => lists.iter().map(|it| (Line::Values, &it.name)).collect(),
        _ => Vec::new(),
    }
}

fn twice(line: Line, name: &Ident, first: Span) -> Diagnostic {
    let (what, help) = line.words();
    let message = format!("`{}` {what}", name.name);
    Diagnostic::new(Code::DuplicateName, message, name.span, "again")
        .label(first, "first here")
        .help(help)
}

/// The items of each phase.
fn phases(tree: &ast::Model) -> impl Iterator<Item = &[Item]> {
    tree.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Phase { items, .. } => Some(&items[..]),
        _ => None,
    })
}

/// Reports whose column would have the name of another one: states and controls are written beside
/// them, over time.
fn columns(tree: &ast::Model, found: &mut Vec<Diagnostic>) {
    let outer = (variables(&tree.items), reports(&tree.items));
    found.extend(outer.1.values().filter_map(|name| same_name(name, &outer.0)));
    for items in phases(tree) {
        let own = variables(items);
        let of_phase = reports(items).into_values();
        found.extend(
            of_phase.filter_map(|name| same_name(name, &own).or_else(|| same_name(name, &outer.0))),
        );
        let around = own.keys().filter_map(|name| outer.1.get(name));
        found.extend(around.filter_map(|name| same_name(name, &own)));
    }
}

fn variables(items: &[Item]) -> HashMap<&str, &Item> {
    let is_column = |item: &&Item| {
        let kind = &item.kind;
        matches!(kind, ItemKind::Time { .. } | ItemKind::State { .. } | ItemKind::Control { .. })
    };
    let named = |item| declared(item).map(|name| (name.name.as_str(), item));
    items.iter().filter(is_column).filter_map(named).collect()
}

fn reports(items: &[Item]) -> HashMap<&str, &Ident> {
    let all = items.iter().flat_map(lines).filter(|it| it.0 == Line::Report);
    all.map(|(_, name)| (name.name.as_str(), name)).collect()
}

fn same_name(report: &Ident, variables: &HashMap<&str, &Item>) -> Option<Diagnostic> {
    let item = variables.get(report.name.as_str())?;
    let article = if matches!(item.kind, ItemKind::Time { .. }) { "the" } else { "a" };
    let kind = format!("{article} {}", kind_word(item));
    let message = format!("`{}` is {kind}, and the name of a report", report.name);
    let found = Diagnostic::new(Code::DuplicateName, message, report.span, "a second column");
    let first = declared(item).map_or(item.span, |name| name.span);
    let found = found.label(first, format!("declared as {kind}"));
    Some(found.help("rename the report: both are written to the result"))
}
