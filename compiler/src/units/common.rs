//! Several texts that do not fit and have a definition in common: then the definition is what is wrong.
//!
//! The definition is taken for unknown and its uses are asked for its unit first. If they agree on one, so that fewer texts
//! are left that do not fit, its value is what does not fit.

use super::requirement::{Reason, Requirement};
use super::{Known, Walk};
use crate::resolve::{scope, walk};
use fdcc_grammar::Span;
use fdcc_grammar::ast::{self, Expr, Ident, Item, ItemKind};
use std::collections::HashMap;

/// Definitions beyond these are not tried.
const MOST_TRIALS: usize = 6;

/// A walk in which the definition that the chosen text and others have in common is the one that is wrong.
pub(crate) fn blamed<'a>(tree: &'a ast::Model, known: &Known, so_far: &Walk<'a>) -> Option<(Span, Walk<'a>)> {
    let first = so_far.first?;
    let requirements = &so_far.inference.requirements;
    let others: Vec<usize> = so_far.contradictions.iter().copied().filter(|&at| at != first).collect();
    if others.is_empty() {
        return None;
    }
    let definitions = definitions(tree);
    let of = |at: usize| used(&requirements[at], &definitions);
    let elsewhere: Vec<Span> = others.into_iter().flat_map(of).collect();
    let shared = of(first).into_iter().filter(|it| elsewhere.contains(it) && !known.suspects.contains(it));
    shared.take(MOST_TRIALS).find_map(|name| {
        let mut known = known.clone();
        known.suspects.insert(name);
        let trial = Walk::new(tree, known, false);
        let is_it = |at: &&usize| matches!(trial.inference.requirements[**at].reason, Reason::Uses(it) if it.span == name);
        let blamed = trial.contradictions.iter().find(is_it).copied();
        let is_better = blamed.is_some() && trial.contradictions.len() < so_far.contradictions.len();
        is_better.then_some((name, Walk { first: blamed, ..trial }))
    })
}

/// What is defined by a value, by its name.
type Definitions<'a> = HashMap<&'a str, (&'a Ident, &'a Item, &'a Expr)>;

fn definitions(tree: &ast::Model) -> Definitions<'_> {
    let inner = tree.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Phase { items, .. } => Some(items),
        _ => None,
    });
    let all = tree.items.iter().chain(inner.flatten());
    all.filter_map(|item| {
        let name = scope::declared(item)?;
        Some((name.name.as_str(), (name, item, value_of(item)?)))
    })
    .collect()
}

fn value_of(item: &Item) -> Option<&Expr> {
    match &item.kind {
        ItemKind::Param { value, .. } => value.as_ref(),
        ItemKind::Const { value, .. } | ItemKind::Let { value, .. } => Some(value),
        ItemKind::Fn { body, .. } => Some(body),
        _ => None,
    }
}

/// The definitions that both sides are made of, the nearest first.
fn used(requirement: &Requirement<'_>, definitions: &Definitions<'_>) -> Vec<Span> {
    let mut texts: Vec<&Expr> =
        [&requirement.left, &requirement.right].iter().filter_map(|it| it.expr).collect();
    let (mut seen, mut found) = (Vec::new(), Vec::new());
    let mut next = 0;
    while let Some(text) = texts.get(next).copied() {
        next += 1;
        walk::names(text, &mut |name, _| {
            let Some(&(name, item, value)) = definitions.get(name) else { return };
            if !seen.contains(&name.span) {
                seen.push(name.span);
                texts.push(value);
                let can_be_suspect = !matches!(item.kind, ItemKind::Fn { .. });
                found.extend(can_be_suspect.then_some(name.span));
            }
        });
    }
    found
}
