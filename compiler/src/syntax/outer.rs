//! What stands outside of all phases, as one of them sees it: of the other phases only those that
//! it names, so that a text of n phases is not gone through n times.

use super::each::phase_named;
use super::scope::declared;
use super::walk;
use fdcc_grammar::ast::{Assignment, Expr, ExprKind, Ident, Item, ItemKind};
use std::borrow::Cow;
use std::collections::HashMap;

/// The items outside of all phases, with these.
pub(crate) struct Outer<'a> {
    items: &'a [Item],
    /// The places of all that is seen by each phase.
    shared: Vec<usize>,
    /// The places of each phase.
    phases: HashMap<&'a str, Vec<usize>>,
    /// What a phase hands over.
    handed: HashMap<&'a str, Vec<&'a Assignment>>,
}

impl<'a> Outer<'a> {
    /// Of the items of a text.
    pub fn new(items: &'a [Item]) -> Self {
        let (shared, phases, handed) = Default::default();
        let mut outer = Outer { items, shared, phases, handed };
        for (at, item) in items.iter().enumerate() {
            match &item.kind {
                ItemKind::Phase { name, .. } => {
                    outer.phases.entry(&name.name).or_default().push(at);
                }
                ItemKind::Link { from, assignments, .. } => {
                    outer.handed.entry(&from.name).or_default().extend(assignments);
                }
                _ => outer.shared.push(at),
            }
        }
        let of_each = outer.shared.iter().filter(|at| concerns_phases(&items[**at]));
        let named = of_each.flat_map(|at| mentioned(&items[*at]));
        let named: Vec<usize> = named.flat_map(|name| outer.places(&name)).collect();
        outer.shared.extend(named);
        outer
    }

    /// What a phase with these items sees, in the order of the text.
    pub fn seen_by(&self, phase: &Ident, items: &'a [Item]) -> Vec<&'a Item> {
        let mut seen = self.shared.clone();
        for name in items.iter().flat_map(mentioned) {
            seen.extend(self.places(&name));
        }
        for line in self.handed.get(phase.name.as_str()).into_iter().flatten() {
            seen.extend(self.places(&line.name.name));
            in_value(&line.value, &mut |name| seen.extend(self.places(&name)));
        }
        seen.sort_unstable();
        seen.dedup();
        seen.into_iter().map(|at| &self.items[at]).collect()
    }

    fn places(&self, name: &str) -> Vec<usize> {
        self.phases.get(name).cloned().unwrap_or_default()
    }
}

/// The names in an expression, those of numbered phases among them.
fn in_value<'a>(value: &'a Expr, see: &mut dyn FnMut(Cow<'a, str>)) {
    walk::names(value, &mut |name, _| see(Cow::Borrowed(name)));
    walk::visit(value, &mut |inner| {
        if matches!(inner.kind, ExprKind::Index(..)) {
            phase_named(inner).into_iter().for_each(&mut *see);
        }
    });
}

/// Whether each phase looks into an item: a definition, or what speaks of its motion.
fn concerns_phases(item: &Item) -> bool {
    !matches!(
        item.kind,
        ItemKind::Objective { .. }
            | ItemKind::Start { .. }
            | ItemKind::End { .. }
            | ItemKind::Expect { .. }
            | ItemKind::Sweep { .. }
    )
}

/// The names in an item; those of parts are not among them.
fn mentioned(item: &Item) -> Vec<Cow<'_, str>> {
    let mut names: Vec<Cow<'_, str>> = declared(item).map(name).into_iter().collect();
    for expr in walk::expressions(item) {
        in_value(expr, &mut |name| names.push(name));
    }
    match &item.kind {
        ItemKind::Dynamics { equations } => {
            names.extend(equations.iter().map(|it| name(&it.state)))
        }
        ItemKind::Metric { weights } => names.extend(weights.iter().map(|it| name(&it.0))),
        ItemKind::Guess { bindings } => names.extend(bindings.iter().map(|it| name(&it.name))),
        ItemKind::Fit { data, .. } => names.push(name(data)),
        ItemKind::Plot { borders, .. } => names.extend(borders.iter().map(name)),
        ItemKind::Jump { surface, then_hold, assignments, .. } => {
            names.extend([surface].into_iter().chain(then_hold).map(name));
            names.extend(assignments.iter().map(|it| name(&it.name)));
        }
        _ => {}
    }
    names
}

fn name(it: &Ident) -> Cow<'_, str> {
    Cow::Borrowed(&it.name)
}
