//! A model with jumps: each sequence of jumps that may happen is a problem of its own, and the best
//! answer is taken.

use crate::output::named::Named;
use crate::output::saved::Saved;
use crate::output::tried::{Ended, Happened, Tried};
use crate::search::{Found, Search, all_attempts, first_stopped, is_stopped, unless_stopped};
use crate::solver::Failure;
use crate::warm;
use fdcc::parallel;
use fdcc_compiler::{
    Model, Sequences, compile, compile_simulation, crossings, sequences, with_phases,
};
use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::{ControlShape, Problem};
use fdcc_runtime::simulate::{Controls, Event, Kind, Options, Status, System, simulate};
use fdcc_runtime::solution::phases::{Jump, joined};
use fdcc_runtime::solve::Outcome;
use fdcc_runtime::solve::multistart;

/// What was solved in place of a model with jumps: its pieces side by side.
pub struct Unrolled {
    pub model: Model,
    pub problem: Problem,
    pub outcome: Outcome,
}

/// A sequence of jumps and crossings, and the problem in which it happens.
struct Alternative {
    /// Indices into the jumps of the model, and behind these into its [`crossings`].
    sequence: Vec<usize>,
    model: Model,
    problem: Problem,
}

/// Solves for every sequence; `between` is what holds between the jumps. An earlier solution is the
/// start of the sequence that it has.
pub fn solve(
    model: &Model,
    between: &Problem,
    earlier: Option<&Saved>,
    search: Search,
) -> Result<Found, Failure> {
    refuse(between)?;
    let mut possible = sequences(model).map_err(Failure::Model)?;
    if let Some(likely) = simulated(model, &possible) {
        possible.all.retain(|sequence| *sequence != likely);
        possible.all.insert(0, likely);
    }
    let (deadline, count) = (search.deadline, possible.all.len());
    let in_time = |at: usize| at == 0 || deadline.check().is_continue();
    let all = possible.all.into_iter().enumerate().take_while(|(at, _)| in_time(*at));
    let all: Result<Vec<Alternative>, Failure> =
        all.map(|(_, sequence)| Alternative::new(model, sequence)).collect();
    let all = all?;
    let is_cut = possible.is_cut || all.len() < count;
    let one = |index: usize| {
        let log = &mut search.log.of_part(&all[index].words(model));
        let start = all[index].start(model, between, earlier);
        let mut found = Search { log, ..search }.solve(&all[index].problem, start)?;
        // A proof says something of the pieces of this sequence only.
        found.outcome.is_impossible = false;
        found.outcome.solution.global = false;
        Ok(found)
    };
    // Without an objective one trajectory is as good as another.
    let is_enough =
        |found: &Found| is_stopped(&found.outcome) || !between.has_objective && found.is_good();
    let ends = |found: &Result<Found, Failure>| found.as_ref().map_or(true, is_enough);
    // Several starts run in parallel already.
    let threads = if search.starts == 1 { parallel::processors() } else { 1 };
    let found = parallel::in_order(all.len(), threads, one, ends);
    let found: Vec<Found> = found.into_iter().collect::<Result<_, Failure>>()?;
    for (alternative, found) in all.iter().zip(&found) {
        search.log.ended(&alternative.words(model), &Ended::of(&found.problem, &found.outcome));
    }
    let solutions = found.iter().map(|it| &it.outcome.solution).enumerate();
    let best = solutions.reduce(|a, b| if multistart::is_better(b.1, a.1) { b } else { a });
    let best = best.expect("that no jump happens is one of them").0;
    let tried = all
        .iter()
        .zip(&found)
        .enumerate()
        .map(|(at, (it, found))| it.tried(model, found, at == best));
    let tried = tried.collect();
    let outcomes = found.iter().map(|it| &it.outcome);
    let (attempts, stopped) = (all_attempts(outcomes.clone()), first_stopped(outcomes));
    let (alternatives, found) = (all.into_iter().nth(best), found.into_iter().nth(best));
    let (alternative, mut found) = alternatives.zip(found).expect("it is one of them");
    found.outcome.attempts = attempts;
    unless_stopped(&mut found.outcome, stopped);
    Ok(alternative.joined(model, between, Found { tried, is_cut, ..found }))
}

/// A guess is not worth more steps of a simulation.
const STEPS: usize = 20_000;
/// More are not looked for where the guess leads to that many.
const LONGEST: usize = 12;

/// The jumps and crossings on the true system with everything as it is guessed.
fn simulated(model: &Model, possible: &Sequences) -> Option<Vec<usize>> {
    let system = compile_simulation(model).ok()?;
    let simulation =
        simulate(&system, &Controls::Guess, &Options { max_steps: STEPS, ..Options::default() });
    let mut sequence = Vec::new();
    for event in &simulation.events {
        sequence.extend(happening(&system, possible, &sequence, event));
    }
    let is_whole = matches!(simulation.status, Status::Completed);
    (is_whole && sequence.len() <= LONGEST).then_some(sequence)
}

/// The jump or the crossing that an event is, if it is one.
fn happening(
    system: &System,
    possible: &Sequences,
    earlier: &[usize],
    event: &Event,
) -> Option<usize> {
    let is_falling = match event.kind {
        Kind::Jump(at) => return Some(at),
        // Against the direction of a jump.
        Kind::CrossesUp => true,
        Kind::CrossesDown => false,
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

/// What only a model without jumps can do.
fn refuse(between: &Problem) -> Result<(), Failure> {
    match between.method.controls {
        ControlShape::Constant => Ok(()),
        ControlShape::Linear | ControlShape::Polynomial => Err(Failure::Usage(
            "`controls = linear` and `polynomial` are for models without jumps".into(),
        )),
    }
}

impl Alternative {
    fn new(model: &Model, sequence: Vec<usize>) -> Result<Self, Failure> {
        let model = with_phases(model, &sequence).map_err(Failure::Model)?;
        let problem = compile(&model).map_err(Failure::Model)?;
        Ok(Alternative { sequence, model, problem })
    }

    fn start(&self, model: &Model, between: &Problem, earlier: Option<&Saved>) -> Option<Start> {
        let is_its = |it: &&Saved| {
            self.jumps(model).eq(it.jumps.iter().map(|jump| &jump.jump))
                && self.crosses(model).next().is_none()
        };
        earlier.filter(is_its).and_then(|it| warm::pieces::start(it, between, &self.problem))
    }

    /// The names of the jumps.
    fn jumps<'m>(&self, model: &'m Model) -> impl Iterator<Item = &'m String> {
        self.sequence.iter().filter_map(|at| model.jumps.get(*at)).map(|jump| &jump.place.name)
    }

    /// The names of the surfaces that are crossed without a jump.
    fn crosses<'m>(&self, model: &'m Model) -> impl Iterator<Item = &'m String> {
        let against = self.sequence.iter().filter_map(|at| at.checked_sub(model.jumps.len()));
        against.map(|at| &model.surfaces[model.jumps[at].surface].place.name)
    }

    /// `no jump`, or `bounce, bounce`, or `crossing of rim, bounce`.
    fn words(&self, model: &Model) -> String {
        let all = [model.jumps.clone(), crossings(model)].concat();
        let names: Vec<&str> =
            self.sequence.iter().map(|at| all[*at].place.name.as_str()).collect();
        if names.is_empty() { "no jump".into() } else { names.join(", ") }
    }

    fn tried(&self, model: &Model, found: &Found, is_answer: bool) -> Tried {
        let Ended { status, objective, iterations } = Ended::of(&found.problem, &found.outcome);
        let (jumps, crosses) =
            (self.jumps(model).cloned().collect(), self.crosses(model).cloned().collect());
        Tried { jumps, crosses, status, objective, iterations, words: self.words(model), is_answer }
    }

    /// The answer as one trajectory.
    fn joined(self, model: &Model, between: &Problem, found: Found) -> Found {
        let (outcome, jumps) = joined(between, &found.problem, &found.outcome);
        let names = self.sequence.iter().map(|at| Some(model.jumps.get(*at)?.place.name.clone()));
        let happened =
            names.zip(jumps).filter_map(|(name, jump)| Some(happened(between, name?, jump)));
        let problem = between.clone();
        let unrolled =
            Unrolled { model: self.model, problem: found.problem, outcome: found.outcome };
        Found { problem, outcome, jumps: happened.collect(), unrolled: Some(unrolled), ..found }
    }
}

fn happened(between: &Problem, jump: String, found: Jump) -> Happened {
    let Jump { time, before, after } = found;
    let named = |values: Vec<f64>| -> Named<f64> {
        between.states.iter().map(|state| state.name.clone()).zip(values).collect()
    };
    Happened { jump, time, before: named(before), after: named(after) }
}
