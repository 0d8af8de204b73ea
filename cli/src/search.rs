//! Looking for an answer: from one starting point or from several, and keeping the best.

use crate::jumps::Unrolled;
use crate::log::Log;
use crate::output::{
    self,
    tried::{Ended, Happened, Tried},
};
use crate::solver::Failure;
use crate::watch::Deadline;
use fdcc::parallel;
use fdcc_runtime::nlp::{Start, Status};
use fdcc_runtime::problem::Problem;
use fdcc_runtime::solve::multistart;
use fdcc_runtime::solve::refinement::{self, Refined};
use fdcc_runtime::solve::{Attempt, Outcome, Refusal};

/// The best answer of all that were looked for.
pub struct Found {
    pub problem: Problem,
    pub outcome: Outcome,
    /// The sum of the errors of all steps, where the grid was refined.
    pub error: Option<f64>,
    /// How each of several starts ended.
    pub spread: Vec<Ended>,
    /// The jumps of this answer.
    pub jumps: Vec<Happened>,
    /// How each sequence of jumps ended.
    pub tried: Vec<Tried>,
    /// Whether more jumps may happen than were tried.
    pub is_cut: bool,
    pub unrolled: Option<Unrolled>,
}

impl Found {
    /// Whether it can be used.
    pub fn is_good(&self) -> bool {
        self.outcome.solution.status.is_solved()
    }
}

/// How an answer is looked for.
pub struct Search<'l> {
    /// From how many starting points.
    pub starts: usize,
    pub deadline: Deadline,
    pub log: &'l mut Log,
}

impl Search<'_> {
    /// The best answer from all starting points.
    pub fn solve(self, problem: &Problem, start: Option<Start>) -> Result<Found, Failure> {
        let all = match self.starts {
            1 => vec![run(problem, start, self.deadline, self.log)?],
            _ => self.many(problem, start)?,
        };
        let spread: Vec<Ended> = match all.len() {
            1 => Vec::new(),
            _ => all.iter().map(|it| Ended::of(&it.problem, &it.outcome)).collect(),
        };
        spread
            .iter()
            .enumerate()
            .for_each(|(index, ended)| self.log.ended(&of_start(index), ended));
        let best = |a: Refined, b: Refined| {
            if multistart::is_better(&b.outcome.solution, &a.outcome.solution) { b } else { a }
        };
        let outcomes = all.iter().map(|it| &it.outcome);
        let (attempts, stopped) = (all_attempts(outcomes.clone()), first_stopped(outcomes));
        let Refined { problem, outcome, error } =
            all.into_iter().reduce(best).expect("there is at least one start");
        let mut outcome = Outcome { attempts, ..outcome };
        unless_stopped(&mut outcome, stopped);
        Ok(Found {
            problem,
            outcome,
            error,
            spread,
            jumps: Vec::new(),
            tried: Vec::new(),
            is_cut: false,
            unrolled: None,
        })
    }

    /// From the start as it is given and from variations of it, in parallel.
    fn many(&self, problem: &Problem, start: Option<Start>) -> Result<Vec<Refined>, Failure> {
        let one = |index: usize| {
            let start = match index {
                0 => start.clone(),
                _ => Some(multistart::perturbed(
                    problem,
                    start.clone().map(|start| start.v),
                    index as u32,
                )),
            };
            run(problem, start, self.deadline, &mut self.log.of_part(&of_start(index)))
        };
        let ends = |found: &Result<Refined, Failure>| {
            found.as_ref().map_or(true, |it| is_stopped(&it.outcome))
        };
        let all = parallel::in_order(self.starts, parallel::processors(), one, ends);
        let all: Vec<Refined> = all.into_iter().collect::<Result<_, Failure>>()?;
        tell_missing(&all, self.starts);
        Ok(all)
    }
}

/// Says how many starts did not come to their end.
fn tell_missing(all: &[Refined], starts: usize) {
    let stopped = all.iter().filter(|it| is_stopped(&it.outcome)).count();
    if stopped > 0 {
        let (ended, never) = (all.len() - stopped, starts - all.len());
        output::complain(&format!(
            "{ended} of {starts} starts came to their end, {stopped} stopped on the way, {never} \
             never ran"
        ));
    }
}

fn of_start(index: usize) -> String {
    format!("start {index:3}")
}

/// Whether a solve was stopped from outside.
pub fn is_stopped(outcome: &Outcome) -> bool {
    matches!(outcome.solution.status, Status::Interrupted | Status::TimeLimit)
}

/// The solves of several outcomes.
pub fn all_attempts<'o>(outcomes: impl Iterator<Item = &'o Outcome>) -> Vec<Attempt> {
    outcomes.flat_map(|outcome| outcome.attempts.clone()).collect()
}

/// How several outcomes were stopped, if one was.
pub fn first_stopped<'o>(mut outcomes: impl Iterator<Item = &'o Outcome>) -> Option<Status> {
    outcomes.find(|outcome| is_stopped(outcome)).map(|outcome| outcome.solution.status.clone())
}

/// Whoever stops a search is not told that there is nothing.
pub fn unless_stopped(outcome: &mut Outcome, stopped: Option<Status>) {
    if let (Some(stopped), Status::Infeasible) = (stopped, &outcome.solution.status) {
        outcome.solution.status = stopped;
    }
}

fn run(
    problem: &Problem,
    start: Option<Start>,
    deadline: Deadline,
    log: &mut Log,
) -> Result<Refined, Failure> {
    let found = refinement::solve(problem, start, &mut |progress, level| {
        log.iteration(progress, level);
        deadline.check()
    });
    found.map_err(|Refusal::NotConvex| {
        Failure::Usage(
            "the discretised problem is not convex, so `solver = convex` cannot treat it; leave \
             `solver` out"
                .into(),
        )
    })
}
