//! The search in a model with phases: each phase has a structure of its own, and all are solved at
//! once.
//!
//! ```text
//! structure   of each phase, from its smoothed signals
//! solve       all phases with the links between them
//! mend        one phase after the other, the structures of the others as they are,
//!             until nothing changes in any of them
//! ```

use super::joint::{Among, Part};
use super::repair;
use super::structure::Structure;
use super::tuning::search::MOST_ROUNDS;
use super::{First, Located, Search, Spent, Whole};
use fdcc_compiler::{Model, limits};
use fdcc_runtime::nlp::Stop;
use std::ops::ControlFlow;
use std::sync::Arc;

type Watch<'s> = &'s (dyn Fn() -> ControlFlow<Stop> + Sync);

/// Looks for the optimum of the true system near the smoothed solutions of all phases; one of each
/// phase, or nothing.
pub(crate) fn locate_in_phases(
    whole: &Model,
    parts: &[Part],
    (smoothed, first): (&[Whole], First),
    stop: Watch,
    spent: &mut Spent,
) -> Option<Vec<Located>> {
    let mut phases = Phases { whole, parts, first, stop, spent };
    let mut all = phases.first_solved(smoothed)?;
    for _ in 0..MOST_ROUNDS {
        let before = Arc::clone(&all[0].joint);
        all = phases.without_nothing(all);
        for own in 0..parts.len() {
            all = phases.mended(all, own)?;
        }
        if Arc::ptr_eq(&before, &all[0].joint) {
            return Some(all);
        }
    }
    // What was not looked at since another phase changed is not known to hold.
    Some(all)
}

/// The same structures on shorter intervals, in a few places or of half the length; nothing where
/// some were halved `most` times.
pub(crate) fn halved_in_phases(
    whole: &Model,
    parts: &[Part],
    (all, most): (Vec<Located>, u32),
    stop: Watch,
    spent: &mut Spent,
) -> Option<Vec<Located>> {
    let mut phases = Phases { whole, parts, first: First::Controls, stop, spent };
    let finer = phases.sharpened(&all).or_else(|| phases.halved(&all, most))?;
    let insertions: Vec<f64> = all.iter().map(|it| it.insertion).collect();
    let finer = phases.solved_with(finer, &all)?;
    Some(phases.compared(finer, insertions))
}

/// The same optimum with more of its digits; nothing where there are none.
pub(crate) fn polished_in_phases(
    whole: &Model,
    parts: &[Part],
    all: Vec<Located>,
    stop: Watch,
    spent: &mut Spent,
) -> Option<Vec<Located>> {
    let mut phases = Phases { whole, parts, first: First::Controls, stop, spent };
    let insertions: Vec<f64> = all.iter().map(|it| it.insertion).collect();
    let polished = phases.search(0).polished(&seen_from(all, 0))?;
    Some(phases.compared(in_order(polished, 0), insertions))
}

struct Phases<'s> {
    whole: &'s Model,
    parts: &'s [Part<'s>],
    first: First,
    stop: Watch<'s>,
    spent: &'s mut Spent,
}

impl Phases<'_> {
    fn search(&mut self, own: usize) -> Search<'_> {
        let Part { written, model, problem } = self.parts[own];
        Search {
            written,
            model,
            problem,
            among: Some(Among { whole: self.whole, parts: self.parts, own }),
            first: self.first,
            stop: self.stop,
            spent: self.spent,
        }
    }

    /// With shorter intervals in a few places of one phase or more.
    fn sharpened(&mut self, all: &[Located]) -> Option<Vec<Structure>> {
        let own = |(own, it): (usize, &Located)| self.search(own).sharpened(it);
        let sharper: Vec<Option<Structure>> = all.iter().enumerate().map(own).collect();
        let is_any = sharper.iter().any(Option::is_some);
        let each = sharper.into_iter().zip(all);
        is_any.then(|| each.map(|(it, own)| it.unwrap_or_else(|| own.structure.clone())).collect())
    }

    fn halved(&self, all: &[Located], most: u32) -> Option<Vec<Structure>> {
        all.iter().map(|it| it.structure.halved(most)).collect()
    }

    /// The same structures, solved anew: what holds were worth is known.
    fn compared(&mut self, mut all: Vec<Located>, insertions: Vec<f64>) -> Vec<Located> {
        for (own, (located, insertion)) in all.iter_mut().zip(insertions).enumerate() {
            located.insertion = insertion;
            self.search(own).compared(located);
        }
        all
    }

    /// All phases as they look while they are smoothed; where that fails, one of them simpler; then
    /// all of them with free controls.
    fn first_solved(&mut self, smoothed: &[Whole]) -> Option<Vec<Located>> {
        let of = |(part, whole): (&Part, &Whole)| {
            Structure::of(part.problem, whole, limits(part.model).len())
        };
        let all: Vec<Structure> = self.parts.iter().zip(smoothed).map(of).collect();
        let simplest = (0..all.len()).find_map(|own| {
            let from = beside_others(&all, smoothed, own);
            let located = self.search(own).simplest_solved(all[own].clone(), &from)?;
            Some(in_order(located, own))
        });
        simplest.or_else(|| {
            let all = all.iter().map(|it| it.released().unwrap_or_else(|| it.clone()));
            let all: Vec<Structure> = all.collect();
            let from = beside_others(&all, smoothed, 0);
            Some(in_order(self.search(0).solve(all[0].clone(), &from)?, 0))
        })
    }

    /// Without what has shrunk to nothing in any of the phases: what its controls do there is not
    /// determined, and their sizes say nothing to the others.
    fn without_nothing(&mut self, mut all: Vec<Located>) -> Vec<Located> {
        loop {
            let fewer: Vec<_> =
                all.iter().map(|it| repair::without_nothing(&it.structure)).collect();
            if fewer.iter().all(Option::is_none) {
                return all;
            }
            let own = all.iter().map(|it| it.structure.clone());
            let fewer: Vec<Structure> =
                fewer.into_iter().zip(own).map(|(fewer, own)| fewer.unwrap_or(own)).collect();
            let better = self.solved_with(fewer, &all);
            match better.filter(|it| !it[0].is_worse(&all[0])) {
                Some(better) => all = better,
                None => return all,
            }
        }
    }

    /// All phases with other structures, from what was found.
    fn solved_with(&mut self, mut own: Vec<Structure>, all: &[Located]) -> Option<Vec<Located>> {
        let mut search = self.search(0);
        let mut from = search.whole(&seen_from(all.to_vec(), 0));
        let others = own.split_off(1);
        from.beside.iter_mut().zip(others).for_each(|(it, other)| it.0 = other);
        Some(in_order(search.solve(own.remove(0), &from)?, 0))
    }

    /// With one of the phases mended, and holds in it where they are worth having.
    fn mended(&mut self, all: Vec<Located>, own: usize) -> Option<Vec<Located>> {
        let mut search = self.search(own);
        let mended = search.mended(seen_from(all, own))?;
        let held = search.with_holds(mended);
        let refined = search.refined(held);
        let mut located = search.followed(refined);
        located.others.clear();
        Some(in_order(located, own))
    }
}

/// A smoothed phase with the others beside it, each with its structure.
fn beside_others(all: &[Structure], smoothed: &[Whole], own: usize) -> Whole {
    let others = all.iter().zip(smoothed).enumerate().filter(|it| it.0 != own);
    let beside = others.map(|(_, (structure, whole))| (structure.clone(), whole.clone()));
    Whole { beside: beside.collect(), ..smoothed[own].clone() }
}

/// One of the phases, with the others beside it.
fn seen_from(mut all: Vec<Located>, own: usize) -> Located {
    let located = all.remove(own);
    Located { beside: all, ..located }
}

/// All phases, of which `own` has the others beside it.
fn in_order(mut located: Located, own: usize) -> Vec<Located> {
    let mut all = std::mem::take(&mut located.beside);
    all.insert(own, located);
    all
}
