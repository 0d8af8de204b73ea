//! `phase coast like boost { ... }`: a text in which each phase has written out what it takes over.
//!
//! What is named is replaced by what the phase itself declares under that name, its time by its
//! time, an equation, a report or a weight by one of the same name, a condition by one with the
//! same left side. The start of a state that a link hands over is left behind, and so is what is
//! expected.

use super::each::numbered;
use super::scope::{declared, kind_word};
use super::{closest, text};
use fdcc_grammar::ast::{self, Condition, Ident, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Fix};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

/// No sensible text takes over so many items.
const MOST_ITEMS: usize = 100_000;

/// The text with all items written out; tells phases that are like none.
pub(crate) fn written_out<'t>(
    tree: &'t ast::Model,
    diagnostics: &mut Vec<Diagnostic>,
) -> Cow<'t, ast::Model> {
    let is_like = |item: &Item| matches!(&item.kind, ItemKind::Phase { like: Some(_), .. });
    if !tree.items.iter().any(is_like) {
        return Cow::Borrowed(tree);
    }
    let mut copies = Copies::new(&tree.items);
    let items = tree.items.iter().map(|item| copies.item(item, diagnostics)).collect();
    Cow::Owned(ast::Model { items, ..tree.clone() })
}

/// A phase with the one that it is like.
type Phase<'t> = (&'t Item, &'t [Item], Option<&'t Ident>);

struct Copies<'t> {
    items: &'t [Item],
    phases: HashMap<&'t str, Phase<'t>>,
    /// How many items have been written out.
    count: usize,
}

impl<'t> Copies<'t> {
    fn new(items: &'t [Item]) -> Self {
        let mut phases = HashMap::new();
        for item in items {
            if let ItemKind::Phase { name, like, items, .. } = &item.kind {
                phases.entry(name.name.as_str()).or_insert((item, &items[..], like.as_ref()));
            }
        }
        Copies { items, phases, count: 0 }
    }

    fn item(&mut self, item: &'t Item, diagnostics: &mut Vec<Diagnostic>) -> Item {
        let ItemKind::Phase { name, like: Some(like), each, items } = &item.kind else {
            return item.clone();
        };
        let items = match self.line(name, like) {
            Ok(line) => self.written(name, line, items),
            Err(found) => {
                diagnostics.push(found);
                items.clone()
            }
        };
        let kind = ItemKind::Phase { name: name.clone(), like: None, each: each.clone(), items };
        Item { kind, span: item.span }
    }

    /// The phases whose items are taken over, the nearest first.
    fn line(&self, name: &'t Ident, like: &'t Ident) -> Result<Vec<&'t [Item]>, Diagnostic> {
        let mut line = Vec::new();
        let mut seen = HashSet::from([name.name.as_str()]);
        let (mut next, mut count) = (Some(like), self.count);
        while let Some(like) = next {
            let Some((_, items, after)) = self.phases.get(like.name.as_str()) else {
                return Err(self.no_phase(like));
            };
            count += items.len();
            if !seen.insert(&like.name) || count > MOST_ITEMS {
                return Err(circular(name, like));
            }
            line.push(*items);
            next = *after;
        }
        Ok(line)
    }

    fn written(&mut self, name: &Ident, line: Vec<&'t [Item]>, own: &'t [Item]) -> Vec<Item> {
        let mut all: Vec<Item> = Vec::new();
        for items in line.into_iter().rev().chain([own]) {
            let kept = std::mem::take(&mut all).into_iter();
            all = kept.filter_map(|item| without(item, items)).collect();
            all.extend(items.iter().cloned());
        }
        self.count += all.len();
        let given = self.handed_over(name);
        let is_own = |item: &Item| own.iter().any(|it| it.span == item.span);
        for item in all.iter_mut().filter(|item| !is_own(item)) {
            if let ItemKind::State { name, start, .. } = &mut item.kind
                && given.as_ref().is_none_or(|given| given.contains(name.name.as_str()))
            {
                *start = None;
            }
        }
        let is_asked =
            |item: &Item| matches!(item.kind, ItemKind::Expect { .. } | ItemKind::Sweep { .. });
        all.retain(|item| is_own(item) || !is_asked(item));
        all
    }

    /// The states that links hand over to a phase; nothing if that is all of them.
    fn handed_over(&self, phase: &Ident) -> Option<HashSet<&'t str>> {
        let mut given = HashSet::new();
        for item in self.items {
            if let ItemKind::Link { to, same, assignments, .. } = &item.kind
                && to.name == phase.name
            {
                given.extend(assignments.iter().map(|it| it.name.name.as_str()));
                if same.is_some() {
                    return None;
                }
            }
        }
        Some(given)
    }

    fn no_phase(&self, like: &Ident) -> Diagnostic {
        if self.phases.contains_key(numbered(&like.name, 1).as_str()) {
            let message = format!("`{}` is a phase for each file", like.name);
            let label = "one of them is not like another";
            return Diagnostic::new(Code::WrongKind, message, like.span, label).help(format!(
                "write what both share into a phase, and let both be like it: \
                 `phase {} like base for each csv(...) ...`",
                like.name
            ));
        }
        let other = self
            .items
            .iter()
            .find(|item| declared(item).is_some_and(|name| name.name == like.name));
        if let Some(other) = other {
            let kind = kind_word(other);
            let message = format!("`{}` is a {kind}, not a phase", like.name);
            return Diagnostic::new(Code::WrongKind, message, like.span, "a phase is needed here")
                .help("name a `phase`");
        }
        let message = format!("nothing called `{}` here", like.name);
        let found = Diagnostic::new(Code::UnknownName, message, like.span, "not declared");
        let mut names: Vec<&str> = self.phases.keys().copied().collect();
        names.sort_unstable();
        match closest(&like.name, names.into_iter()) {
            Some(near) => {
                let change = format!("change `{}` to `{near}`", like.name);
                found.help(&change).fix(Fix::likely(change).replace(like.span, near))
            }
            None => found.help(format!("declare it, for example `phase {} {{ ... }}`", like.name)),
        }
    }
}

fn circular(name: &Ident, like: &Ident) -> Diagnostic {
    let message = format!("`{}` takes over too much, or itself", name.name);
    Diagnostic::new(Code::CircularDefinition, message, name.span, "like a phase that is like it")
        .label(like.span, "this closes the circle, or is one too many")
        .help("write the items of one of them out")
}

/// An item, as far as later ones do not replace it.
fn without(item: Item, later: &[Item]) -> Option<Item> {
    let Item { mut kind, span } = item;
    let is_left = match &mut kind {
        ItemKind::Dynamics { equations } => {
            equations.retain(|it| !moves(later, &it.state.name));
            !equations.is_empty()
        }
        ItemKind::Report { bindings } => {
            bindings.retain(|it| !reports(later, &it.name.name));
            !bindings.is_empty()
        }
        ItemKind::Metric { weights } => {
            weights.retain(|it| !weighs(later, &it.0.name));
            !weights.is_empty()
        }
        _ => return without_whole(Item { kind, span }, later),
    };
    is_left.then_some(Item { kind, span })
}

fn without_whole(item: Item, later: &[Item]) -> Option<Item> {
    (!later.iter().any(|it| replaces(it, &item))).then_some(item)
}

fn moves(items: &[Item], state: &str) -> bool {
    items.iter().any(|item| match &item.kind {
        ItemKind::Dynamics { equations } => equations.iter().any(|it| it.state.name == state),
        _ => false,
    })
}

fn reports(items: &[Item], name: &str) -> bool {
    items.iter().any(|item| match &item.kind {
        ItemKind::Report { bindings } => bindings.iter().any(|it| it.name.name == name),
        _ => false,
    })
}

fn weighs(items: &[Item], state: &str) -> bool {
    items.iter().any(|item| match &item.kind {
        ItemKind::Metric { weights } => weights.iter().any(|it| it.0.name == state),
        _ => false,
    })
}

fn replaces(later: &Item, item: &Item) -> bool {
    let left = |condition: &Condition| text::expr(&condition.first);
    match (&later.kind, &item.kind) {
        (ItemKind::Time { .. }, ItemKind::Time { .. })
        | (ItemKind::Objective { .. }, ItemKind::Objective { .. })
        | (ItemKind::Fit { .. }, ItemKind::Fit { .. }) => true,
        (ItemKind::Start { condition: a }, ItemKind::Start { condition: b })
        | (ItemKind::End { condition: a }, ItemKind::End { condition: b }) => left(a) == left(b),
        _ => named(later).is_some() && named(later) == named(item),
    }
}

/// The name of an item by which it is replaced.
fn named(item: &Item) -> Option<&str> {
    let own = match &item.kind {
        ItemKind::Jump { name, .. }
        | ItemKind::Path { name: Some(name), .. }
        | ItemKind::Plot { name, .. } => Some(name),
        _ => declared(item),
    };
    own.map(|name| name.name.as_str())
}
