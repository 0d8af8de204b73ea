//! Resets of the state: `jump NAME on SURFACE falling at most N then hold SURFACE { x := ... }`.

use crate::expressions::graph::ExprId;
use crate::model::{Jump, Place};
use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::value::Value;
use crate::syntax::scope;
use fdcc_grammar::ast::{Assignment, Ident, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic};
use std::ops::Range;

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
        let resets = assignments.iter().flat_map(|reset| {
            let span = reset.name.span.to(reset.value.span);
            self.reset(reset).into_iter().map(move |it| (it, span))
        });
        let (resets, assignments) = resets.unzip();
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
                assignments,
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
        let Some(first) = self.index_of(at) else { return Vec::new() };
        let item = self.scope.declarations[at].item;
        let Some(states) = self.assigned(reset, item, first..first + size) else {
            return Vec::new();
        };
        let parts = self.expect_parts(&value, states.len(), reset.value.span);
        states.zip(parts).collect()
    }

    /// The states that an assignment to a vector or to a part of it gives a value.
    pub fn assigned(
        &mut self,
        assignment: &'a Assignment,
        item: &'a Item,
        states: Range<usize>,
    ) -> Option<Range<usize>> {
        let Some(part) = &assignment.part else { return Some(states) };
        let names: Vec<&Ident> = scope::parts(item).iter().collect();
        match names.iter().position(|name| name.name == part.name) {
            Some(at) => Some(states.start + at..states.start + at + 1),
            None => {
                match names.is_empty() {
                    true => self.diagnostics.push(not_a_vector(&assignment.name, part)),
                    false => _ = self.no_part(Value::default(), part, &names),
                }
                None
            }
        }
    }
}

fn not_a_vector(name: &Ident, part: &Ident) -> Diagnostic {
    let message = format!("there is no part `{}`", part.name);
    Diagnostic::new(Code::UnknownPart, message, part.span, "no such part")
        .help(format!("`{}` is a number: give it a value as a whole", name.name))
}
