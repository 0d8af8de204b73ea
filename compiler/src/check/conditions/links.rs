//! Links between phases: both phases exist, and so do the states that are handed over.

use crate::check::facts::Facts;
use crate::syntax::scope::{declared, kind_word};
use crate::syntax::walk;
use fdcc_grammar::ast::{Assignment, Ident, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic};

/// Reports links that lead nowhere.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let names: Vec<&str> =
        facts.tree.items.iter().filter_map(declared).map(|name| name.name.as_str()).collect();
    for item in &facts.items {
        let ItemKind::Link { from, to, assignments } = &item.kind else { continue };
        let [source, target] = [from, to].map(|phase| find_phase(facts, phase, found));
        for assignment in assignments {
            if let Some(target) = target {
                check_target(assignment, target, found);
            }
            if let Some(source) = source {
                check_source(assignment, source, &names, found);
            }
        }
    }
}

fn find_phase<'a>(
    facts: &Facts<'a, '_>,
    phase: &Ident,
    found: &mut Vec<Diagnostic>,
) -> Option<&'a [Item]> {
    let scope = &facts.meaning.scope;
    let Some(at) = scope.find(&phase.name) else {
        found.push(scope.unknown(
            &phase.name,
            phase.span,
            &[],
            &format!("phase {} {{ ... }}", phase.name),
        ));
        return None;
    };
    let item = scope.declarations[at].item;
    if let ItemKind::Phase { items, .. } = &item.kind {
        return Some(items);
    }
    let message = format!("`{}` is a {}, not a phase", phase.name, kind_word(item));
    found.push(
        Diagnostic::new(Code::WrongKind, message, phase.span, "a phase is needed here")
            .help("name a `phase`"),
    );
    None
}

fn check_target(assignment: &Assignment, target: &[Item], found: &mut Vec<Diagnostic>) {
    let name = &assignment.name;
    let is_it = |item: &&Item| declared(item).is_some_and(|it| it.name == name.name);
    if !target.iter().any(|item| is_it(&item) && matches!(item.kind, ItemKind::State { .. })) {
        let message = format!("the phase after the link has no state `{}`", name.name);
        let diagnostic =
            Diagnostic::new(Code::UnknownName, message, name.span, "not a state there");
        found.push(diagnostic.help(format!("declare it in that phase: `state {}`", name.name)));
    }
}

fn check_source(
    assignment: &Assignment,
    source: &[Item],
    outer: &[&str],
    found: &mut Vec<Diagnostic>,
) {
    walk::names(&assignment.value, &mut |name, span| {
        let known = source.iter().filter_map(declared).any(|it| it.name == name)
            || outer.contains(&name)
            || name == "pi";
        if !known && !crate::syntax::functions::is_function(name) {
            let message = format!("nothing called `{name}` in the phase before the link");
            let diagnostic =
                Diagnostic::new(Code::UnknownName, message, span, "not declared there");
            found.push(
                diagnostic
                    .help("the right side of a link is read at the end of the phase before it"),
            );
        }
    });
}
