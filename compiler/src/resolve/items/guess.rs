//! The `guess` block: curves for states and controls, numbers for unknowns, each seeing those above
//! it.

use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::value::Value;
use crate::resolve::elaborator::{Elaborator, Role};
use crate::syntax::scope;
use fdcc_grammar::ast::{Binding, ItemKind};
use fdcc_grammar::{Code, Diagnostic};

impl<'a> Elaborator<'a> {
    /// Resolves the lines of a block from top to bottom.
    pub fn guess(&mut self, bindings: &'a [Binding]) {
        let before = self.here.locals.len();
        bindings.iter().for_each(|binding| self.guess_line(binding));
        self.here.locals.truncate(before);
    }

    fn guess_line(&mut self, binding: &'a Binding) {
        let Some(at) = self.guessed(binding) else {
            self.evaluate_in(Context::GUESS, &binding.value);
            return;
        };
        let item = self.scope.declarations[at].item;
        let is_free = matches!(item.kind, ItemKind::Free { .. });
        let context = if is_free { Context::FREE_GUESS } else { Context::GUESS };
        let value = self.evaluate_for(Role::Number("a guess"), context, &binding.value);
        let size = self.values[at].parts.as_slice().len();
        let parts = self.expect_parts(&value, size, binding.value.span);
        let Some(first) = self.index_of(at) else { return };
        for (part, &guess) in parts.iter().enumerate() {
            match item.kind {
                ItemKind::Free { .. } => {
                    self.model.frees[first].guess = Some(guess);
                    self.guessed.push((first, guess));
                }
                ItemKind::State { .. } => self.model.states[first + part].guess = Some(guess),
                _ => self.model.controls[first + part].guess = Some(guess),
            }
        }
        if !is_free {
            let parts = crate::resolve::elaborator::value::Parts::from_list(&parts);
            self.here
                .locals
                .push((&binding.name.name, Value { parts, traits: value.traits, named: Some(at) }));
        }
    }

    /// What is guessed: a state, a control or an unknown.
    fn guessed(&mut self, binding: &'a Binding) -> Option<usize> {
        let name = &binding.name;
        let Some(at) = self.scope.find(&name.name) else {
            let found = self.scope.unknown(
                &name.name,
                name.span,
                &[],
                &format!("state {} start 0", name.name),
            );
            self.diagnostics.push(found);
            return None;
        };
        let item = self.scope.declarations[at].item;
        if matches!(
            item.kind,
            ItemKind::State { .. } | ItemKind::Control { .. } | ItemKind::Free { .. }
        ) {
            return Some(at);
        }
        let kind = scope::kind_word(item);
        let message = format!("`{}` is a {kind} and cannot be guessed", name.name);
        let found = Diagnostic::new(Code::WrongKind, message, name.span, format!("a {kind}"));
        self.diagnostics.push(
            found.help("guesses are for states, controls and `free` names; a helper is a `let`"),
        );
        None
    }
}
