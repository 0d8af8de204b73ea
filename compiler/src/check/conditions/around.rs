//! What has its place either outside of all phases or within them: time, the objective, sweeps.

use crate::check::facts::Facts;
use fdcc_grammar::ast::{Item, ItemKind, Sense};
use fdcc_grammar::{Code, Diagnostic, Span};

/// Reports a time outside of all phases, objectives on both sides, and sweeps within a phase.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let inner = || facts.items.iter().filter_map(|item| items_of(item)).flatten();
    for item in &facts.items {
        if let ItemKind::Time { name, .. } = &item.kind {
            let message = "a time outside of all phases";
            let what = Diagnostic::new(Code::NotAllowedHere, message, name.span, "of which phase?");
            found.push(what.help("each phase has its own time: move it there"));
        }
    }
    let outer = facts.items.iter().copied().find_map(objective);
    let mut first: Option<(Sense, Span)> = None;
    for (sense, place) in inner().filter_map(objective) {
        match (&outer, &first) {
            (Some((_, outer)), _) => found.push(both(place, *outer)),
            (None, Some((other, before))) if *other != sense => found.push(opposed(place, *before)),
            _ => first = first.or(Some((sense, place))),
        }
    }
    for item in inner() {
        if let ItemKind::Sweep { .. } = item.kind {
            let message = "a sweep within a phase";
            let what = Diagnostic::new(Code::NotAllowedHere, message, item.span, "of the whole");
            found.push(what.help("move it outside of all phases: a run solves all of them"));
        }
    }
}

fn items_of(item: &Item) -> Option<&[Item]> {
    match &item.kind {
        ItemKind::Phase { items, .. } => Some(items),
        _ => None,
    }
}

fn objective(item: &Item) -> Option<(Sense, Span)> {
    match &item.kind {
        ItemKind::Objective { sense, keyword, .. } => Some((*sense, *keyword)),
        ItemKind::Fit { keyword, .. } => Some((Sense::Minimize, *keyword)),
        _ => None,
    }
}

fn both(place: Span, outer: Span) -> Diagnostic {
    let message = "an objective within a phase and one outside of all phases";
    Diagnostic::new(Code::DuplicateName, message, place, "of this phase")
        .label(outer, "of the whole")
        .help("add them up outside, or write one into each phase: their sum counts")
}

fn opposed(place: Span, before: Span) -> Diagnostic {
    let message = "one phase is minimised and another maximised";
    Diagnostic::new(Code::NotAllowedHere, message, place, "the other way round")
        .label(before, "the first objective")
        .help("the objectives of phases are added up: give one of them the other sign")
}
