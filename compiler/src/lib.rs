//! From the syntax tree to compiled functions.

pub mod builtins;
mod check;
pub mod differentiate;
pub mod generate;
pub mod graph;
pub mod model;
pub mod program;
mod resolve;
pub mod smooth;
pub mod units;

use check::Facts;
use fdcc_grammar::ast::{self, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Severity};
pub use model::Model;
use resolve::resolve;

/// What a syntax tree means, and what is wrong with it.
pub struct Checked {
    /// Present if there is no error, but for parameters that wait for a value.
    pub model: Option<Model>,
    /// In the order of the text.
    pub diagnostics: Vec<Diagnostic>,
}

/// Finds out what a syntax tree means. Never fails: it reports everything that is wrong, each mistake once.
pub fn check(tree: &ast::Model) -> Checked {
    let everything: Vec<&Item> = tree.items.iter().collect();
    let phases: Vec<(&ast::Ident, &[Item])> = tree.items.iter().filter_map(phase).collect();
    let mut whole = resolve(&[], &everything);
    let mut diagnostics = checked(&mut whole, everything.clone(), tree, phases.is_empty());
    for (name, items) in &phases {
        let items: Vec<&Item> = items.iter().collect();
        let mut part = resolve(&everything, &items);
        diagnostics.extend(checked(&mut part, items, tree, true));
        whole.not_yet(name.span, "a model with phases");
        whole.not_yet.append(&mut part.not_yet);
    }
    diagnostics.extend(check::unused(tree));
    sort(&mut diagnostics);
    sort(&mut whole.not_yet);
    let fatal = |it: &Diagnostic| it.severity == Severity::Error && it.code != Code::NoValue;
    let name = tree.name.as_ref().map_or("model", |name| &name.name);
    let model = (!diagnostics.iter().any(fatal)).then(|| Model { name: name.into(), ..whole.into_model() });
    Checked { model, diagnostics }
}

fn phase(item: &Item) -> Option<(&ast::Ident, &[Item])> {
    match &item.kind {
        ItemKind::Phase { name, items } => Some((name, items)),
        _ => None,
    }
}

fn checked<'a>(
    meaning: &mut resolve::elaborator::Elaborator<'a>,
    items: Vec<&'a Item>,
    tree: &'a ast::Model,
    is_phase: bool,
) -> Vec<Diagnostic> {
    let found = check::check(&mut Facts { items, meaning, tree }, is_phase);
    let mut all = std::mem::take(&mut meaning.diagnostics);
    all.extend(found);
    all
}

/// In the order of the text, each finding once.
fn sort(diagnostics: &mut Vec<Diagnostic>) {
    diagnostics.sort_by_key(|it| (it.span(), it.code));
    diagnostics.dedup_by(|a, b| (a.span(), a.code, &a.message) == (b.span(), b.code, &b.message));
}
