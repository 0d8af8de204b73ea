//! Declarations: which names there are, and what kind of thing each is.

use super::closest;
use super::each::numbered;
use fdcc_grammar::ast::{self, Ident, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Fix, Span};
use std::cell::Cell;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// A declared name and its item.
#[derive(Clone, Copy)]
pub(crate) struct Declaration<'a> {
    /// The name where it is declared.
    pub name: &'a Ident,
    /// The item.
    pub item: &'a Item,
}

/// All names of one phase with those around it, in the order of the text.
#[derive(Default)]
pub(crate) struct Scope<'a> {
    /// Every declaration; the first of a name counts.
    pub declarations: Vec<Declaration<'a>>,
    by_name: HashMap<&'a str, usize>,
    /// How many misspelt names have been compared with all others.
    compared: Cell<usize>,
}

/// Beyond this many unknown names nobody reads proposals, and each costs a comparison with all
/// declarations.
const MOST_PROPOSALS: usize = 50;

impl<'a> Scope<'a> {
    /// Collects the declarations of some items.
    pub fn new(items: &[&'a Item], diagnostics: &mut Vec<Diagnostic>) -> Self {
        let mut scope = Scope::default();
        for item in items {
            if let Some(name) = declared(item) {
                scope.declare(Declaration { name, item }, diagnostics);
            }
        }
        scope
    }

    fn declare(&mut self, new: Declaration<'a>, diagnostics: &mut Vec<Diagnostic>) {
        if is_built_in(new) {
            let message = format!("`{}` is built in and cannot be declared", new.name.name);
            let found = Diagnostic::new(
                Code::DuplicateName,
                message,
                new.name.span,
                "already has a meaning",
            );
            diagnostics.push(found.help(format!("rename it, for example `{}_`", new.name.name)));
            return;
        }
        if let Some(&first) = self.by_name.get(new.name.name.as_str()) {
            diagnostics.push(duplicate(new.name, self.declarations[first].name.span));
            return;
        }
        self.by_name.insert(&new.name.name, self.declarations.len());
        self.declarations.push(new);
    }

    /// What a name stands for.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    /// How many phases of this name were written as one, for each of several files.
    pub fn phases_of(&self, name: &str) -> Option<usize> {
        let is_there = |at: &usize| self.find(&numbered(name, *at)).is_some();
        Some((1..).take_while(is_there).count()).filter(|count| *count > 0)
    }

    /// "`run` is a phase for each file": neither a phase nor, outside of it, a data set.
    fn of_each_file(&self, name: &str, span: Span) -> Option<Diagnostic> {
        let count = self.phases_of(name)?;
        let [first, last] = [1, count].map(|at| numbered(name, at));
        let message = format!("`{name}` is a phase for each file");
        let label = match count {
            1 => format!("which one? there is `{first}`"),
            _ => format!("which one? there are `{first}` to `{last}`"),
        };
        Some(Diagnostic::new(Code::WrongKind, message, span, label).help(format!(
            "write `{first}.STATE(end)` and the like; its rows are known within it: \
             `fit {name}: ...` stands in `phase {name}`, and so does `sum(k in {name}, ...)`"
        )))
    }

    /// "There is no such name", with the nearest one that there is, or else how to declare it.
    pub fn unknown(&self, name: &str, span: Span, extra: &[&str], declaration: &str) -> Diagnostic {
        if let Some(found) = self.of_each_file(name, span) {
            return found;
        }
        let found = Diagnostic::new(
            Code::UnknownName,
            format!("nothing called `{name}` here"),
            span,
            "not declared",
        );
        let known = self.declarations.iter().map(|it| it.name.name.as_str());
        self.compared.set(self.compared.get() + 1);
        // `T` is no typo of `t`.
        let is_compared = self.compared.get() <= MOST_PROPOSALS && name.chars().nth(1).is_some();
        let known = known.chain(extra.iter().copied()).filter(|_| is_compared);
        let Some(near) = closest(name, known) else {
            return found.help(format!("declare it, for example `{declaration}`"));
        };
        let found = match self.find(near) {
            Some(at) => {
                found.label(self.declarations[at].name.span, format!("did you mean `{near}`?"))
            }
            None => found,
        };
        let change = format!("change `{name}` to `{near}`");
        found.help(&change).fix(Fix::likely(change).replace(span, near))
    }
}

fn is_built_in(new: Declaration<'_>) -> bool {
    let is_fn = matches!(new.item.kind, ItemKind::Fn { .. });
    new.name.name == "pi" || is_fn && super::functions::is_function(&new.name.name)
}

fn duplicate(name: &Ident, first: Span) -> Diagnostic {
    // `run[1]` was written as `run`.
    let written = name.name.split('[').next().unwrap_or_default();
    let message = format!("`{written}` is declared twice");
    Diagnostic::new(Code::DuplicateName, message, name.span, "declared again")
        .label(first, "first declared here")
        .help("rename one of them, or remove it")
}

/// Reports parts or arguments with the same name.
pub(crate) fn distinct(names: &[Ident], diagnostics: &mut Vec<Diagnostic>) {
    let mut seen: HashMap<&str, Span> = HashMap::new();
    for name in names {
        match seen.entry(&name.name) {
            Entry::Occupied(first) => diagnostics.push(duplicate(name, *first.get())),
            Entry::Vacant(place) => {
                place.insert(name.span);
            }
        }
    }
}

/// The name that an item declares, if any.
pub(crate) fn declared(item: &Item) -> Option<&Ident> {
    match &item.kind {
        ItemKind::Param { name, .. }
        | ItemKind::Const { name, .. }
        | ItemKind::Let { name, .. }
        | ItemKind::Signal { name, .. }
        | ItemKind::Fn { name, .. }
        | ItemKind::Data { name, .. }
        | ItemKind::Free { name, .. }
        | ItemKind::Time { name, .. }
        | ItemKind::State { name, .. }
        | ItemKind::Control { name, .. }
        | ItemKind::Surface { name, .. }
        | ItemKind::Phase { name, .. } => Some(name),
        _ => None,
    }
}

/// What an item declares, in the words of the language.
pub(crate) fn kind_word(item: &Item) -> &'static str {
    match &item.kind {
        ItemKind::Param { .. } => "parameter",
        ItemKind::Const { .. } => "constant",
        ItemKind::Let { .. } => "let",
        ItemKind::Signal { .. } => "signal",
        ItemKind::Fn { .. } => "function",
        ItemKind::Data { .. } => "data set",
        ItemKind::Free { .. } => "free unknown",
        ItemKind::Time { .. } => "time",
        ItemKind::State { .. } => "state",
        ItemKind::Control { .. } => "control",
        ItemKind::Surface { .. } => "surface",
        ItemKind::Phase { .. } => "phase",
        _ => "item",
    }
}

/// The names of the parts of a vector.
pub(crate) fn parts(item: &Item) -> &[Ident] {
    match &item.kind {
        ItemKind::State { parts, .. } | ItemKind::Control { parts, .. } => parts,
        _ => &[],
    }
}

/// The unit after a declaration.
pub(crate) fn unit(item: &Item) -> Option<&ast::Unit> {
    match &item.kind {
        ItemKind::Param { unit, .. }
        | ItemKind::Const { unit, .. }
        | ItemKind::Let { unit, .. }
        | ItemKind::Signal { unit, .. }
        | ItemKind::Free { unit, .. }
        | ItemKind::Time { unit, .. }
        | ItemKind::State { unit, .. }
        | ItemKind::Control { unit, .. } => unit.as_ref(),
        _ => None,
    }
}
