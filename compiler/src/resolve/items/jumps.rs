//! Resets of the state: `jump NAME on SURFACE falling at most N then hold SURFACE { x := ... }`.

use crate::expressions::graph::ExprId;
use crate::model::{Jump, Place};
use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::context::Context;
use fdcc_grammar::ast::{Assignment, Ident, Item, ItemKind};

impl<'a> Elaborator<'a> {
    /// Resolves a jump; one with a mistake in it is told and left out.
    pub fn jump(&mut self, item: &'a Item) {
        let ItemKind::Jump { name, surface, direction, at_most, then_hold, assignments, .. } =
            &item.kind
        else {
            return;
        };
        let surface = self.jump_surface(surface);
        let then_hold = then_hold.as_ref().map(|held| self.jump_surface(held));
        let at_most = at_most
            .as_ref()
            .and_then(|number| self.evaluate_number("a number of jumps", Context::NUMBER, number));
        let resets = assignments.iter().flat_map(|reset| self.reset(reset)).collect();
        let place = Place { name: name.name.clone(), span: name.span };
        if let (Some(surface), None | Some(Some(_))) = (surface, then_hold) {
            let then_hold = then_hold.flatten();
            self.model.jumps.push(Jump {
                place,
                surface,
                direction: *direction,
                at_most,
                then_hold,
                resets,
            });
        }
    }

    fn jump_surface(&mut self, name: &'a Ident) -> Option<usize> {
        let at =
            self.declared_as(name, "surface", |kind| matches!(kind, ItemKind::Surface { .. }))?;
        self.surface_of.get(&at).copied()
    }

    /// The states that an assignment gives a value, each with its own.
    fn reset(&mut self, reset: &'a Assignment) -> Vec<(usize, ExprId)> {
        let state =
            self.declared_as(&reset.name, "state", |kind| matches!(kind, ItemKind::State { .. }));
        let value = self.evaluate_in(Context::DYNAMICS, &reset.value);
        let Some(at) = state else { return Vec::new() };
        let size = self.values[at].parts.as_slice().len();
        let parts = self.expect_parts(&value, size, reset.value.span);
        let Some(first) = self.index_of(at) else { return Vec::new() };
        parts.into_iter().enumerate().map(|(part, value)| (first + part, value)).collect()
    }
}
