//! Phases that have been resolved, in the state of the resolution of the whole.

use super::Elaborator;
use super::value::Value;
use crate::expressions::graph::{ById, ExprId};
use crate::model::phases::Symbols;
use fdcc_grammar::ast::{Assignment, Ident, Item, ItemKind};
use std::collections::HashMap;

/// A phase that has been resolved.
pub(crate) struct Inner<'a> {
    /// Its name.
    pub name: &'a Ident,
    /// What it means; without its scope, which knows the names of all phases.
    pub meaning: Elaborator<'a>,
    /// What its names stand for, with their declarations.
    pub names: HashMap<&'a str, Named<'a>>,
    /// What the whole has read of it.
    pub imported: ById<ExprId>,
}

/// A name of a phase.
pub(crate) struct Named<'a> {
    /// What it stands for, in the graph of the phase.
    pub value: Value,
    /// What is declared by the name.
    pub item: &'a Item,
    /// What names the components of the value.
    pub parts_of: Option<&'a Item>,
}

impl<'a> Inner<'a> {
    /// A phase whose checks are done.
    pub fn new(name: &'a Ident, mut meaning: Elaborator<'a>) -> Self {
        let values = std::mem::take(&mut meaning.values);
        let scope = std::mem::take(&mut meaning.scope);
        let mut names = HashMap::new();
        for (declaration, value) in scope.declarations.iter().zip(values) {
            let item = declaration.item;
            if !matches!(item.kind, ItemKind::Phase { .. } | ItemKind::Data { .. }) {
                let parts_of = value.named.map(|at| scope.declarations[at].item);
                names.insert(&*declaration.name.name, Named { value, item, parts_of });
            }
        }
        Inner { name, meaning, names, imported: ById::default() }
    }
}

/// What a phase hands over.
pub(crate) struct Handed<'a> {
    /// The line of a link.
    pub assignment: &'a Assignment,
    /// Its right side at the end of the phase.
    pub value: Value,
}

impl<'a> Elaborator<'a> {
    /// The number by which a value says that this item names its components.
    pub fn name_from(&mut self, item: &'a Item) -> usize {
        self.named_in_phases.push(item);
        self.scope.declarations.len() + self.named_in_phases.len() - 1
    }

    /// What names the components of a value.
    pub fn item_named(&self, at: usize) -> &'a Item {
        match self.scope.declarations.get(at) {
            Some(declaration) => declaration.item,
            None => self.named_in_phases[at - self.scope.declarations.len()],
        }
    }

    /// Copies expressions of a phase.
    pub fn import(&mut self, phase: usize, roots: &[ExprId]) -> Vec<ExprId> {
        let Elaborator { phases, graph, symbols, .. } = self;
        let Inner { meaning, imported, .. } = &mut phases[phase];
        let from = (&meaning.graph, meaning.symbols.as_slice());
        Symbols { graph, symbols }.take_of(phase, from, roots, imported)
    }
}
