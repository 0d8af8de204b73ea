//! FDC0404: names that nothing mentions.
//!
//! Mentions are followed through definitions: what only an unused `let` mentions is unused. A control or an
//! unknown must be mentioned by the problem itself; a guess or a report does not count. Names that begin with
//! `_` are silent, and so are states, whose equation is their use, and time.

use crate::resolve::scope::{declared, kind_word};
use crate::resolve::walk;
use fdcc_grammar::ast::{self, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Fix};
use std::collections::{HashMap, HashSet};

/// Reports unused names of the whole file.
pub(crate) fn check(tree: &ast::Model) -> Vec<Diagnostic> {
    let mut items: Vec<&Item> = Vec::new();
    flatten(&tree.items, &mut items);
    let anywhere = reached(&items, |_| true);
    let problem = reached(&items, |kind| {
        !matches!(
            kind,
            ItemKind::Guess { .. }
                | ItemKind::Report { .. }
                | ItemKind::Sweep { .. }
                | ItemKind::Expect { .. }
                | ItemKind::Method { .. }
        )
    });
    let mut written = HashSet::new();
    for item in &items {
        mentioned(item, &mut |name| {
            written.insert(name);
        });
    }
    let found = items.iter().filter_map(|item| Some((item, unused(item, &anywhere, &problem)?)));
    found.map(|(item, diagnostic)| with_fix(item, diagnostic, &written)).collect()
}

fn unused(item: &Item, anywhere: &HashSet<&str>, problem: &HashSet<&str>) -> Option<Diagnostic> {
    let name = declared(item)?;
    let name_ = name.name.as_str();
    let (uses, label, why) = match item.kind {
        ItemKind::State { .. } | ItemKind::Time { .. } | ItemKind::Phase { .. } => return None,
        ItemKind::Control { .. } => (
            problem,
            "no equation, constraint or objective mentions it",
            " An unused control makes the solution non-unique.",
        ),
        ItemKind::Free { .. } => (
            problem,
            "no equation, constraint or objective mentions it",
            " An unused unknown makes the solution non-unique.",
        ),
        _ => (anywhere, "nothing mentions it", ""),
    };
    if uses.contains(name_) || name_.starts_with('_') {
        return None;
    }
    let found = Diagnostic::new(
        Code::Unused,
        format!("{} `{name_}` is never used", kind_word(item)),
        name.span,
        label,
    );
    Some(found.help(format!("remove it, or name it `_{name_}` to keep it.{why}")))
}

/// The new name, where nothing has to follow it: a guess or another unused definition may use the old one.
fn with_fix(item: &Item, found: Diagnostic, written: &HashSet<&str>) -> Diagnostic {
    match declared(item).filter(|name| !written.contains(name.name.as_str())) {
        Some(name) => {
            found.fix(Fix::likely(format!("name it `_{}`", name.name)).insert(name.span.start, "_"))
        }
        None => found,
    }
}

/// The items of the file and of its phases.
fn flatten<'a>(items: &'a [Item], into: &mut Vec<&'a Item>) {
    for item in items {
        into.push(item);
        if let ItemKind::Phase { items, .. } = &item.kind {
            flatten(items, into);
        }
    }
}

/// All names that are mentioned, directly or through definitions, by items of some kinds.
fn reached<'a>(items: &[&'a Item], is_root: fn(&ItemKind) -> bool) -> HashSet<&'a str> {
    let mut definitions: HashMap<&str, Vec<&'a Item>> = HashMap::new();
    let mut pending: Vec<&'a Item> = Vec::new();
    for item in items {
        match (&item.kind, declared(item)) {
            (
                ItemKind::Let { .. }
                | ItemKind::Const { .. }
                | ItemKind::Fn { .. }
                | ItemKind::Surface { .. },
                Some(name),
            ) => definitions.entry(&name.name).or_default().push(item),
            _ if is_root(&item.kind) => pending.push(item),
            _ => {}
        }
    }
    let mut seen = HashSet::new();
    while let Some(item) = pending.pop() {
        mentioned(item, &mut |name| {
            if seen.insert(name) {
                pending.extend(definitions.get(name).into_iter().flatten());
            }
        });
    }
    seen
}

/// The names an item mentions, in expressions and otherwise.
fn mentioned<'a>(item: &'a Item, see: &mut dyn FnMut(&'a str)) {
    for expr in walk::expressions(item) {
        walk::names(expr, &mut |name, _| see(name));
    }
    match &item.kind {
        ItemKind::Jump { surface, then_hold, .. } => {
            std::iter::once(surface).chain(then_hold).for_each(|it| see(&it.name))
        }
        ItemKind::Guess { bindings } => bindings.iter().for_each(|it| see(&it.name.name)),
        _ => {}
    }
}
