//! FDC0405: every state needs an equation.

use crate::check::facts::Facts;
use fdcc_grammar::ast::{Ident, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic};
use std::collections::HashSet;

/// Reports states that no equation moves. A state outside of all phases needs one in each.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let outer = facts.tree.items.iter().filter(|_| facts.phase.is_some());
    let around: Vec<&Item> =
        outer.filter(|item| !matches!(item.kind, ItemKind::Phase { .. })).collect();
    let equations = facts.items.iter().chain(&around).filter_map(|item| match &item.kind {
        ItemKind::Dynamics { equations } => Some(equations),
        _ => None,
    });
    let moved: HashSet<&str> =
        equations.flatten().map(|equation| equation.state.name.as_str()).collect();
    let unmoved = |items: &[&Item]| -> Vec<Ident> {
        let states = items.iter().filter_map(|item| match &item.kind {
            ItemKind::State { name, .. } => Some(name.clone()),
            _ => None,
        });
        states.filter(|name| !moved.contains(name.name.as_str())).collect()
    };
    found.extend(unmoved(&facts.items).iter().map(without_equation));
    if let Some(phase) = facts.phase {
        found.extend(unmoved(&around).iter().map(|name| without_equation_in(name, phase)));
    }
}

fn without_equation(name: &Ident) -> Diagnostic {
    let name_ = &name.name;
    let label = format!("declared as a state, but there is no `{name_}' = ...`");
    let message = format!("`{name_}` has no equation");
    Diagnostic::new(Code::NoEquation, message, name.span, label).help(format!(
        "add `{name_}' = ...` to `dynamics`, or declare it as `control {name_}` or `param {name_}`"
    ))
}

fn without_equation_in(name: &Ident, phase: &Ident) -> Diagnostic {
    let name_ = &name.name;
    let message = format!("`{name_}` has no equation in phase `{}`", phase.name);
    let label = format!("there is no `{name_}' = ...` here");
    Diagnostic::new(Code::NoEquation, message, phase.span, label)
        .label(name.span, "a state of all phases")
        .help(format!(
            "add `{name_}' = ...` to the `dynamics` of the phase, or declare `{name_}` in the \
             phases that have it"
        ))
}
