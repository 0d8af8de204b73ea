//! Sequences of jumps that are tried one after the other, each a chain of phases.

use super::found::{FoundChain, Sequence};
use super::multistart::{self, is_stopped};
use super::report::{Ended, Options, Part};
use super::tuning::sequences::{BRIEF, FEW_SEQUENCES, FEWEST_INTERVALS, WORSE};
use crate::error::Error;
use crate::executor::Executor;
use fdcc_compiler::Model;
use fdcc_runtime::nlp;
use fdcc_runtime::problem::{Chain, Grid, Method, Problem};
use fdcc_runtime::solve::multistart::is_better;

/// A sequence of jumps and crossings, and the chain of phases in which it happens.
#[derive(Clone)]
pub(super) struct Alternative {
    /// Of numbers; of a model with phases those of each.
    pub events: Vec<Vec<usize>>,
    /// The names of the jumps, with nothing for a surface that is crossed without one.
    pub jumps: Vec<Option<String>>,
    /// The names of these surfaces.
    pub crosses: Vec<String>,
    /// `no jump`, or `bounce, bounce`, or `crossing of rim, bounce`.
    pub words: String,
    pub model: Model,
    pub chain: Chain,
}

/// How sequences are solved.
pub(super) struct Solves<'s> {
    /// Where a solve may begin: at an earlier solution, and at the motion from the guess.
    pub starts: &'s (dyn Fn(&Alternative) -> [Option<nlp::Start>; 2] + Sync),
    /// Whether there are controls.
    pub is_driven: bool,
    pub has_objective: bool,
    /// The best objective so far; infinite where there is none.
    pub best: f64,
    pub options: &'s Options<'s>,
}

/// The best one; and the others that are solved, the best of them first.
pub(super) fn best_and_next(found: &[FoundChain]) -> (usize, Vec<usize>) {
    let solution = |at: usize| &found[at].outcome.solution;
    let better = |a: usize, b: usize| if is_better(solution(b), solution(a)) { b } else { a };
    let best = (0..found.len()).reduce(better).expect("that no jump happens is one of them");
    let others = (0..found.len()).filter(|at| *at != best && found[*at].is_solved());
    let mut next: Vec<usize> = others.collect();
    next.sort_by(|a, b| solution(*a).objective.total_cmp(&solution(*b).objective));
    (best, next)
}

/// The answer of each, up to the first that is enough. Where there are many, those that lead to
/// nothing on a coarse grid, or to something clearly worse, are left at that.
pub(super) fn each(all: &[Alternative], solves: &Solves) -> Result<Vec<FoundChain>, Error> {
    let are_few = all.len() <= FEW_SEQUENCES && solves.best.is_infinite();
    if are_few || !solves.has_objective {
        return on_own_grids(all, solves);
    }
    let briefly: Vec<Alternative> = all.iter().map(Alternative::brief).collect();
    let mut found = on_own_grids(&briefly, solves)?;
    let objectives = found.iter().filter(|it| it.is_solved());
    let best = objectives.map(|it| it.outcome.solution.objective).fold(solves.best, f64::min);
    if best.is_infinite() && found.len() == all.len() {
        return on_own_grids(all, solves);
    }
    for (alternative, own) in all.iter().zip(&mut found) {
        let objective = own.outcome.solution.objective;
        if own.is_solved() && objective <= best + WORSE * best.abs() {
            let alone = std::slice::from_ref(alternative);
            let whole = on_own_grids(alone, solves)?;
            *own = whole
                .into_iter()
                .next()
                .filter(FoundChain::is_solved)
                .unwrap_or_else(|| own.clone());
        }
    }
    Ok(found)
}

/// The same on the grids that they have.
fn on_own_grids(all: &[Alternative], solves: &Solves) -> Result<Vec<FoundChain>, Error> {
    let Solves { is_driven, has_objective, options, .. } = *solves;
    let one = |index: usize| {
        let alternative = &all[index];
        let part = Part { sequence: Some(&alternative.words), start: None };
        let [start, motion] = (solves.starts)(alternative);
        // With controls the guess of the model may know more than a motion that ignores its goal.
        let first = if is_driven { start } else { start.or(motion.clone()) };
        let mut found = multistart::solve(&alternative.chain, first, options, part)?;
        if let Some(motion) = motion.filter(|_| is_driven) {
            found = multistart::also_from(found, motion, options, part)?;
        }
        // A proof says something of the phases of this sequence only.
        found.outcome.is_impossible = false;
        found.outcome.solution.global = false;
        Ok(found)
    };
    // Without an objective one trajectory is as good as another.
    let is_enough =
        |it: &FoundChain| is_stopped(&it.outcome.solution) || !has_objective && it.is_solved();
    let ends = |found: &Result<FoundChain, Error>| found.as_ref().map_or(true, is_enough);
    // Several starts run in parallel already.
    let executor = if options.starts == 1 { options.executor } else { Executor::serial() };
    // The first may be all that is needed.
    let alone = if has_objective { 0 } else { 1 };
    let mut found: Vec<Result<FoundChain, Error>> = (0..alone).map(&one).collect();
    if !found.last().is_some_and(ends) {
        found.extend(executor.in_order(all.len() - alone, |at| one(at + alone), ends));
    }
    found.into_iter().collect()
}

impl Alternative {
    /// On coarse grids, which together have as many intervals as one phase is to have.
    fn brief(&self) -> Self {
        let count = self.chain.phases.len();
        let coarse = |method: &Method| match method.grid {
            Grid::Uniform(n) => Grid::Uniform((n / count).max(FEWEST_INTERVALS).min(n)),
            _ => method.grid.clone(),
        };
        let brief = |problem: &Problem| {
            let own = &problem.method;
            let max_iter = own.max_iter.min(BRIEF);
            let method = Method { grid: coarse(own), max_iter, ..own.clone() };
            Problem { method, ..problem.clone() }
        };
        let phases = self.chain.phases.iter().map(brief).collect();
        Alternative { chain: Chain { phases, ..self.chain.clone() }, ..self.clone() }
    }

    pub(super) fn tried(&self, found: &FoundChain, is_answer: bool) -> Sequence {
        Sequence {
            jumps: self.jumps.iter().flatten().cloned().collect(),
            crosses: self.crosses.clone(),
            words: self.words.clone(),
            is_answer,
            ended: Ended::of(&found.chain, &found.outcome),
        }
    }
}

/// The method of the phase with most intervals.
pub(super) fn finest(chain: &Chain) -> &Method {
    let methods = chain.phases.iter().rev().map(|phase| &phase.method);
    methods.max_by_key(|method| method.intervals()).expect("a chain has a phase")
}
