//! A model with jumps: each sequence of jumps that may happen is a problem of its own, and the best
//! answer is taken.

use super::found::{Found, FoundChain, Jump, Phases, Sequence};
use super::multistart::{self, all_attempts, first_stopped, is_stopped, unless_stopped};
use super::report::{Ended, Options, Part, Report};
use super::tuning::sequences::{
    BRIEF, FEW, FEW_SEQUENCES, FEWEST_INTERVALS, LONGEST, NEXT, SHORTEST, STEPS, WORSE,
};
use crate::error::Error;
use crate::executor::Executor;
use crate::record::Record;
use crate::warm_start;
use fdcc_compiler::{
    Alike, Model, Sequences, compile_chain_like, compile_simulation, crossings, sequences,
    with_phases,
};
use fdcc_runtime::nlp;
use fdcc_runtime::problem::{Chain, Grid, Method, Problem};
use fdcc_runtime::simulate::{
    Controls, Event, EventKind, Options as Accuracy, Status, System, simulate,
};
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
    let mut possible = sequences(model).map_err(Error::Model)?;
    if let Some(likely) = simulated(model, &possible) {
        possible.all.retain(|sequence| *sequence != likely);
        possible.all.insert(0, likely);
    }
    let count = possible.all.len();
    let in_time = |at: usize| at == 0 || (options.stop)().is_continue();
    let all = possible.all.into_iter().enumerate().take_while(|(at, _)| in_time(*at));
    let mut alike = Alike::default();
    let all: Result<Vec<Alternative>, Error> =
        all.map(|(_, sequence)| Alternative::new(model, sequence, &mut alike)).collect();
    let all = all?;
    let is_cut = possible.is_cut || all.len() < count;
    let found = each(&all, between, earlier, options)?;
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
fn each(
    all: &[Alternative],
    between: &Problem,
    earlier: Option<&Record>,
    options: &Options,
) -> Result<Vec<FoundChain>, Error> {
    if all.len() <= FEW_SEQUENCES || !between.has_objective {
        return on_own_grids(all, between, earlier, options);
    }
    let briefly: Vec<Alternative> = all.iter().map(Alternative::brief).collect();
    let mut found = on_own_grids(&briefly, between, earlier, options)?;
    let objectives = found.iter().filter(|it| it.is_solved());
    let best = objectives.map(|it| it.outcome.solution.objective).fold(f64::INFINITY, f64::min);
    if best.is_infinite() && found.len() == all.len() {
        return on_own_grids(all, between, earlier, options);
    }
    for (alternative, own) in all.iter().zip(&mut found) {
        let objective = own.outcome.solution.objective;
        if own.is_solved() && objective <= best + WORSE * best.abs() {
            let alone = std::slice::from_ref(alternative);
            let whole = on_own_grids(alone, between, earlier, options)?;
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
fn on_own_grids(
    all: &[Alternative],
    between: &Problem,
    earlier: Option<&Record>,
    options: &Options,
) -> Result<Vec<FoundChain>, Error> {
    let one = |index: usize| {
        let alternative = &all[index];
        let start = alternative.start(between, earlier);
        let part = Part { sequence: Some(&alternative.words), start: None };
        let mut found = multistart::solve(&alternative.chain, start, options, part)?;
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

/// The jumps and crossings on the true system with everything as it is guessed.
fn simulated(model: &Model, possible: &Sequences) -> Option<Vec<usize>> {
    let system = compile_simulation(model).ok()?;
    let simulation =
        simulate(&system, &Controls::Guess, &Accuracy { max_steps: STEPS, ..Accuracy::default() });
    let mut sequence = Vec::new();
    for event in &simulation.events {
        sequence.extend(happening(&system, possible, &sequence, event));
    }
    let is_whole = matches!(simulation.status, Status::Completed);
    let is_finite = !piles_up(&simulation.events);
    (is_whole && is_finite && sequence.len() <= LONGEST).then_some(sequence)
}

/// Whether events follow each other ever faster: no finite number of phases is all of them.
fn piles_up(events: &[Event]) -> bool {
    let between = |pair: &[Event]| pair[1].time - pair[0].time;
    let longest = events.windows(2).map(between).fold(0.0, f64::max);
    let is_short = |pair: &[Event]| between(pair) < SHORTEST * longest;
    events.len() > FEW && events.windows(2).any(is_short)
}

/// The jump or the crossing that an event is, if it is one.
fn happening(
    system: &System,
    possible: &Sequences,
    earlier: &[usize],
    event: &Event,
) -> Option<usize> {
    let is_falling = match event.kind {
        EventKind::Jump(at) => return Some(at),
        // Against the direction of a jump.
        EventKind::CrossesUp => true,
        EventKind::CrossesDown => false,
        _ => return None,
    };
    let crossed = |at: &usize| {
        let jump = &system.jumps[*at];
        let is_first = !earlier.contains(at) && !earlier.contains(&(at + system.jumps.len()));
        possible.may_cross[*at]
            && is_first
            && (jump.surface, jump.is_falling) == (event.surface, is_falling)
    };
    (0..system.jumps.len()).find(crossed).map(|at| at + system.jumps.len())
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
