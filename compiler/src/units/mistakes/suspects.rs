//! What several texts that do not fit have in common: perhaps a definition, and then it is what is
//! wrong.
//!
//! The definition is taken for unknown and its uses are asked for its unit first. If they agree on
//! one, so that fewer texts are left that do not fit, its value is what does not fit. Texts that
//! have nothing to do with each other are told together.

use crate::syntax::{scope, walk};
use crate::units::inference::requirement::{Reason, Requirement};
use crate::units::inference::walk::{Known, Walk};
use fdcc_grammar::Span;
use fdcc_grammar::ast::{self, Expr, Ident, Item, ItemKind};
use std::collections::{HashMap, HashSet};

/// Definitions beyond these are not tried.
const MOST_TRIALS: usize = 6;

/// What is wrong for sure after a walk: a walk in which it is told, and which texts of that.
pub(crate) struct Found<'a> {
    /// The walk.
    pub walk: Walk<'a>,
    /// Its requirements that are mistakes; none if everything fits.
    pub mistakes: Vec<usize>,
    /// The definition that its uses contradict.
    pub suspect: Option<Span>,
}

/// The chosen text, or the definition that it and others contradict, and everything that has
/// nothing to do with it.
pub(crate) fn found<'a>(tree: &'a ast::Model, known: &Known, walk: Walk<'a>) -> Found<'a> {
    let Some(first) = walk.first else {
        return Found { walk, mistakes: Vec::new(), suspect: None };
    };
    if walk.contradictions.len() == 1 {
        return Found { walk, mistakes: vec![first], suspect: None };
    }
    let definitions = definitions(tree);
    let of = |at: usize| (at, used(&walk.inference.requirements[at], &definitions));
    let used: HashMap<usize, Vec<Definition<'a>>> =
        walk.contradictions.iter().copied().map(of).collect();
    let origins = origins(&walk, &used);
    let mut uses: HashMap<Span, usize> = HashMap::new();
    origins
        .iter()
        .flat_map(|at| &used[at])
        .for_each(|it| *uses.entry(it.name.span).or_default() += 1);
    let is_shared = |it: &&Definition<'_>| uses.get(&it.name.span).is_some_and(|&count| count > 1);
    let shared = used[&first].iter().filter(is_shared).filter(|it| it.is_number());
    let tried: Vec<Span> = shared.map(|it| it.name.span).take(MOST_TRIALS).collect();
    let mut trials = tried.iter().filter(|name| !known.suspects.contains(name));
    if let Some(found) = trials.find_map(|&name| trial(tree, known, (name, uses[&name]), &walk)) {
        return found;
    }
    let is_alone = |at: &usize| {
        let it = &walk.inference.requirements[*at];
        let is_known = it.left.dimension.is_known() && it.right.dimension.is_known();
        let shares = used[at].iter().filter(is_shared).any(|it| !tried.contains(&it.name.span));
        *at != first && is_known && it.calls.is_empty() && !shares
    };
    let mistakes = std::iter::once(first).chain(origins.into_iter().filter(is_alone)).collect();
    Found { mistakes, suspect: None, walk }
}

/// The texts that do not fit by themselves: no other lies in them, nor in a definition that they
/// use.
fn origins(walk: &Walk<'_>, used: &HashMap<usize, Vec<Definition<'_>>>) -> Vec<usize> {
    let site = |at: usize| walk.inference.requirements[at].site;
    let wrong: Vec<Span> = walk.contradictions.iter().map(|&at| site(at)).collect();
    let holds = |outer: Span, inner: &Span| outer.start <= inner.start && inner.end <= outer.end;
    let follows = |at: usize| {
        wrong.iter().any(|it| *it != site(at) && holds(site(at), it))
            || used[&at]
                .iter()
                .any(|definition| wrong.iter().any(|it| holds(definition.value.span, it)))
    };
    walk.contradictions.iter().copied().filter(|&at| !follows(at)).collect()
}

/// Whether all texts fit that use a definition, so many, if it is what they say.
fn trial<'a>(
    tree: &'a ast::Model,
    known: &Known,
    (name, uses): (Span, usize),
    so_far: &Walk<'a>,
) -> Option<Found<'a>> {
    let mut known = known.clone();
    known.suspects.insert(name);
    let walk = Walk::new(tree, known, false);
    let is_it = |at: &&usize| {
        let reason = &walk.inference.requirements[**at].reason;
        matches!(reason, Reason::Uses(it) if it.span == name)
    };
    let blamed = walk.contradictions.iter().find(is_it).copied()?;
    let is_better = walk.contradictions.len() + uses <= so_far.contradictions.len() + 1;
    is_better.then(|| Found { walk, mistakes: vec![blamed], suspect: Some(name) })
}

/// What is defined by a value.
#[derive(Clone, Copy)]
struct Definition<'a> {
    name: &'a Ident,
    item: &'a Item,
    value: &'a Expr,
}

impl Definition<'_> {
    /// Whether it is a quantity, not a function.
    fn is_number(&self) -> bool {
        !matches!(self.item.kind, ItemKind::Fn { .. })
    }
}

fn definitions(tree: &ast::Model) -> HashMap<&str, Definition<'_>> {
    let inner = tree.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Phase { items, .. } => Some(items),
        _ => None,
    });
    let all = tree.items.iter().chain(inner.flatten());
    let definition =
        |item| Some(Definition { name: scope::declared(item)?, item, value: value_of(item)? });
    all.filter_map(definition).map(|it| (it.name.name.as_str(), it)).collect()
}

fn value_of(item: &Item) -> Option<&Expr> {
    match &item.kind {
        ItemKind::Param { value, .. } => value.as_ref(),
        ItemKind::Const { value, .. }
        | ItemKind::Let { value, .. }
        | ItemKind::Signal { value, .. } => Some(value),
        ItemKind::Fn { body, .. } => Some(body),
        _ => None,
    }
}

/// The definitions that both sides are made of, the nearest first.
fn used<'a>(
    requirement: &Requirement<'a>,
    definitions: &HashMap<&str, Definition<'a>>,
) -> Vec<Definition<'a>> {
    let mut texts: Vec<&'a Expr> =
        [&requirement.left, &requirement.right].iter().filter_map(|it| it.expr).collect();
    let (mut seen, mut found) = (HashSet::new(), Vec::new());
    let mut next = 0;
    while let Some(text) = texts.get(next).copied() {
        next += 1;
        walk::names(text, &mut |name, _| {
            let Some(definition) = definitions.get(name).filter(|it| seen.insert(it.name.span))
            else {
                return;
            };
            texts.push(definition.value);
            found.push(*definition);
        });
    }
    found
}
