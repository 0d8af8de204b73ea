//! FDC0404: names that nothing mentions.
//!
//! Mentions are followed through definitions: what only an unused `let` mentions is unused. A
//! control or an unknown must be mentioned by the problem itself; a guess or a report does not
//! count. Names that begin with `_` are silent, and so are states, whose equation is their use, and
//! time.

use crate::syntax::each::phase_named;
use crate::syntax::scope::{declared, kind_word};
use crate::syntax::walk;
use fdcc_grammar::ast::{self, Expr, ExprKind, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Fix};
use std::collections::{HashMap, HashSet};

/// Reports unused names of the whole file.
pub(crate) fn check(tree: &ast::Model) -> Vec<Diagnostic> {
    let mut items: Vec<&Item> = Vec::new();
    flatten(&tree.items, &mut items);
    let phases: HashSet<&str> = items.iter().filter_map(|item| phase(item)).collect();
    let mentions: Vec<Vec<&str>> = items.iter().map(|item| mentioned(item, &phases)).collect();
    let anywhere = reached(&items, &mentions, |_| true);
    let problem = reached(&items, &mentions, |kind| {
        !matches!(
            kind,
            ItemKind::Guess { .. }
                | ItemKind::Report { .. }
                | ItemKind::Plot { .. }
                | ItemKind::Sweep { .. }
                | ItemKind::Expect { .. }
                | ItemKind::Method { .. }
        )
    });
    let found = items.iter().filter_map(|item| Some((item, unused(item, &anywhere, &problem)?)));
    let all: HashSet<&str> = mentions.iter().flatten().copied().collect();
    found.map(|(item, diagnostic)| with_fix(item, diagnostic, &all)).collect()
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

/// The new name, where nothing has to follow it: a guess or another unused definition may use the
/// old one.
fn with_fix(item: &Item, found: Diagnostic, mentions: &HashSet<&str>) -> Diagnostic {
    match declared(item).filter(|name| !mentions.contains(name.name.as_str())) {
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
fn reached<'a>(
    items: &[&'a Item],
    mentions: &[Vec<&'a str>],
    is_root: fn(&ItemKind) -> bool,
) -> HashSet<&'a str> {
    let mut definitions: HashMap<&str, Vec<usize>> = HashMap::new();
    let mut pending: Vec<usize> = Vec::new();
    for (at, item) in items.iter().enumerate() {
        match (&item.kind, declared(item)) {
            (
                ItemKind::Let { .. }
                | ItemKind::Signal { .. }
                | ItemKind::Const { .. }
                | ItemKind::Fn { .. }
                | ItemKind::Surface { .. },
                Some(name),
            ) => definitions.entry(&name.name).or_default().push(at),
            _ if is_root(&item.kind) => pending.push(at),
            _ => {}
        }
    }
    let mut seen = HashSet::new();
    while let Some(at) = pending.pop() {
        for &name in &mentions[at] {
            if seen.insert(name) {
                pending.extend(definitions.get(name).into_iter().flatten());
            }
        }
    }
    seen
}

fn phase(item: &Item) -> Option<&str> {
    match &item.kind {
        ItemKind::Phase { name, .. } => Some(&name.name),
        _ => None,
    }
}

/// The names an item mentions, in expressions and otherwise; `q` of `PHASE.q`, too.
fn mentioned<'a>(item: &'a Item, phases: &HashSet<&str>) -> Vec<&'a str> {
    let mut names = Vec::new();
    for expr in walk::expressions(item) {
        walk::names(expr, &mut |name, _| names.push(name));
        let mut of_phase = |inner: &'a Expr| {
            if let ExprKind::Part(base, part) = &inner.kind
                && phase_named(base).is_some_and(|name| phases.contains(&*name))
            {
                names.push(&part.name);
            }
        };
        if !phases.is_empty() {
            walk::visit(expr, &mut of_phase);
        }
    }
    match &item.kind {
        ItemKind::Jump { surface, then_hold, .. } => {
            names.extend(std::iter::once(surface).chain(then_hold).map(|it| it.name.as_str()))
        }
        ItemKind::Fit { data, .. } => names.push(&data.name),
        ItemKind::Guess { bindings } => {
            names.extend(bindings.iter().map(|it| it.name.name.as_str()))
        }
        _ => {}
    }
    names
}
