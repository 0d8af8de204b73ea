//! FDC0102: a link, or a state in one, that is given twice; FDC0412: a link onto a start that is
//! given; FDC0413: a state that a link leaves out, and neighbours that no link ties together.

use crate::check::facts::Facts;
use crate::syntax::scope::declared;
use crate::syntax::text;
use fdcc_grammar::ast::{Assignment, Ident, Interval, Item, ItemKind, Start};
use fdcc_grammar::{Code, Diagnostic, Fix, Span};
use std::collections::HashMap;

/// Reports links that say something twice, or too little.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    unlinked(facts, found);
    let mut phases: HashMap<&str, &[Item]> = HashMap::new();
    let mut known: HashMap<(&str, &str), Span> = HashMap::new();
    for item in &facts.items {
        if let ItemKind::Phase { name, items, .. } = &item.kind {
            phases.entry(&name.name).or_insert(items);
        }
    }
    for item in &facts.items {
        let ItemKind::Link { from, to, same, assignments } = &item.kind else { continue };
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
            let given: Vec<&Assignment> =
                assignments.iter().filter(|it| it.name.name == state.name.name).collect();
            let goes_on = || states(source).any(|it| it.is_like(&state));
            let by_same = same.filter(|_| goes_on());
            let place_of = given.first().map(|it| it.name.span).or(by_same);
            found.extend(place_of.and_then(|place| onto_start(place, &state)));
            let is_all = given.iter().any(|it| it.part.is_none());
            if !is_all && state.start.is_none() && same.is_none() && goes_on() {
                let missing = state.missing(&given);
                found
                    .extend((!missing.is_empty()).then(|| left_out(item, place, &state, &missing)));
            }
        }
    }
}

/// Reports neighbours in time that no link ties together, where a state of both would begin anew.
fn unlinked(facts: &Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let phases = facts.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Phase { name, items, .. } => Some((name, &items[..])),
        _ => None,
    });
    let phases: Vec<(&Ident, &[Item])> = phases.collect();
    let is_tied = |before: &Ident, name: &Ident| {
        facts.items.iter().any(|item| match &item.kind {
            ItemKind::Link { from, to, .. } => to.name == name.name || from.name == before.name,
            _ => false,
        })
    };
    for pair in phases.windows(2) {
        let [(before, source), (name, target)] = pair else { unreachable!("windows of two") };
        let (Some(ends), Some(begins)) = (interval(source), interval(target)) else { continue };
        let follows = text::expr(&ends.upper) == text::expr(&begins.lower);
        let anew = states(target)
            .find(|it| it.start.is_none() && states(source).any(|own| own.is_like(it)));
        let Some(state) = anew.filter(|_| follows && !is_tied(before, name)) else { continue };
        let message = format!("no link leads from `{}` to `{}`", before.name, name.name);
        let found_one = Diagnostic::new(Code::LeftOut, message, name.span, "a phase of its own");
        let found_one = found_one.label(state.name.span, "begins anew here");
        found.push(found_one.help(format!(
            "to go on, write `link {} -> {} {{ same }}`; if it is to begin anew, say `start free`",
            before.name, name.name
        )));
    }
}

fn interval(items: &[Item]) -> Option<&Interval> {
    items.iter().find_map(|item| match &item.kind {
        ItemKind::Time { interval, .. } => Some(interval),
        _ => None,
    })
}

/// A state of a phase.
struct State<'a> {
    name: &'a Ident,
    parts: &'a [Ident],
    start: Option<&'a Start>,
}

impl State<'_> {
    fn is_like(&self, other: &State<'_>) -> bool {
        self.name.name == other.name.name && self.parts.len() == other.parts.len()
    }

    /// What no line of a link gives a value: `x`, or parts such as `p.x`.
    fn missing(&self, given: &[&Assignment]) -> Vec<String> {
        let name = &self.name.name;
        if given.is_empty() {
            return vec![name.clone()];
        }
        let is_given = |part: &&Ident| {
            given.iter().any(|it| it.part.as_ref().is_some_and(|it| it.name == part.name))
        };
        let missing = self.parts.iter().filter(|part| !is_given(part));
        missing.map(|part| format!("{name}.{}", part.name)).collect()
    }
}

fn states(items: &[Item]) -> impl Iterator<Item = State<'_>> {
    items.iter().filter_map(|item| match &item.kind {
        ItemKind::State { parts, start, .. } => {
            Some(State { name: declared(item)?, parts, start: start.as_ref() })
        }
        _ => None,
    })
}

fn given_twice(assignments: &[Assignment], found: &mut Vec<Diagnostic>) {
    let mut known: HashMap<(&str, Option<&str>), Span> = HashMap::new();
    for assignment in assignments {
        let (name, part) = (&assignment.name, assignment.part.as_ref());
        let whole = known.get(&(name.name.as_str(), None)).copied();
        let before = known.insert((&name.name, part.map(|it| it.name.as_str())), name.span);
        if let Some(first) = before.or(whole) {
            let what = format!("`{}` is handed over twice", name.name);
            found.push(twice(what, name.span, first, "keep one of them"));
        }
    }
}

fn twice(what: String, place: Span, first: Span, help: &str) -> Diagnostic {
    Diagnostic::new(Code::DuplicateName, what, place, "again").label(first, "first here").help(help)
}

fn onto_start(given: Span, state: &State<'_>) -> Option<Diagnostic> {
    let Some(Start::Value(value)) = state.start else { return None };
    let name = &state.name.name;
    let message = format!("`{name}` has a start, and a link gives it another");
    let found = Diagnostic::new(Code::LinkedStart, message, given, "handed over by the link");
    let declared = state.name.span.to(value.span);
    Some(found.label(declared, "its start is given here").help(format!(
        "leave out `start` in the phase, or `{name}` in the link; to meet a value on the way write \
         the condition `start {name} == ...`"
    )))
}

fn left_out(link: &Item, place: Span, state: &State<'_>, missing: &[String]) -> Diagnostic {
    let names = missing.join("`, `");
    let message = format!("the link leaves out `{names}` of both phases");
    let found = Diagnostic::new(Code::LeftOut, message, place, "it may jump here");
    let lines: Vec<String> = missing.iter().map(|name| format!("{name} := {name}")).collect();
    let lines = lines.join("  ");
    let help = format!(
        "to go on, write `{lines}`, or `same` for all states that are not given; if it is to begin \
         anew, say `start free`"
    );
    found
        .label(state.name.span, "begins anew here")
        .help(help)
        .fix(Fix::likely(format!("write `{lines}`")).insert(link.span.end - 1, format!("{lines} ")))
}
