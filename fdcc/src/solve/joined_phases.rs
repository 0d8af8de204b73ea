//! An answer in which the phases of a model are divided at their jumps, with each of them as one
//! trajectory.

use super::alternatives::{Alternative, finest};
use super::found::{Divided, FoundChain, Phases, Pieces};
use super::true_optimum::{Slice, slices};
use fdcc_compiler::Model;
use fdcc_runtime::nlp::{Place, Status};
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::solution::phases;
use fdcc_runtime::solve::{ChainOutcome, Limiting, Outcome};

/// `between` are the phases of the chain that holds between jumps, each with the unknowns of all.
pub(super) fn joined(
    (chain_between, between, written): (&Chain, &[Problem], &Model),
    of: Alternative,
    found: FoundChain,
) -> FoundChain {
    let FoundChain { chain, outcome, step_errors, starts, .. } = found;
    let counts = of.events.iter().map(|it| it.len() + 1);
    let slices = slices((&of.model, written.links.len()), &chain, counts);
    let (mut problems, mut outcomes, mut pieces) = (Vec::new(), Vec::new(), Vec::new());
    for ((slice, between), events) in slices.iter().zip(between).zip(of.events) {
        let phases = pieces_of(slice, &of.model, (&chain, &outcome));
        let (whole, happened) = phases::joined(between, &phases.chain, &phases.outcome);
        problems.push(Problem { method: finest(&phases.chain).clone(), ..between.clone() });
        outcomes.push(whole);
        pieces.push(Pieces { events, happened, phases });
    }
    for (problem, own) in problems.iter_mut().zip(&chain_between.phases) {
        problem.unknowns.clone_from(&own.unknowns);
    }
    let all = told(&outcome, outcomes, &slices);
    let whole = Phases { model: of.model, chain, outcome };
    let (sequences, next) = (Vec::new(), Vec::new());
    FoundChain {
        chain: Chain { phases: problems, ..chain_between.clone() },
        outcome: all,
        step_errors,
        starts,
        others: Vec::new(),
        divided: Some(Box::new(Divided {
            written: written.clone(),
            whole,
            pieces,
            sequences,
            is_cut: false,
            next,
        })),
    }
}

/// What was solved of one phase of the model.
fn pieces_of(slice: &Slice, model: &Model, all: (&Chain, &ChainOutcome)) -> Phases {
    let (chain, outcome) = all;
    let own = model.phases[slice.phases.clone()].to_vec();
    // Each piece has the same widths.
    let sigma = outcome.phases[slice.phases.start].sigma.clone();
    Phases {
        model: Model { phases: own, links: Vec::new(), ..model.clone() },
        chain: slice.chain(chain),
        outcome: ChainOutcome { sigma, ..slice.outcome(chain, outcome) },
    }
}

/// What is said of all phases together, whose numbers are those of the model.
fn told(outcome: &ChainOutcome, phases: Vec<Outcome>, slices: &[Slice]) -> ChainOutcome {
    let written = |piece: usize| slices.iter().take_while(|it| it.phases.end <= piece).count();
    let mut solution = outcome.solution.clone();
    if let Status::NotFinite(place) = &solution.status {
        let phase = written(place.phase);
        solution.status = Status::NotFinite(Place { grid_point: None, phase, ..place.clone() });
    }
    let limiting = outcome.limiting.clone().map(|it| Limiting { phase: written(it.phase), ..it });
    let sigma = phases.iter().flat_map(|it| it.sigma.iter().copied()).collect();
    ChainOutcome {
        solution,
        phases,
        sigma,
        limiting,
        attempts: outcome.attempts.clone(),
        ..*outcome
    }
}
