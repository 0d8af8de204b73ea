//! The unit of every declared name, written or found: for tables, hover and hints.

use super::dimension::Dimension;
use super::dimension::notation::{Notation, written};
use super::dimension::table;
use super::inference::Inference;
use super::inference::solve::Solution;
use super::inference::value::Part;
use super::mistakes::messages::unit_of;
use crate::syntax::{scope, text, walk};
use fdcc_grammar::Span;
use fdcc_grammar::ast::{Check, Expr, Item, ItemKind};

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

/// What a width of smoothing measures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WidthUnit {
    /// The unit, called `sigma`; that of SI where the surfaces have none of their own.
    pub unit: NamedUnit,
    /// Whether a plain number is a width in that unit; otherwise its unit has to be said.
    pub takes_numbers: bool,
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
    /// All names whose units are known, in the order of the text; then the objective, as the first
    /// name in it is written that measures the same.
    pub fn names(&self, items: &[Item]) -> Vec<NamedUnit> {
        let mut all = Vec::new();
        for item in items {
            match &item.kind {
                ItemKind::Phase { items, .. } => all.extend(self.names(items)),
                ItemKind::Report { bindings } => all.extend(
                    bindings.iter().filter_map(|it| self.single(it.name.span, &it.name.name)),
                ),
                ItemKind::Plot { curves, over, .. } => {
                    let drawn = curves.iter().chain([over]);
                    all.extend(drawn.filter_map(|it| self.single(it.span, &text::expr(it))));
                }
                _ => all.extend(self.of_item(item)),
            }
        }
        for item in items {
            if let ItemKind::Objective { keyword, value, .. } = &item.kind {
                let found = self.single(*keyword, "objective");
                all.extend(found.map(|it| as_written(it, &[value], &all)));
            }
        }
        all
    }

    /// Of every condition and expectation what it compares, as the first name in it is written that
    /// measures the same.
    pub fn conditions(&self, items: &[Item], names: &[NamedUnit]) -> Vec<NamedUnit> {
        let named = |name: String, span: Span, sides: &[&Expr]| {
            Some(as_written(self.found(span, name, self.value(span).first()?)?, sides, names))
        };
        let of_check = |it: &Check| {
            let [left, right] = [&it.left, &it.right].map(text::expr);
            let name = format!("{left} {} {right}", text::relation(it.relation));
            named(name, it.span, &[&it.left, &it.right])
        };
        let of_item = |item: &Item| {
            let (name, condition) = match &item.kind {
                ItemKind::Start { condition } => {
                    (format!("start {}", text::condition(condition)), condition)
                }
                ItemKind::End { condition } => {
                    (format!("end {}", text::condition(condition)), condition)
                }
                ItemKind::At { time, condition } => (text::at_time(time, condition), condition),
                ItemKind::Path { name: Some(name), condition } => (name.name.clone(), condition),
                ItemKind::Path { condition, .. } => (text::condition(condition), condition),
                _ => return None,
            };
            let rest = condition.rest.iter().map(|it| &it.1);
            let sides: Vec<&Expr> = std::iter::once(&condition.first).chain(rest).collect();
            named(name, condition.span, &sides)
        };
        let checks = items.iter().filter_map(|item| match &item.kind {
            ItemKind::Expect { checks } => Some(checks),
            _ => None,
        });
        let checks = checks.flatten().filter_map(of_check);
        let mut all: Vec<NamedUnit> = items.iter().filter_map(of_item).chain(checks).collect();
        for item in items {
            let ItemKind::Phase { name, items, .. } = &item.kind else { continue };
            let own = self.conditions(items, names);
            // The whole tells them with the name of their phase.
            let told = own.clone().into_iter();
            all.extend(
                told.map(|it| NamedUnit { name: format!("{}.{}", name.name, it.name), ..it }),
            );
            all.extend(own);
        }
        all
    }

    /// What the width of every surface measures; none where they differ, or where there is none.
    pub fn width(&self) -> Option<WidthUnit> {
        let parts = self.inference.of_a_width();
        let part = parts.first()?;
        let takes_numbers = part.declared.is_si() || part.gives_unit();
        let found = self.found(Span::default(), "sigma".into(), part);
        let Some(found) = found else {
            let unit = NamedUnit { scale: 1.0, ..NamedUnit::default() };
            return (!takes_numbers).then_some(WidthUnit { unit, takes_numbers });
        };
        Some(WidthUnit { unit: in_declared(found, part), takes_numbers })
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
        let is_surface = matches!(item.kind, ItemKind::Surface { .. });
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
                // The width of a surface is in the unit of the name that it is.
                None if is_surface => in_declared(found, part),
                None => NamedUnit { is_time, ..found },
            })
        };
        self.value(name.span).iter().enumerate().filter_map(entry).collect()
    }

    fn found(&self, span: Span, name: String, part: &Part) -> Option<NamedUnit> {
        let dimension =
            self.solution.settled(part.dimension.as_ref()?).filter(Dimension::is_known)?;
        let unit = self.notation.unit(&dimension);
        Some(NamedUnit {
            name,
            span,
            si: unit.clone(),
            unit,
            scale: 1.0,
            dimension,
            ..NamedUnit::default()
        })
    }
}

/// In the unit of the name that something is, if it is one.
fn in_declared(found: NamedUnit, part: &Part) -> NamedUnit {
    let own = part.declared.text(&found.dimension).filter(|_| part.gives_unit());
    match own {
        Some(unit) => NamedUnit { unit, scale: part.declared.scale().0, ..found },
        None => found,
    }
}

/// In the unit of the first name in some expressions that measures the same.
fn as_written(found: NamedUnit, sides: &[&Expr], names: &[NamedUnit]) -> NamedUnit {
    let mut like = None;
    for side in sides {
        walk::names(side, &mut |name, _| {
            let is_it = |it: &&NamedUnit| {
                it.name.split('.').next() == Some(name) && it.dimension == found.dimension
            };
            like = like.or(names.iter().filter(|it| it.written).find(is_it));
        });
    }
    match like {
        Some(like) => NamedUnit { unit: like.unit.clone(), scale: like.scale, ..found },
        None => found,
    }
}
