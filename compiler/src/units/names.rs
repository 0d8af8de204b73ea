//! The unit of every declared name, written or found: for tables, hover and hints.

use super::dimension::Dimension;
use super::inference::Inference;
use super::messages::unit_of;
use super::notation::{Notation, written};
use super::solve::Solution;
use super::table;
use super::value::Part;
use crate::resolve::{scope, text, walk};
use fdcc_grammar::Span;
use fdcc_grammar::ast::{Condition, Item, ItemKind};

/// The unit of a declared name, or of one part of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedUnit {
    /// As in results: `v`, `pos.x`; `objective` for what is minimised.
    pub name: String,
    /// The name where it is declared.
    pub span: Span,
    /// Without brackets; empty for a plain number.
    pub unit: String,
    /// How many SI units one of them is.
    pub scale: f64,
    /// The same in SI.
    pub si: String,
    /// What it measures.
    pub dimension: Dimension,
    /// Whether the text says so; found from the equations otherwise.
    pub written: bool,
    /// Whether it is the time.
    pub is_time: bool,
}

/// What a walk has found out.
pub(crate) struct Findings<'f, 'a> {
    /// What each name measures, with unknowns in it.
    pub inference: &'f Inference<'a>,
    /// What the unknowns are.
    pub solution: &'f Solution,
    /// How units are written in this model.
    pub notation: &'f Notation,
}

impl Findings<'_, '_> {
    /// All names whose units are known, in the order of the text.
    pub fn names(&self, items: &[Item]) -> Vec<NamedUnit> {
        let mut all = Vec::new();
        for item in items {
            match &item.kind {
                ItemKind::Phase { items, .. } => all.extend(self.names(items)),
                ItemKind::Report { bindings } => {
                    all.extend(bindings.iter().filter_map(|it| self.single(it.name.span, &it.name.name)))
                }
                ItemKind::Objective { keyword, .. } => all.extend(self.single(*keyword, "objective")),
                _ => all.extend(self.of_item(item)),
            }
        }
        all
    }

    /// Of every condition what it compares, as the first name in it is written that measures the same.
    pub fn conditions(&self, items: &[Item], names: &[NamedUnit]) -> Vec<NamedUnit> {
        let of_item = |item: &Item| {
            let (name, condition) = match &item.kind {
                ItemKind::Start { condition } => (format!("start {}", text::condition(condition)), condition),
                ItemKind::End { condition } => (format!("end {}", text::condition(condition)), condition),
                ItemKind::Path { name: Some(name), condition } => (name.name.clone(), condition),
                ItemKind::Path { condition, .. } => (text::condition(condition), condition),
                _ => return None,
            };
            let found = self.found(condition.span, name, self.value(condition.span).first()?)?;
            Some(as_written(found, condition, names))
        };
        items.iter().filter_map(of_item).collect()
    }

    fn value(&self, span: Span) -> &[Part] {
        self.inference.values.get(&span).map_or(&[][..], Vec::as_slice)
    }

    /// The unit of a number. The parts of a vector in a report have names that are not known here.
    fn single(&self, span: Span, name: &str) -> Option<NamedUnit> {
        match self.value(span) {
            [part] => self.found(span, name.into(), part),
            _ => None,
        }
    }

    fn of_item(&self, item: &Item) -> Vec<NamedUnit> {
        let Some(name) = scope::declared(item) else { return Vec::new() };
        let parts = scope::parts(item);
        let named = |at: usize| match parts.get(at) {
            Some(part) => format!("{}.{}", name.name, part.name),
            None => name.name.clone(),
        };
        let unit = unit_of(item).filter(|unit| table::dimension(unit).is_some());
        let is_time = matches!(item.kind, ItemKind::Time { .. });
        let entry = |(at, part): (usize, &Part)| {
            let found = self.found(name.span, named(at), part)?;
            Some(match unit {
                Some(unit) => NamedUnit {
                    unit: written(unit),
                    scale: table::scale(unit, &mut Vec::new()),
                    written: true,
                    is_time,
                    ..found
                },
                None => NamedUnit { is_time, ..found },
            })
        };
        self.value(name.span).iter().enumerate().filter_map(entry).collect()
    }

    fn found(&self, span: Span, name: String, part: &Part) -> Option<NamedUnit> {
        let dimension = self.solution.settled(part.dimension.as_ref()?).filter(Dimension::is_known)?;
        let unit = self.notation.unit(&dimension);
        Some(NamedUnit { name, span, si: unit.clone(), unit, scale: 1.0, dimension, ..NamedUnit::default() })
    }
}

/// In the unit of the first name of a condition that measures the same.
fn as_written(found: NamedUnit, condition: &Condition, names: &[NamedUnit]) -> NamedUnit {
    let mut like = None;
    for side in std::iter::once(&condition.first).chain(condition.rest.iter().map(|it| &it.1)) {
        walk::names(side, &mut |name, _| {
            let is_it =
                |it: &&NamedUnit| it.name.split('.').next() == Some(name) && it.dimension == found.dimension;
            like = like.or(names.iter().filter(|it| it.written).find(is_it));
        });
    }
    match like {
        Some(like) => NamedUnit { unit: like.unit.clone(), scale: like.scale, ..found },
        None => found,
    }
}
