//! FDC0403: a state needs a condition at the start or at the end, or nothing ties it down.

use crate::check::facts::Facts;
use crate::syntax::scope::declared;
use crate::syntax::walk;
use fdcc_grammar::ast::{Expr, ExprKind, Ident, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic};
use std::collections::HashSet;

/// Reports states without `start`, without a `start` or `end` condition, and without a link into
/// them.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let mut tied: HashSet<&str> = HashSet::new();
    for item in &facts.items {
        if is_at_a_time(item) {
            walk::expressions(item)
                .into_iter()
                .for_each(|expr| walk::names(expr, &mut |name, _| tied.extend([name])));
        }
    }
    if let Some(phase) = facts.phase {
        tied_from_outside(&facts.tree.items, phase, &mut tied);
    }
    // What a `let` in a condition mentions is tied as well.
    for at in (0..facts.meaning.scope.declarations.len()).rev() {
        let item = facts.meaning.scope.declarations[at].item;
        if let ItemKind::Let { name, value, .. } = &item.kind
            && tied.contains(name.name.as_str())
        {
            walk::names(value, &mut |name, _| tied.extend([name]));
        }
    }
    for item in &facts.items {
        if let ItemKind::State { name, parts, start: None, .. } = &item.kind
            && !tied.contains(name.name.as_str())
        {
            found.push(untied(name, parts.len()));
        }
    }
}

/// Whether an item says what holds at one time.
fn is_at_a_time(item: &Item) -> bool {
    matches!(item.kind, ItemKind::Start { .. } | ItemKind::End { .. } | ItemKind::At { .. })
}

/// The states of a phase that links and conditions outside of all phases tie down.
fn tied_from_outside<'a>(items: &'a [Item], phase: &Ident, tied: &mut HashSet<&'a str>) {
    let mut of_phase = |expr: &'a Expr| {
        walk::visit(expr, &mut |inner| {
            if let ExprKind::Part(base, part) = &inner.kind
                && matches!(&base.kind, ExprKind::Name(name) if *name == phase.name)
            {
                tied.insert(&part.name);
            }
        });
    };
    for item in items {
        if is_at_a_time(item) {
            walk::expressions(item).into_iter().for_each(&mut of_phase);
        }
    }
    for item in items {
        let ItemKind::Link { from, to, same, assignments } = &item.kind else { continue };
        if to.name == phase.name && same.is_some() {
            tied.extend(states_of(items, from));
        }
        if to.name == phase.name {
            tied.extend(assignments.iter().map(|it| it.name.name.as_str()));
        }
        if from.name == phase.name {
            for assignment in assignments {
                walk::names(&assignment.value, &mut |name, _| tied.extend([name]));
            }
        }
    }
}

fn states_of<'a>(items: &'a [Item], phase: &Ident) -> Vec<&'a str> {
    let inner = items.iter().filter_map(|item| match &item.kind {
        ItemKind::Phase { name, items, .. } if name.name == phase.name => Some(items),
        _ => None,
    });
    let states = inner.flatten().filter(|item| matches!(item.kind, ItemKind::State { .. }));
    states.filter_map(declared).map(|name| name.name.as_str()).collect()
}

fn untied(name: &Ident, parts: usize) -> Diagnostic {
    let name_ = &name.name;
    let message = format!("state `{name_}` has neither a start nor an end condition");
    let rest = match parts {
        0 => format!("state {name_} start 0"),
        _ => format!("state {name_}(...) start ({})", vec!["0"; parts].join(", ")),
    };
    let free = if parts == 0 { format!("state {name_}") } else { format!("state {name_}(...)") };
    Diagnostic::new(
        Code::NoBoundary,
        message,
        name.span,
        format!(
            "what is \
        {name_}(0)?"
        ),
    )
    .help(format!(
        "for rest write `{rest}`\nif the optimiser may choose it, say so: `{free} start free in \
         [-1, 1]`"
    ))
}
