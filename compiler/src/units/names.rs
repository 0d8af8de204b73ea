//! The unit of every declared name, written or found: for tables, hover and hints.

use super::inference::Inference;
use super::messages::unit_of;
use super::notation::{Notation, written};
use super::solve::Solution;
use super::table;
use super::value::Part;
use crate::resolve::scope;
use fdcc_grammar::Span;
use fdcc_grammar::ast::{Binding, Ident, Item, ItemKind};

/// The unit of a declared name, or of one part of it.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedUnit {
    /// As in results: `v`, `pos.x`.
    pub name: String,
    /// The name where it is declared.
    pub span: Span,
    /// Without brackets; empty for a plain number.
    pub unit: String,
    /// How many SI units one of them is.
    pub scale: f64,
    /// Whether the text says so; found from the equations otherwise.
    pub written: bool,
}

/// All names whose units are known, in the order of the text.
pub(crate) fn names(
    items: &[Item],
    inference: &Inference<'_>,
    solution: &Solution,
    notation: &Notation,
) -> Vec<NamedUnit> {
    let mut all = Vec::new();
    for item in items {
        match &item.kind {
            ItemKind::Phase { items, .. } => all.extend(names(items, inference, solution, notation)),
            ItemKind::Report { bindings } => {
                all.extend(bindings.iter().flat_map(|it| of_report(it, inference, solution, notation)))
            }
            _ => all.extend(of_item(item, inference, solution, notation)),
        }
    }
    all
}

fn of_report(
    binding: &Binding,
    inference: &Inference<'_>,
    solution: &Solution,
    notation: &Notation,
) -> Vec<NamedUnit> {
    let value = inference.values.get(&binding.name.span).map_or(&[][..], Vec::as_slice);
    // The parts of a report are named after those of what it is made of, which is not known here.
    let [part] = value else { return Vec::new() };
    found(&binding.name, binding.name.name.clone(), part, solution, notation).into_iter().collect()
}

fn of_item(
    item: &Item,
    inference: &Inference<'_>,
    solution: &Solution,
    notation: &Notation,
) -> Vec<NamedUnit> {
    let Some(name) = scope::declared(item) else { return Vec::new() };
    let value = inference.values.get(&name.span).map_or(&[][..], Vec::as_slice);
    let parts = scope::parts(item);
    let named = |at: usize| match parts.get(at) {
        Some(part) => format!("{}.{}", name.name, part.name),
        None => name.name.clone(),
    };
    let unit = unit_of(item).filter(|unit| table::dimension(unit).is_some());
    let entry = |(at, part): (usize, &Part)| match unit {
        Some(unit) => Some(NamedUnit {
            name: named(at),
            span: name.span,
            unit: written(unit),
            scale: table::scale(unit, &mut Vec::new()),
            written: true,
        }),
        None => found(name, named(at), part, solution, notation),
    };
    value.iter().enumerate().filter_map(entry).collect()
}

fn found(
    place: &Ident,
    name: String,
    part: &Part,
    solution: &Solution,
    notation: &Notation,
) -> Option<NamedUnit> {
    let dimension = solution.settled(part.dimension.as_ref()?).filter(|it| it.is_known())?;
    Some(NamedUnit { name, span: place.span, unit: notation.unit(&dimension), scale: 1.0, written: false })
}
