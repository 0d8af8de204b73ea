//! A model with jumps: each sequence of jumps that may happen is a problem of its own, and the best
//! answer is taken.

use super::found::{Found, FoundChain, Jump, Phases, Sequence};
use super::multistart::{self, all_attempts, first_stopped, is_stopped, unless_stopped};
use super::report::{Ended, Options, Part, Report};
use super::sequence_of_guess::Guessed;
use super::tuning::sequences::{BRIEF, FEW_SEQUENCES, FEWEST_INTERVALS, MOST_CLIMBS, NEXT, WORSE};
use crate::error::Error;
use crate::executor::Executor;
use crate::record::Record;
use crate::warm_start;
use fdcc_compiler::{
    Alike, Model, Sequences, compile_chain_like, crossings, sequences, with_phases,
};
use fdcc_runtime::nlp;
use fdcc_runtime::problem::{Chain, Grid, Method, Problem};
use fdcc_runtime::solution::phases::{self, joined};
use fdcc_runtime::solve::multistart::is_better;

/// A sequence of jumps and crossings, and the chain of phases in which it happens.
#[derive(Clone)]
struct Alternative {
    /// Of numbers.
    events: Vec<usize>,
    /// The names of the jumps, with nothing for a surface that is crossed without one.
    jumps: Vec<Option<String>>,
    /// The names of these surfaces.
    crosses: Vec<String>,
    /// `no jump`, or `bounce, bounce`, or `crossing of rim, bounce`.
    words: String,
    model: Model,
    chain: Chain,
}

/// Solves for every sequence; `between` is what holds between the jumps. An earlier solution is the
/// start of the sequence that it has.
pub(super) fn solve(
    model: &Model,
    between: &Problem,
    earlier: Option<&Record>,
    options: &Options,
) -> Result<Found, Error> {
    let possible = sequences(model).map_err(Error::Model)?;
    let guessed = Guessed::of(model, &possible);
    let starts =
        Starts { between, earlier, guessed: guessed.as_ref(), best: f64::INFINITY, options };
    let mut tried = Tried { model, starts, alike: Alike::default(), all: vec![], found: vec![] };
    // Of measured data what happens near the guess is meant, as what is estimated is.
    let is_fit = !model.sums.is_empty() && model.controls.is_empty();
    if let Some(likely) = guessed.as_ref().filter(|_| is_fit) {
        tried.add(vec![likely.events.clone()], &starts)?;
        tried.climb(&possible)?;
    }
    let mut others = possible.all.clone();
    if let Some(likely) = guessed.as_ref() {
        others.retain(|sequence| *sequence != likely.events);
        others.insert(0, likely.events.clone());
    }
    let count = others.len();
    if !tried.found.iter().any(FoundChain::is_solved) {
        tried.add(others, &starts)?;
        tried.climb(&possible)?;
    }
    let is_cut = possible.is_cut || tried.all.len() < count;
    let Tried { all, found, .. } = tried;
    let words = all.iter().map(|it| it.words.as_str());
    for (sequence, found) in words.zip(&found) {
        let part = Part { sequence: Some(sequence), start: None };
        (options.report)(&Report::Ended(part, &Ended::of(&found.chain, &found.outcome)));
    }
    let outcomes = found.iter().map(|it| &it.outcome);
    let (attempts, stopped) = (all_attempts(outcomes.clone()), first_stopped(outcomes));
    let answer = |at: usize| {
        let tried = all.iter().zip(&found).enumerate();
        let tried = tried.map(|(other, (it, found))| it.tried(found, other == at));
        let (alternative, mut own) = (all[at].clone(), found[at].clone());
        own.outcome.attempts.clone_from(&attempts);
        unless_stopped(&mut own.outcome.solution, stopped.clone());
        Found { sequences: tried.collect(), is_cut, ..alternative.joined(between, own) }
    };
    let (best, next) = best_and_next(&found);
    Ok(Found { next: next.into_iter().take(NEXT).map(answer).collect(), ..answer(best) })
}

/// Where solves begin.
#[derive(Clone, Copy)]
struct Starts<'s> {
    between: &'s Problem,
    earlier: Option<&'s Record<'s>>,
    /// What happens as it is guessed.
    guessed: Option<&'s Guessed>,
    /// The best objective so far; infinite where there is none.
    best: f64,
    options: &'s Options<'s>,
}

/// The sequences that were tried, each with its answer.
struct Tried<'s> {
    model: &'s Model,
    starts: Starts<'s>,
    alike: Alike,
    all: Vec<Alternative>,
    found: Vec<FoundChain>,
}

impl Tried<'_> {
    /// Tries more, as long as there is time.
    fn add(&mut self, sequences: Vec<Vec<usize>>, starts: &Starts) -> Result<(), Error> {
        let mut new: Vec<Alternative> = Vec::new();
        for sequence in sequences {
            let is_first = self.all.is_empty() && new.is_empty();
            if !is_first && (starts.options.stop)().is_break() {
                break;
            }
            if self.all.iter().chain(&new).all(|it| it.events != sequence) {
                new.push(Alternative::new(self.model, sequence, &mut self.alike)?);
            }
        }
        self.found.extend(each(&new, starts)?);
        self.all.extend(new);
        Ok(())
    }

    /// What happens on the true system with the unknowns of the best answer, and one jump more or
    /// less, as long as that is better. Controls would lead elsewhere.
    fn climb(&mut self, possible: &Sequences) -> Result<(), Error> {
        let is_free = self.model.controls.is_empty() && self.starts.between.has_objective;
        for _ in 0..MOST_CLIMBS {
            if !is_free || !self.found.iter().any(FoundChain::is_solved) {
                return Ok(());
            }
            let (best, _) = best_and_next(&self.found);
            let motion = Guessed::of(&self.with_unknowns_of(best), possible);
            let own = motion.iter().map(|it| it.events.clone());
            let new = own.chain(possible.beside(&self.all[best].events)).collect();
            let best_so_far = self.found[best].outcome.solution.objective;
            let starts = Starts { guessed: motion.as_ref(), best: best_so_far, ..self.starts };
            self.add(new, &starts)?;
            if best_and_next(&self.found).0 == best {
                return Ok(());
            }
        }
        Ok(())
    }

    /// The model whose guess they are.
    fn with_unknowns_of(&self, at: usize) -> Model {
        let FoundChain { outcome, .. } = &self.found[at];
        let values = &outcome.phases[0].trajectory.parameters;
        let unknowns = &self.starts.between.unknowns;
        let mut model = self.model.clone();
        for it in unknowns {
            let name = &self.starts.between.parameters[it.parameter].name;
            model.set_free(name, values[it.parameter]);
        }
        model
    }
}

/// The best one; and the others that are solved, the best of them first.
fn best_and_next(found: &[FoundChain]) -> (usize, Vec<usize>) {
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
fn each(all: &[Alternative], starts: &Starts) -> Result<Vec<FoundChain>, Error> {
    let are_few = all.len() <= FEW_SEQUENCES && starts.best.is_infinite();
    if are_few || !starts.between.has_objective {
        return on_own_grids(all, starts);
    }
    let briefly: Vec<Alternative> = all.iter().map(Alternative::brief).collect();
    let mut found = on_own_grids(&briefly, starts)?;
    let objectives = found.iter().filter(|it| it.is_solved());
    let best = objectives.map(|it| it.outcome.solution.objective).fold(starts.best, f64::min);
    if best.is_infinite() && found.len() == all.len() {
        return on_own_grids(all, starts);
    }
    for (alternative, own) in all.iter().zip(&mut found) {
        let objective = own.outcome.solution.objective;
        if own.is_solved() && objective <= best + WORSE * best.abs() {
            let alone = std::slice::from_ref(alternative);
            let whole = on_own_grids(alone, starts)?;
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
fn on_own_grids(all: &[Alternative], starts: &Starts) -> Result<Vec<FoundChain>, Error> {
    let Starts { between, earlier, guessed, options, .. } = *starts;
    let one = |index: usize| {
        let alternative = &all[index];
        let part = Part { sequence: Some(&alternative.words), start: None };
        let is_near = |it: &&Guessed| it.is_near(&alternative.events, between);
        let motion = guessed.filter(is_near).map(|it| it.start(between, &alternative.chain));
        let start = alternative.start(between, earlier);
        // With controls the guess of the model may know more than a motion that ignores its goal.
        let first = if between.controls.is_empty() { start.or(motion.clone()) } else { start };
        let mut found = multistart::solve(&alternative.chain, first, options, part)?;
        if let Some(motion) = motion.filter(|_| !between.controls.is_empty()) {
            found = multistart::also_from(found, motion, options, part)?;
        }
        // A proof says something of the phases of this sequence only.
        found.outcome.is_impossible = false;
        found.outcome.solution.global = false;
        Ok(found)
    };
    // Without an objective one trajectory is as good as another.
    let is_enough = |it: &FoundChain| {
        is_stopped(&it.outcome.solution) || !between.has_objective && it.is_solved()
    };
    let ends = |found: &Result<FoundChain, Error>| found.as_ref().map_or(true, is_enough);
    // Several starts run in parallel already.
    let executor = if options.starts == 1 { options.executor } else { Executor::serial() };
    // The first may be all that is needed.
    let alone = if between.has_objective { 0 } else { 1 };
    let mut found: Vec<Result<FoundChain, Error>> = (0..alone).map(&one).collect();
    if !found.last().is_some_and(ends) {
        found.extend(executor.in_order(all.len() - alone, |at| one(at + alone), ends));
    }
    found.into_iter().collect()
}

impl Alternative {
    fn new(between: &Model, sequence: Vec<usize>, alike: &mut Alike) -> Result<Self, Error> {
        let model = with_phases(between, &sequence).map_err(Error::Model)?;
        let chain = compile_chain_like(&model, alike).map_err(Error::Model)?;
        let all = [between.jumps.clone(), crossings(between)].concat();
        let names: Vec<&str> = sequence.iter().map(|at| all[*at].place.name.as_str()).collect();
        let words = if names.is_empty() { "no jump".into() } else { names.join(", ") };
        let against = sequence.iter().filter_map(|at| at.checked_sub(between.jumps.len()));
        let surface = |at: usize| between.surfaces[between.jumps[at].surface].place.name.clone();
        let crosses = against.map(surface).collect();
        let jump = |at: &usize| Some(between.jumps.get(*at)?.place.name.clone());
        let jumps = sequence.iter().map(jump).collect();
        Ok(Alternative { events: sequence, jumps, crosses, words, model, chain })
    }

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

    fn start(&self, between: &Problem, earlier: Option<&Record>) -> Option<nlp::Start> {
        let is_its = |it: &&Record| {
            let jumps = it.jumps.iter().map(|jump| jump.jump);
            self.jumps.iter().flatten().eq(jumps) && self.crosses.is_empty()
        };
        earlier.filter(is_its).and_then(|it| warm_start::phases::start(it, between, &self.chain))
    }

    fn tried(&self, found: &FoundChain, is_answer: bool) -> Sequence {
        Sequence {
            jumps: self.jumps.iter().flatten().cloned().collect(),
            crosses: self.crosses.clone(),
            words: self.words.clone(),
            is_answer,
            ended: Ended::of(&found.chain, &found.outcome),
        }
    }

    /// The answer as one trajectory.
    fn joined(self, between: &Problem, found: FoundChain) -> Found {
        let FoundChain { chain, outcome, step_errors, starts, .. } = found;
        let (whole, jumps) = joined(between, &chain, &outcome);
        let jumps = self.jumps.into_iter().zip(jumps);
        let jumps = jumps.filter_map(|(name, jump)| Some(happened(between, name?, jump))).collect();
        let problem = Problem { method: finest(&chain).clone(), ..between.clone() };
        let phases = Some(Phases { model: self.model, chain, outcome });
        let events = self.events;
        Found { step_errors, starts, jumps, phases, events, ..Found::new(problem, whole) }
    }
}

/// The method of the phase with most intervals.
fn finest(chain: &Chain) -> &Method {
    let methods = chain.phases.iter().rev().map(|phase| &phase.method);
    methods.max_by_key(|method| method.intervals()).expect("a chain has a phase")
}

pub(super) fn happened(between: &Problem, name: String, found: phases::Jump) -> Jump {
    let phases::Jump { time, before, after } = found;
    let named = |values: Vec<f64>| -> Vec<(String, f64)> {
        between.states.iter().map(|state| state.name.clone()).zip(values).collect()
    };
    Jump { name, time, before: named(before), after: named(after) }
}
