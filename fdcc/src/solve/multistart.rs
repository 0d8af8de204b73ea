//! Looking for an answer from one starting point or from several, and keeping the best.

use super::families::is_same;
use super::found::FoundChain;
use super::report::{Ended, Options, Part, Report};
use crate::error::Error;
use fdcc_runtime::nlp::{self, Solution, Status};
use fdcc_runtime::problem::Chain;
use fdcc_runtime::solve::multistart::{elsewhere, is_better, perturbed};
use fdcc_runtime::solve::refinement::{self, Refined};
use fdcc_runtime::solve::{Attempt, ChainOutcome, Refusal};
use std::cmp::Ordering;

/// A solved problem is solved so often once more where other controls are better.
const MOST_ELSEWHERE: usize = 3;

/// The best answer from all starting points; `part` is what it is a part of.
pub(super) fn solve(
    chain: &Chain,
    start: Option<nlp::Start>,
    options: &Options,
    part: Part,
) -> Result<FoundChain, Error> {
    let all = match options.starts {
        0 | 1 => vec![run(chain, start, options, part)?],
        _ => many(chain, start, options, part)?,
    };
    let starts: Vec<Ended> = match all.len() {
        1 => Vec::new(),
        _ => all.iter().map(|it| Ended::of(&it.chain, &it.outcome)).collect(),
    };
    for (index, ended) in starts.iter().enumerate() {
        (options.report)(&Report::Ended(Part { start: Some(index), ..part }, ended));
    }
    let outcomes = all.iter().map(|it| &it.outcome);
    let (attempts, stopped) = (all_attempts(outcomes.clone()), first_stopped(outcomes));
    let mut all = distinct(all).into_iter();
    let Refined { chain, outcome, error } = all.next().expect("there is at least one start");
    let mut outcome = ChainOutcome { attempts, ..outcome };
    unless_stopped(&mut outcome.solution, stopped);
    let others = all.map(|it| (it.chain, it.outcome)).collect();
    Ok(FoundChain { chain, outcome, step_errors: error, starts, others, divided: None })
}

/// The better one of an answer and of what is found from another start.
pub(super) fn also_from(
    found: FoundChain,
    start: nlp::Start,
    options: &Options,
    part: Part,
) -> Result<FoundChain, Error> {
    let FoundChain { chain, outcome, step_errors, starts, others, .. } = found;
    let first = Refined { chain, outcome, error: step_errors };
    let other = run(&first.chain, Some(start), options, part)?;
    let Refined { chain, outcome, error } = better(first, other);
    Ok(FoundChain { chain, outcome, step_errors: error, starts, others, divided: None })
}

/// The best answer, then others that are solved, of those with the same objective one.
fn distinct(mut all: Vec<Refined>) -> Vec<Refined> {
    all.sort_by(|a, b| match (&a.outcome.solution, &b.outcome.solution) {
        (a, b) if is_better(a, b) => Ordering::Less,
        (a, b) if is_better(b, a) => Ordering::Greater,
        _ => Ordering::Equal,
    });
    let mut kept: Vec<Refined> = Vec::new();
    for it in all {
        let own = &it.outcome.solution;
        let is_known = |other: &Refined| is_same(other.outcome.solution.objective, own.objective);
        if kept.is_empty() || own.status.is_solved() && !kept.iter().any(is_known) {
            kept.push(it);
        }
    }
    kept
}

/// From the start as it is given and from variations of it, in parallel.
fn many(
    chain: &Chain,
    start: Option<nlp::Start>,
    options: &Options,
    part: Part,
) -> Result<Vec<Refined>, Error> {
    let one = |index: usize| {
        let start = match index {
            0 => start.clone(),
            _ => {
                let base = start.clone().map(|start| start.v);
                Some(perturbed(chain, base, index as u32))
            }
        };
        run(chain, start, options, Part { start: Some(index), ..part })
    };
    let is_over = |it: &Refined| is_stopped(&it.outcome.solution);
    let ends = |found: &Result<Refined, Error>| found.as_ref().map_or(true, is_over);
    let all = options.executor.in_order(options.starts, one, ends);
    let all: Vec<Refined> = all.into_iter().collect::<Result<_, Error>>()?;
    let stopped = all.iter().filter(|it| is_over(it)).count();
    if stopped > 0 {
        let (ended, starts) = (all.len() - stopped, options.starts);
        (options.report)(&Report::Stopped { ended, stopped, starts });
    }
    Ok(all)
}

/// Whether a solve was stopped from outside.
pub(super) fn is_stopped(solution: &Solution) -> bool {
    matches!(solution.status, Status::Interrupted | Status::TimeLimit)
}

/// The solves of several outcomes.
pub(super) fn all_attempts<'o>(outcomes: impl Iterator<Item = &'o ChainOutcome>) -> Vec<Attempt> {
    outcomes.flat_map(|outcome| outcome.attempts.clone()).collect()
}

/// How several outcomes were stopped, if one was.
pub(super) fn first_stopped<'o>(
    mut outcomes: impl Iterator<Item = &'o ChainOutcome>,
) -> Option<Status> {
    let stopped = outcomes.find(|outcome| is_stopped(&outcome.solution))?;
    Some(stopped.solution.status.clone())
}

/// Whoever stops a search is not told that there is nothing.
pub(super) fn unless_stopped(solution: &mut Solution, stopped: Option<Status>) {
    if let (Some(stopped), Status::Infeasible) = (stopped, &solution.status) {
        solution.status = stopped;
    }
}

/// One solve, and more near controls that make its Hamiltonian less.
fn run(
    chain: &Chain,
    start: Option<nlp::Start>,
    options: &Options,
    part: Part,
) -> Result<Refined, Error> {
    let mut best = once(chain, start, options, part)?;
    for _ in 0..MOST_ELSEWHERE {
        let before = best.outcome.solution.objective;
        for start in better_starts(&best) {
            let other = once(&best.chain, Some(start), options, part)?;
            best = better(best, other);
        }
        if best.outcome.solution.objective >= before {
            break;
        }
    }
    Ok(best)
}

/// Where a problem that is solved, or stays at a saddle, may have a better optimum; not on a grid
/// that was made for this one.
fn better_starts(found: &Refined) -> Vec<nlp::Start> {
    let solution = &found.outcome.solution;
    match (solution.status.is_solved() || solution.is_saddle) && found.error.is_none() {
        true => elsewhere(&found.chain, &found.outcome),
        false => Vec::new(),
    }
}

/// The better one, with the work of both.
fn better(a: Refined, b: Refined) -> Refined {
    let attempts = all_attempts([&a.outcome, &b.outcome].into_iter());
    let counts = [&a, &b].map(|it| it.outcome.solution.counts.iterations);
    let is_better = is_better(&b.outcome.solution, &a.outcome.solution);
    let mut best = if is_better { b } else { a };
    best.outcome.attempts = attempts;
    best.outcome.solution.counts.iterations = counts.iter().sum();
    best
}

fn once(
    chain: &Chain,
    start: Option<nlp::Start>,
    options: &Options,
    part: Part,
) -> Result<Refined, Error> {
    let found = refinement::solve(chain, start, &mut |progress, level| {
        (options.report)(&Report::Iteration(part, progress, level));
        (options.stop)()
    });
    found.map_err(|Refusal::NotConvex| {
        Error::Call(
            "the discretised problem is not convex, so `solver = convex` cannot treat it; leave \
             `solver` out"
                .into(),
        )
    })
}
