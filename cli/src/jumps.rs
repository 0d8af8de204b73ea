//! A model with jumps: each sequence of jumps that may happen is a problem of its own, and the best answer is taken.

use crate::output::named::Named;
use crate::output::saved::Saved;
use crate::output::tried::{Ended, Happened, Tried};
use crate::parallel;
use crate::search::{Found, Search, is_stopped};
use crate::solver::Failure;
use crate::warm;
use fdcc_compiler::{Model, compile, compile_simulation, sequences, unrolled};
use fdcc_runtime::homotopy::Outcome;
use fdcc_runtime::nlp::Start;
use fdcc_runtime::pieces::{Jump, joined};
use fdcc_runtime::problem::{ControlShape, Problem};
use fdcc_runtime::simulate::{Controls, Kind, Options, Status, simulate};
use fdcc_runtime::starts;

/// What was solved in place of a model with jumps: its pieces side by side.
pub struct Unrolled {
    pub model: Model,
    pub problem: Problem,
    pub outcome: Outcome,
}

/// A sequence of jumps, as indices into those of the model, and the problem in which it happens.
struct Alternative {
    sequence: Vec<usize>,
    model: Model,
    problem: Problem,
}

/// Solves for every sequence; `between` is what holds between the jumps. An earlier solution is the start of the sequence that it has.
pub fn solve(
    model: &Model,
    between: &Problem,
    earlier: Option<&Saved>,
    search: Search,
) -> Result<Found, Failure> {
    refuse(between)?;
    let mut possible = sequences(model).map_err(Failure::Model)?;
    if let Some(likely) = simulated(model) {
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
        let log = &mut search.log.of_part(&words(&all[index].names(model)));
        Search { log, ..search }.solve(&all[index].problem, all[index].start(model, between, earlier))
    };
    // Without an objective one trajectory is as good as another.
    let is_enough = |found: &Found| is_stopped(&found.outcome) || !between.has_objective && found.is_good();
    let ends = |found: &Result<Found, Failure>| found.as_ref().map_or(true, is_enough);
    // Several starts run in parallel already.
    let threads = if search.starts == 1 { parallel::processors() } else { 1 };
    let found = parallel::in_order(all.len(), threads, one, ends);
    let found: Vec<Found> = found.into_iter().collect::<Result<_, Failure>>()?;
    for (alternative, found) in all.iter().zip(&found) {
        search.log.ended(&words(&alternative.names(model)), &Ended::of(&found.problem, &found.outcome));
    }
    let tried = all.iter().zip(&found).map(|(it, found)| Tried::new(it.names(model), found)).collect();
    let solutions = found.iter().map(|it| &it.outcome.solution).enumerate();
    let best = solutions.reduce(|a, b| if starts::is_better(b.1, a.1) { b } else { a });
    let best = best.expect("that no jump happens is one of them").0;
    let (alternatives, found) = (all.into_iter().nth(best), found.into_iter().nth(best));
    let (alternative, found) = alternatives.zip(found).expect("it is one of them");
    Ok(alternative.joined(model, between, Found { tried, is_cut, ..found }))
}

/// A guess is not worth more steps of a simulation.
const STEPS: usize = 20_000;
/// More are not looked for where the guess leads to that many.
const LONGEST: usize = 12;

/// The jumps on the true system with everything as it is guessed.
fn simulated(model: &Model) -> Option<Vec<usize>> {
    let system = compile_simulation(model).ok()?;
    let simulation = simulate(&system, &Controls::Guess, &Options { max_steps: STEPS, ..Options::default() });
    let jumps = simulation.events.iter().filter_map(|event| match event.kind {
        Kind::Jump(at) => Some(at),
        _ => None,
    });
    let jumps: Vec<usize> = jumps.collect();
    let is_whole = matches!(simulation.status, Status::Completed);
    (is_whole && jumps.len() <= LONGEST).then_some(jumps)
}

/// What only a model without jumps can do.
fn refuse(between: &Problem) -> Result<(), Failure> {
    match between.method.controls {
        ControlShape::Constant => Ok(()),
        ControlShape::Linear | ControlShape::Polynomial => {
            Err(Failure::Usage("`controls = linear` and `polynomial` are for models without jumps".into()))
        }
    }
}

impl Alternative {
    fn new(model: &Model, sequence: Vec<usize>) -> Result<Self, Failure> {
        let model = unrolled(model, &sequence).map_err(Failure::Model)?;
        let problem = compile(&model).map_err(Failure::Model)?;
        Ok(Alternative { sequence, model, problem })
    }

    fn start(&self, model: &Model, between: &Problem, earlier: Option<&Saved>) -> Option<Start> {
        let is_its = |it: &&Saved| self.names(model).iter().eq(it.jumps.iter().map(|jump| &jump.jump));
        earlier.filter(is_its).and_then(|it| warm::pieces::start(it, between, &self.problem))
    }

    fn names(&self, model: &Model) -> Vec<String> {
        self.sequence.iter().map(|at| model.jumps[*at].place.name.clone()).collect()
    }

    /// The answer as one trajectory.
    fn joined(self, model: &Model, between: &Problem, found: Found) -> Found {
        let (outcome, jumps) = joined(between, &found.problem, &found.outcome);
        let names = self.names(model);
        let happened = names.into_iter().zip(jumps).map(|(name, jump)| happened(between, name, jump));
        let problem = between.clone();
        let unrolled = Unrolled { model: self.model, problem: found.problem, outcome: found.outcome };
        Found { problem, outcome, jumps: happened.collect(), unrolled: Some(unrolled), ..found }
    }
}

/// `no jump`, or `bounce, bounce`.
pub fn words(jumps: &[String]) -> String {
    if jumps.is_empty() { "no jump".into() } else { jumps.join(", ") }
}

fn happened(between: &Problem, jump: String, found: Jump) -> Happened {
    let Jump { time, before, after } = found;
    let named = |values: Vec<f64>| -> Named<f64> {
        between.states.iter().map(|state| state.name.clone()).zip(values).collect()
    };
    Happened { jump, time, before: named(before), after: named(after) }
}

impl Tried {
    fn new(jumps: Vec<String>, found: &Found) -> Self {
        let Ended { status, objective, iterations } = Ended::of(&found.problem, &found.outcome);
        Tried { jumps, status, objective, iterations }
    }
}
