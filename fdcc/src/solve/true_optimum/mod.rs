//! The optimum of the system that was written, with every switch located:
//! `docs/method/true-optimum.md`.
//!
//! ```text
//! structure   modes and arcs, read from the smoothed solution
//! solve       the chain of phases that they make: smooth inside, switching times unknown
//! repair      phases that shrank to nothing, arcs with a multiplier of the wrong sign
//! insert      a hold where a surface is crossed, or where the motion begins or ends on it
//! certify     everything that an optimum of the true system meets
//! polish      the last digits of what is certified
//! ```

mod across;
mod across_surfaces;
mod angles;
mod answer;
mod between_nodes;
mod certificate;
mod contacts;
mod corners;
mod costates;
mod departures;
mod hold_sensitivities;
mod impulses;
mod insertion;
mod joined;
mod joint;
mod jump_edges;
mod kink_pushes;
mod mending;
mod minimum;
mod minimum_on_kinks;
mod on_surfaces;
mod orders;
mod parts;
mod path_values;
mod point;
mod polish;
mod polynomials;
mod pressed;
mod range;
mod refining;
mod repair;
mod replayed;
mod signs;
mod simpler;
mod slices;
mod start;
mod structure;
mod switches;
mod tracks;
mod tuning;

pub(crate) use answer::Whole;
pub use certificate::{Certificate, Check, Impulse, Stretch, Switch};
pub(crate) use contacts::Contacts;
pub(crate) use joint::{Joint, Part};
pub(crate) use mending::First;
pub(crate) use minimum_on_kinks::gain_on_kinks;
pub(crate) use parts::{halved_in_phases, locate_in_phases, polished_in_phases};
pub(crate) use path_values::path_at_ends;
pub(crate) use polynomials::beyond_bounds;
pub(crate) use range::{Range, ranges};
pub(crate) use repair::{is_attracted, jumps_in_the_end, wrong_sign};
pub(crate) use replayed::replayed;
pub(crate) use slices::{Slice, slices};
pub(crate) use structure::variations;
pub(crate) use tuning::certificate as certificate_limits;

use fdcc_compiler::{Model, limits};
use fdcc_runtime::nlp::Stop;
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::solve::ChainOutcome;
use insertion::Candidate;
use joint::{Among, Attempt, is_nearly_stationary, is_stationary};
use std::ops::ControlFlow;
use std::sync::Arc;
use structure::Structure;
use tuning::certificate::{MEASURED, WORTH};
use tuning::search::{GAIN, GAIN_OF_TRIAL, MOST_ALTERNATIVES, WORSE};
use tuning::structure::PART_AT_REST;

/// A structure with its optimum.
#[derive(Clone)]
pub(crate) struct Located {
    /// All that was solved at once: of a model with phases that of all of them.
    pub joint: Arc<Joint>,
    pub chain: Chain,
    pub outcome: ChainOutcome,
    pub structure: Structure,
    /// Those of the other phases of a model with phases, in their order.
    pub beside: Vec<Located>,
    /// What the objective changes by with each condition at the first time that nobody wrote: the
    /// first ones of the first phase.
    pub starts: Vec<f64>,
    /// By how much the objective falls with the duration of a hold that was not inserted, at most,
    /// for the size of the Hamiltonian.
    pub insertion: f64,
    /// By how much another control makes the Hamiltonian less, at most, for its size.
    pub gain: f64,
    /// What the objective loses, for its size, where a control differs from the best one.
    pub loss: f64,
    /// What was located on the way, to be looked at where this is not certified; the last first.
    pub others: Vec<Located>,
}

/// How a hold that was tried ended.
enum Trial {
    /// No optimum was found with it.
    Unsolved,
    NotBetter,
    Better(Box<Located>),
}

/// What a search needs to know.
struct Search<'s> {
    /// As it is written.
    written: &'s Model,
    /// What holds between its jumps.
    model: &'s Model,
    /// The smoothed problem.
    problem: &'s Problem,
    /// The model with phases of which it is one.
    among: Option<Among<'s>>,
    first: First,
    stop: &'s (dyn Fn() -> ControlFlow<Stop> + Sync),
    spent: &'s mut Spent,
}

/// What was done so far to locate an optimum.
#[derive(Default)]
pub(crate) struct Spent {
    solves: usize,
    /// Iterations of all solves, each times its intervals.
    work: usize,
    /// Those that found nothing.
    lost: Vec<Attempt>,
}

/// Looks for the optimum of the true system near a smoothed solution; nothing where none is found.
/// `problem` and `model` are what holds between the jumps of what is `written`.
pub(crate) fn locate(
    [written, model]: [&Model; 2],
    problem: &Problem,
    (smoothed, first): (&Whole, First),
    stop: &(dyn Fn() -> ControlFlow<Stop> + Sync),
    spent: &mut Spent,
) -> Option<Located> {
    let mut search = Search { written, model, problem, among: None, first, stop, spent };
    let structure = Structure::of(problem, smoothed, limits(model).len());
    let first = search.repaired(structure, smoothed)?;
    Some(search.completed(first))
}

/// Looks for the optimum of the true system with the structure of an `earlier` one, which may have
/// been found for other values of parameters; nothing where none is found with it.
/// The other arguments are those of [`locate`].
pub(crate) fn locate_again(
    [written, model]: [&Model; 2],
    problem: &Problem,
    earlier: &Located,
    stop: &(dyn Fn() -> ControlFlow<Stop> + Sync),
    spent: &mut Spent,
) -> Option<Located> {
    let first = First::Controls;
    let mut search = Search { written, model, problem, among: None, first, stop, spent };
    let solved = search.solve(earlier.structure.clone(), &earlier.whole(problem))?;
    let mended = search.mended(solved)?;
    Some(search.completed(mended))
}

/// The same structure on shorter intervals, in a few places or of half the length; nothing where
/// some were halved `most` times.
/// The other arguments are those of [`locate`].
pub(crate) fn on_half_intervals(
    [written, model]: [&Model; 2],
    problem: &Problem,
    (located, most): (&Located, u32),
    stop: &(dyn Fn() -> ControlFlow<Stop> + Sync),
    spent: &mut Spent,
) -> Option<Located> {
    let mut search =
        Search { written, model, problem, among: None, first: First::Controls, stop, spent };
    let sharper = search.sharpened(located).or_else(|| located.structure.halved(most))?;
    let finer = search.solve(sharper, &search.whole(located))?;
    let mut finer = Located { insertion: located.insertion, ..finer };
    search.compared(&mut finer);
    Some(finer)
}

/// The same optimum with more of its digits; nothing where there are none.
/// The arguments are those of [`locate`].
pub(crate) fn polished(
    [written, model]: [&Model; 2],
    problem: &Problem,
    located: &Located,
    stop: &(dyn Fn() -> ControlFlow<Stop> + Sync),
    spent: &mut Spent,
) -> Option<Located> {
    Search { written, model, problem, among: None, first: First::Controls, stop, spent }
        .polished(located)
}

impl Search<'_> {
    /// Solves, and mends the structure until nothing contradicts it.
    fn repaired(&mut self, structure: Structure, from: &Whole) -> Option<Located> {
        let located = self.first_solved(structure, from)?;
        self.mended(located)
    }

    /// With the holds that it is worth having, as accurate as it can be.
    fn completed(&mut self, located: Located) -> Located {
        let mut held = self.with_holds(located);
        let passed = std::mem::take(&mut held.others);
        let refined = self.refined(held);
        let mut located = self.followed(refined);
        located.others.extend(self.alternatives(passed));
        located
    }

    /// What was passed by on the way, ready to be certified. Where surfaces may be held these are
    /// none: holds were inserted in the last one only.
    fn alternatives(&self, passed: Vec<Located>) -> Vec<Located> {
        let is_smooth = self.model.surfaces.is_empty() && self.written.jumps.is_empty();
        let last = passed.into_iter().rev().filter(|_| is_smooth).take(MOST_ALTERNATIVES);
        let ready = last.map(|it| {
            let mut it = Located { insertion: 0.0, ..it };
            self.compared(&mut it);
            it
        });
        ready.collect()
    }

    /// Solves; where that fails, without arcs on holds, and then without ever longer phases: what a
    /// smoothed layer looks like need not be there; then with free controls.
    fn first_solved(&mut self, structure: Structure, from: &Whole) -> Option<Located> {
        let released = structure.released();
        self.simplest_solved(structure, from).or_else(|| self.solve(released?, from))
    }

    fn simplest_solved(&mut self, structure: Structure, from: &Whole) -> Option<Located> {
        let mut simpler = Some(structure);
        while let Some(structure) = simpler {
            if let Some(located) = self.solve(structure.clone(), from) {
                return Some(located);
            }
            simpler = structure.simpler();
        }
        None
    }

    /// With holds where they are worth having.
    fn with_holds(&mut self, mut located: Located) -> Located {
        located.insertion = 0.0;
        let candidates = self.candidates(&located).into_iter();
        for candidate in candidates.filter(|it| it.slope < -WORTH || it.is_forced) {
            match self.held(&located, &candidate) {
                Trial::Better(better) => return self.with_holds(*better),
                Trial::Unsolved if candidate.is_doubtful => {}
                _ if candidate.is_forced => located.insertion = f64::INFINITY,
                Trial::NotBetter if candidate.slope == f64::NEG_INFINITY => {}
                _ => located.insertion = located.insertion.max(-candidate.slope),
            }
        }
        located
    }

    /// From a short phase; where that leads to nothing better though the objective is known to
    /// fall, or may fall to second order, from a longer one.
    fn held(&mut self, located: &Located, candidate: &Candidate) -> Trial {
        let base = candidate.into.as_ref().unwrap_or(&located.structure);
        let (before, phase) = (candidate.before, &candidate.held);
        let first = self.tried(located, candidate, base.with_phase(before, phase.clone()));
        match first {
            Trial::Better(_) => first,
            _ if candidate.slope == f64::NEG_INFINITY && !candidate.is_doubtful => first,
            _ => self.tried(located, candidate, base.with_longer_phase(before, phase.clone())),
        }
    }

    fn tried(&mut self, located: &Located, candidate: &Candidate, structure: Structure) -> Trial {
        let is_better = |held: &Located| {
            if candidate.is_forced {
                return true;
            }
            let [own, its] = [held, located].map(|it| it.outcome.solution.objective);
            let is_known = candidate.slope > f64::NEG_INFINITY;
            let least = if is_known { GAIN } else { GAIN_OF_TRIAL };
            own < its - least * its.abs().max(located.objective_size())
        };
        let whole = self.whole(located);
        let Some(first) = self.ended(structure, &whole) else { return Trial::Unsolved };
        if !is_stationary(&first.outcome.solution) {
            let is_told = is_nearly_stationary(&first.outcome.solution) && !is_better(&first);
            return if is_told { Trial::NotBetter } else { Trial::Unsolved };
        }
        // What is left out of it may have been worth little, but not nothing.
        let mended = self.mended(first.clone()).into_iter();
        let held = mended.chain([first]).find(is_better);
        held.map_or(Trial::NotBetter, |it| Trial::Better(Box::new(it)))
    }
}

impl Located {
    /// Whether its structure is one of a model.
    pub fn fits(&self, model: &Model, jumps: usize) -> bool {
        let own = &self.structure.phases[0];
        let phases = self.structure.phases.iter();
        own.modes.len() == model.switches().len()
            && own.arcs.len() == model.controls.len()
            && own.contacts.len() == limits(model).len()
            && phases.filter_map(|it| it.jump).all(|jump| jump < jumps)
    }

    /// Whether another optimum was found, and a worse one.
    fn is_worse(&self, other: &Located) -> bool {
        self.rises(other, WORSE)
    }

    /// Whether its objective is more than that of another by a part of the size of that.
    fn rises(&self, other: &Located, part: f64) -> bool {
        let [own, its] = [self, other].map(|it| it.outcome.solution.objective);
        own > its + part * its.abs().max(other.objective_size())
    }

    /// What the terms of the Hamiltonian add up to over time.
    pub fn objective_size(&self) -> f64 {
        let sizes = self.outcome.phases.iter().map(|it| it.trajectory.hamiltonian.scale);
        let durations = self.structure.times.windows(2).map(|pair| pair[1] - pair[0]);
        sizes.zip(durations).map(|(size, duration)| size * duration.max(0.0)).sum()
    }

    /// That of the Hamiltonian of a phase; where nothing is at stake any more, all of its terms are
    /// rounding, and a part of its size elsewhere counts.
    fn size_of_phase(&self, j: usize) -> f64 {
        let own = self.outcome.phases[j].trajectory.hamiltonian.scale;
        own.max(PART_AT_REST * self.largest_size())
    }

    /// That of the Hamiltonian where it is largest, in all phases of a model.
    fn largest_size(&self) -> f64 {
        let sizes = self.joint.outcome.phases.iter().map(|it| it.trajectory.hamiltonian.scale);
        sizes.fold(0.0, f64::max)
    }

    /// Less is no size of a Hamiltonian: of measured data that is what makes a difference to them.
    fn least_size(&self, model: &Model) -> f64 {
        let [first, last] = self.structure.ends();
        let measured = || model.objective_at_rest().map_or(0.0, f64::abs);
        let size = if model.objective_reads_sums() { MEASURED * measured() } else { 0.0 };
        (size / (last - first)).max(f64::MIN_POSITIVE)
    }

    /// When phases begin; and the last time.
    fn times(&self) -> Vec<f64> {
        let phases = self.outcome.phases.iter().map(|it| &it.trajectory.time);
        let last = phases.clone().next_back().and_then(|it| it.last().copied());
        phases.map(|it| it[0]).chain(last).collect()
    }
}
