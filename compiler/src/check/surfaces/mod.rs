//! FDC03xx: what the surfaces of a model do, told where it matters.

mod constant;
mod controls;
mod coordinates;
mod crossing;
mod endless;
mod gradient;
mod repelling;
mod start;
mod uses;
mod vector;

use crate::check::facts::{Facts, view_of};
use crate::surfaces::class::{Class, classify};
use crate::surfaces::degenerate::degenerate;
use crate::surfaces::{Local, View};
use fdcc_grammar::ast::{Expr, Interval, ItemKind, Start};
use fdcc_grammar::{Diagnostic, Severity, Span};
use uses::{Use, uses};

/// Models with more surfaces than these are not examined: nobody would read it.
const MOST_SURFACES: usize = 300;

/// Reports about every surface; the components of a `Dir` are one, its vector.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let view = view_of(facts.meaning);
    let uses = uses(facts);
    let is_alone = |at: &usize| view.balls.iter().all(|ball| !ball.surfaces.contains(at));
    for at in (0..view.surfaces.len()).filter(is_alone).take(MOST_SURFACES) {
        let Some(local) = Local::new(&view, at) else { continue };
        let place = uses.iter().find(|it| it.surface == view.surfaces[at].0.name);
        Subject { facts, view: &view, at, place, local }.look(found);
    }
    vector::check(facts, &view, &uses, found);
}

/// One surface under examination.
struct Subject<'s, 'a, 'e> {
    facts: &'s Facts<'a, 'e>,
    view: &'s View<'s>,
    at: usize,
    place: Option<&'s Use<'a>>,
    local: Local,
}

impl<'a> Subject<'_, 'a, '_> {
    fn look(mut self, found: &mut Vec<Diagnostic>) {
        if let Some(constant) = self.constant() {
            return found.push(constant);
        }
        if let Some(degenerate) = degenerate(&mut self.local) {
            return found.push(self.vanishing(&degenerate));
        }
        found.extend(self.start_on_surface());
        if self.local.gradient.is_empty() || !self.local.add_rates(self.view, self.at) {
            return;
        }
        let class = classify(&mut self.local);
        match &class {
            Class::Apart => return,
            Class::Repelling => return found.push(self.repelling(&[])),
            Class::RepellingFor(choice) => return found.push(self.repelling(choice)),
            Class::Crossed { strictly } => found.extend(self.expanding(*strictly)),
            _ => {}
        }
        self.local.add_sides(self.view, self.at);
        // A fact that interests nobody while something is wrong.
        let is_wrong = self
            .facts
            .meaning
            .diagnostics
            .iter()
            .chain(&*found)
            .any(|it| it.severity == Severity::Error);
        if matches!(class, Class::Held | Class::Attracting) && !is_wrong {
            found.extend(self.other_coordinates());
        }
        found.extend(self.control_jumps());
        found.extend(self.endless());
    }

    /// What it is called.
    fn name(&self) -> &str {
        &self.view.surfaces[self.at].0.name
    }

    /// Where it is declared, or used first.
    fn declared(&self) -> Span {
        self.view.surfaces[self.at].0.span
    }

    /// Its function as it was written.
    fn written(&self) -> Option<&'a Expr> {
        self.facts.items.iter().find_map(|item| match &item.kind {
            ItemKind::Surface { name, value } if name.name == self.name() => Some(value),
            _ => None,
        })
    }

    /// Where its function stands.
    fn function(&self) -> Span {
        self.written().map_or(self.declared(), |value| value.span)
    }

    /// The bounds and the name of a control.
    fn control(&self, name: &str) -> Option<(Span, &'a Interval)> {
        let whole = name.split('.').next().unwrap_or(name);
        self.facts.items.iter().find_map(|item| match &item.kind {
            ItemKind::Control { name, bounds: Some(bounds), .. } if name.name == whole => {
                Some((name.span, bounds))
            }
            _ => None,
        })
    }

    /// The value a state starts with.
    fn start(&self, name: &str) -> Option<&'a Expr> {
        let whole = name.split('.').next().unwrap_or(name);
        self.facts.items.iter().find_map(|item| match &item.kind {
            ItemKind::State { name, start: Some(Start::Value(value)), .. }
                if name.name == whole =>
            {
                Some(value)
            }
            _ => None,
        })
    }

    /// An expression of the surface's own graph, in the words of the model.
    fn text(&mut self, expr: crate::expressions::graph::ExprId) -> String {
        self.local.text(self.view, expr).unwrap_or_else(|| "...".into())
    }
}
