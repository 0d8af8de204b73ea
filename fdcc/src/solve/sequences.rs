//! A model with jumps: each sequence of jumps that may happen is a problem of its own, and the best
//! answer is taken.

use super::alternatives::{self, Alternative, Solves, best_and_next, finest};
use super::found::{Found, FoundChain, Jump, Phases};
use super::multistart::{all_attempts, first_stopped, unless_stopped};
use super::report::{Ended, Options, Part, Report};
use super::sequence_of_guess::{self, Guessed};
use super::tuning::sequences::{MOST_CLIMBS, NEXT};
use crate::error::Error;
use crate::record::Record;
use crate::warm_start;
use fdcc_compiler::{
    Alike, Model, Sequences, compile_chain_like, crossings, sequences, with_phases,
};
use fdcc_runtime::nlp;
use fdcc_runtime::problem::Problem;
use fdcc_runtime::solution::phases::{self, joined};

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

impl Starts<'_> {
    fn each(&self, all: &[Alternative]) -> Result<Vec<FoundChain>, Error> {
        let Starts { between, earlier, guessed, best, options } = *self;
        let is_driven = !between.controls.is_empty();
        let starts = |it: &Alternative| {
            let guessed = guessed.filter(|guess| guess.is_near(&it.events[0], is_driven));
            let phases = it.chain.phases.len();
            let start = |guess| sequence_of_guess::start(&[(guess, phases)], between, &it.chain);
            [it.start(between, earlier), guessed.map(start)]
        };
        let has_objective = between.has_objective;
        let solves = Solves { starts: &starts, is_driven, has_objective, best, options };
        alternatives::each(all, &solves)
    }
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
            if self.all.iter().chain(&new).all(|it| it.events[0] != sequence) {
                new.push(Alternative::new(self.model, sequence, &mut self.alike)?);
            }
        }
        self.found.extend(starts.each(&new)?);
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
            let new = own.chain(possible.beside(&self.all[best].events[0])).collect();
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
        Ok(Alternative { events: vec![sequence], jumps, crosses, words, model, chain })
    }

    fn start(&self, between: &Problem, earlier: Option<&Record>) -> Option<nlp::Start> {
        let is_its = |it: &&Record| {
            let jumps = it.jumps.iter().map(|jump| jump.jump);
            self.jumps.iter().flatten().eq(jumps) && self.crosses.is_empty()
        };
        earlier.filter(is_its).and_then(|it| warm_start::phases::start(it, between, &self.chain))
    }

    /// The answer as one trajectory.
    fn joined(self, between: &Problem, found: FoundChain) -> Found {
        let FoundChain { chain, outcome, step_errors, starts, .. } = found;
        let (whole, jumps) = joined(between, &chain, &outcome);
        let jumps = self.jumps.into_iter().zip(jumps);
        let jumps = jumps.filter_map(|(name, jump)| Some(happened(between, name?, jump))).collect();
        let problem = Problem { method: finest(&chain).clone(), ..between.clone() };
        let phases = Some(Phases { model: self.model, chain, outcome });
        let events = self.events.into_iter().next().unwrap_or_default();
        Found { step_errors, starts, jumps, phases, events, ..Found::new(problem, whole) }
    }
}

pub(super) fn happened(between: &Problem, name: String, found: phases::Jump) -> Jump {
    let phases::Jump { time, before, after } = found;
    let named = |values: Vec<f64>| -> Vec<(String, f64)> {
        between.states.iter().map(|state| state.name.clone()).zip(values).collect()
    };
    Jump { name, time, before: named(before), after: named(after) }
}
