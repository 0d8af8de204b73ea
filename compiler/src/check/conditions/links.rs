//! FDC0102: a link, or a state in one, that is given twice; FDC0412: a link onto a start that is
//! given; FDC0413: a state that a link leaves out.

use crate::check::facts::Facts;
use crate::syntax::scope::declared;
use fdcc_grammar::ast::{Assignment, Ident, Item, ItemKind, Start};
use fdcc_grammar::{Code, Diagnostic, Fix, Span};
use std::collections::HashMap;

/// Reports links that say something twice, or too little.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let mut phases: HashMap<&str, &[Item]> = HashMap::new();
    let mut known: HashMap<(&str, &str), Span> = HashMap::new();
    for item in &facts.items {
        if let ItemKind::Phase { name, items } = &item.kind {
            phases.entry(&name.name).or_insert(items);
        }
    }
    for item in &facts.items {
        let ItemKind::Link { from, to, assignments } = &item.kind else { continue };
        let place = from.span.to(to.span);
        if let Some(first) = known.insert((&from.name, &to.name), place) {
            let what = format!("`{}` is linked to `{}` twice", from.name, to.name);
            found.push(twice(what, place, first, "write all that is handed over into one link"));
        }
        given_twice(assignments, found);
        let (Some(source), Some(target)) =
            (phases.get(from.name.as_str()), phases.get(to.name.as_str()))
        else {
            continue;
        };
        for state in states(target) {
            let given = assignments.iter().find(|it| it.name.name == state.name.name);
            match given {
                Some(given) => found.extend(onto_start(given, &state)),
                None if state.start.is_none() && states(source).any(|it| it.is_like(&state)) => {
                    found.push(left_out(item, place, state.name));
                }
                None => {}
            }
        }
    }
}

/// A state of a phase.
struct State<'a> {
    name: &'a Ident,
    parts: usize,
    start: Option<&'a Start>,
}

impl State<'_> {
    fn is_like(&self, other: &State<'_>) -> bool {
        self.name.name == other.name.name && self.parts == other.parts
    }
}

fn states(items: &[Item]) -> impl Iterator<Item = State<'_>> {
    items.iter().filter_map(|item| match &item.kind {
        ItemKind::State { parts, start, .. } => {
            Some(State { name: declared(item)?, parts: parts.len(), start: start.as_ref() })
        }
        _ => None,
    })
}

fn given_twice(assignments: &[Assignment], found: &mut Vec<Diagnostic>) {
    let mut known: HashMap<&str, Span> = HashMap::new();
    for assignment in assignments {
        let name = &assignment.name;
        if let Some(first) = known.insert(&name.name, name.span) {
            let what = format!("`{}` is handed over twice", name.name);
            found.push(twice(what, name.span, first, "keep one of them"));
        }
    }
}

fn twice(what: String, place: Span, first: Span, help: &str) -> Diagnostic {
    Diagnostic::new(Code::DuplicateName, what, place, "again").label(first, "first here").help(help)
}

fn onto_start(given: &Assignment, state: &State<'_>) -> Option<Diagnostic> {
    let Some(Start::Value(value)) = state.start else { return None };
    let name = &state.name.name;
    let message = format!("`{name}` has a start, and a link gives it another");
    let found =
        Diagnostic::new(Code::LinkedStart, message, given.name.span, "handed over by the link");
    let declared = state.name.span.to(value.span);
    Some(found.label(declared, "its start is given here").help(format!(
        "leave out `start` in the phase, or `{name}` in the link; to meet a value on the way write \
         the condition `start {name} == ...`"
    )))
}

fn left_out(link: &Item, place: Span, name: &Ident) -> Diagnostic {
    let message = format!("the link leaves out `{}`, a state of both phases", name.name);
    let found = Diagnostic::new(Code::LeftOut, message, place, "it may jump here");
    let line = format!("{0} := {0}", name.name);
    let before = Span { start: link.span.end - 1, end: link.span.end - 1 };
    found
        .label(name.span, "begins anew here")
        .help(format!("to go on, write `{line}`; if it is to begin anew, say `start free`"))
        .fix(Fix::likely(format!("write `{line}`")).insert(before.start, format!("{line} ")))
}
