//! Names that can be written: those of the text as it is, and those of the last one that could be
//! read, since what is being written hides what stands behind it.

use super::items::{Proposal, name};
use crate::context::Context;
use crate::features::cursor::CursorContext;
use fdcc::language::{Kind, Names};
use std::collections::BTreeSet;

/// The names that are known at a place.
pub struct Scope<'c> {
    context: &'c Context<'c>,
    /// The text as it is, then the last one that could be read.
    all: Vec<&'c Names>,
    phase: Option<String>,
}

/// Whether the name of a definition stands for it at a place: that of a phase for each file stands
/// for the rows of the file within it, and for the phase elsewhere.
fn is_meant(names: &Names, definition: usize, place: &CursorContext<'_>) -> bool {
    let is_rows = names.is_rows(definition);
    let of_each = is_rows || names.parts_of(definition).any(|at| names.is_rows(at));
    !of_each || is_rows == (place.phase == Some(names.definitions[definition].name.as_str()))
}

impl<'c> Scope<'c> {
    /// Around a place in a phase, or outside of all.
    pub fn new(context: &'c Context<'c>, phase: Option<&str>) -> Self {
        let before = context.document.readable().map(|it| it.names());
        let all = std::iter::once(context.snapshot().names()).chain(before).collect();
        Scope { context, all, phase: phase.map(str::to_owned) }
    }

    /// Every name of certain kinds, once.
    pub fn proposals(&self, is_wanted: impl Fn(Kind) -> bool) -> Vec<Proposal> {
        self.found(|names, at| {
            let it = &names.definitions[at];
            let is_visible = match it.within {
                None => true,
                Some(outer) => {
                    self.phase.as_ref() == Some(&names.definitions[outer].name)
                        && names.definitions[outer].kind == Kind::Phase
                }
            };
            is_visible && is_wanted(it.kind)
        })
    }

    /// What the last of a chain of names holds; a row holds what its data set does.
    pub fn parts(&self, place: &CursorContext<'_>) -> Vec<Proposal> {
        let Some(&last) = place.path.last() else { return Vec::new() };
        let row = place.before.windows(3).rev().find(|words| words[0] == last && words[1] == "in");
        let owner = row.map_or(last, |words| words[2]);
        self.found(|names, at| {
            let it = &names.definitions[at];
            let is_inside = it.within.is_some_and(|outer| {
                names.definitions[outer].name == owner && is_meant(names, outer, place)
            });
            is_inside && !names.is_rows(at) && !matches!(it.kind, Kind::Argument | Kind::Row)
        })
    }

    /// The arguments of the function around a place, and the rows of the sums.
    pub fn locals(&self, place: &CursorContext<'_>) -> Vec<Proposal> {
        let function =
            place.before.iter().rposition(|it| *it == "fn").and_then(|at| place.before.get(at + 1));
        let function = function.filter(|_| place.item == "fn");
        self.found(|names, at| {
            let it = &names.definitions[at];
            match it.kind {
                Kind::Argument => it
                    .within
                    .is_some_and(|outer| Some(&names.definitions[outer].name.as_str()) == function),
                Kind::Row => place.open.iter().any(|open| open.before == "sum"),
                _ => false,
            }
        })
    }

    fn found(&self, is_wanted: impl Fn(&Names, usize) -> bool) -> Vec<Proposal> {
        let mut seen = BTreeSet::new();
        let mut all = Vec::new();
        for names in &self.all {
            for at in (0..names.definitions.len()).filter(|at| is_wanted(names, *at)) {
                let it = &names.definitions[at];
                if seen.insert(it.name.clone()) {
                    all.push(name(it, self.unit(&names.full_name(at))));
                }
            }
        }
        all
    }

    fn unit(&self, name: &str) -> Option<&str> {
        let found = self.context.units().iter().find(|it| it.name == name)?;
        (!found.unit.is_empty()).then_some(found.unit.as_str())
    }
}
