//! `N = auto`: solve, estimate the error of each step, refine the grid where it is large, and solve
//! again from there.
//!
//! The error of a step is the difference between its end and that of an accurate integration of the
//! same smoothed system from the same state with the same control ([`error_estimate`]). What is
//! refined is [`plan`]'s to say: intervals are divided, or, where the model leaves the order open,
//! all get more stages, which is taken back where it does not pay.

mod controls;
mod error_estimate;
mod mesh_transfer;
mod plan;

use super::run::is_lost;
use super::{Outcome, Refusal, Watch, solve as solve_on_grid, solve_near};
use crate::nlp::{Start, Status};
use crate::problem::{self, FIRST_GRID, MOST_STAGES, Order, Problem};
use crate::solve::tuning::refinement::{MOST, MOST_ITERATIONS, MOST_ROUNDS, PATIENCE};
use crate::transcribe::TranscribedNlp;
use error_estimate::step_errors;
use mesh_transfer::transferred;
use plan::Errors;

/// The finest grid on which a first solution is looked for.
const FINEST_FIRST: usize = 8 * FIRST_GRID;

/// A solution and the grid that it was found on.
pub struct Refined {
    /// The problem on its last grid.
    pub problem: Problem,
    /// Its solution.
    pub outcome: Outcome,
    /// The sum of the errors of all steps, if they were asked for.
    pub error: Option<f64>,
}

/// Solves a problem, on a grid of our own choice where it asks for that.
pub fn solve(
    problem: &Problem,
    start: Option<Start>,
    watch: &mut Watch,
) -> Result<Refined, Refusal> {
    if problem.method.grid != problem::Grid::Auto {
        let outcome = solve_on_grid(problem, start, watch)?;
        return Ok(Refined { problem: problem.clone(), outcome, error: None });
    }
    // First grid and its solution.
    let (problem, outcome) = first(problem, start, watch)?;
    if !is_good(&outcome) {
        return Ok(Refined { problem, outcome, error: None });
    }
    // Errors of the steps; shorter intervals or more stages; the solution there from this one.
    let mut grid = Grid::new(problem, outcome);
    for _ in 0..MOST_ROUNDS {
        let Some(next) = grid.refined(watch)? else { break };
        grid = next;
    }
    let error = Some(grid.errors.sum());
    Ok(Refined { problem: grid.problem, outcome: grid.outcome, error })
}

/// The first grid that can be solved, with its solution. Few intervals may be too few for a
/// solution; then there are as many as where the order is given, and where nothing is found on
/// these, either, they are halved again and again: a coarse grid says nothing of the problem.
fn first(
    problem: &Problem,
    start: Option<Start>,
    watch: &mut Watch,
) -> Result<(Problem, Outcome), Refusal> {
    let is_few = problem.method.intervals() < FIRST_GRID;
    let trial = if is_few { on_trial(problem) } else { problem.clone() };
    let mut found = (problem.clone(), solve_on_grid(&trial, start.clone(), watch)?);
    if is_few && !is_good(&found.1) && !is_stopped(&found.1) {
        found = finer(problem, &start, found, FIRST_GRID, watch)?;
    }
    while is_lost(&found.1.solution.status) && found.0.method.intervals() < FINEST_FIRST {
        let intervals = 2 * found.0.method.intervals();
        found = finer(problem, &start, found, intervals, watch)?;
    }
    Ok(found)
}

/// The same from the same start on more intervals, a multiple of those of the problem; `before` is
/// what was tried.
fn finer(
    problem: &Problem,
    start: &Option<Start>,
    (_, before): (Problem, Outcome),
    intervals: usize,
    watch: &mut Watch,
) -> Result<(Problem, Outcome), Refusal> {
    let parts = vec![intervals / problem.method.intervals(); problem.method.intervals()];
    let finer = divided(problem, &parts);
    let (from, to) = (TranscribedNlp::new(problem), TranscribedNlp::new(&finer));
    let start = start.as_ref().map(|start| transferred(&from, start, &to, &parts));
    let mut outcome = solve_on_grid(&finer, start, watch)?;
    outcome.solution.counts.add(&before.solution.counts);
    outcome.attempts = [before.attempts, outcome.attempts].concat();
    Ok((finer, outcome))
}

/// The same, to be given up soon: what takes long here is better done in another way.
fn on_trial(problem: &Problem) -> Problem {
    let mut problem = problem.clone();
    problem.method.max_iter = problem.method.max_iter.min(MOST_ITERATIONS);
    problem
}

fn is_good(outcome: &Outcome) -> bool {
    outcome.solution.status.is_solved()
}

fn is_stopped(outcome: &Outcome) -> bool {
    matches!(outcome.solution.status, Status::TimeLimit | Status::Interrupted)
}

/// A grid that is solved.
struct Grid {
    problem: Problem,
    outcome: Outcome,
    errors: Errors,
}

impl Grid {
    /// Nothing is known yet of what more stages would gain.
    fn new(problem: Problem, outcome: Outcome) -> Self {
        let steps = step_errors(&problem, &outcome);
        let gains = vec![0.0; steps.len()];
        let errors = Errors { scheme: problem.method.scheme, steps, gains };
        Grid { problem, outcome, errors }
    }

    /// The next grid; nothing if this one is good enough, or there is no better one.
    fn refined(&mut self, watch: &mut Watch) -> Result<Option<Grid>, Refusal> {
        let is_raised = self.problem.method.order == Order::Auto;
        let next = if is_raised { self.with_short_intervals(watch)? } else { None };
        if next.is_some() || self.is_enough() {
            return Ok(next);
        }
        let next = if is_raised { self.raised(watch)? } else { None };
        if next.is_some() {
            return Ok(next);
        }
        let parts = self.errors.parts(self.problem.method.tolerance);
        self.divided(&parts, watch)
    }

    /// Shorter intervals where controls ask for them.
    fn with_short_intervals(&mut self, watch: &mut Watch) -> Result<Option<Grid>, Refusal> {
        let parts = controls::parts(&self.problem, &self.outcome);
        if parts.iter().all(|parts| *parts == 1) { Ok(None) } else { self.divided(&parts, watch) }
    }

    fn is_enough(&self) -> bool {
        self.errors.sum() <= self.problem.method.tolerance
    }

    /// When it is divided.
    fn nodes(&self) -> usize {
        self.errors.nodes(self.problem.method.tolerance)
    }

    /// The best of the same intervals with more stages; nothing if fewer nodes are foreseen without
    /// them.
    fn raised(&mut self, watch: &mut Watch) -> Result<Option<Grid>, Refusal> {
        let now = self.problem.method.scheme.stages();
        let first = self.errors.best_stages(self.problem.method.tolerance);
        let mut tried: Vec<Grid> = Vec::new();
        for stages in (first..=MOST_STAGES).filter(|_| first > now) {
            let Some(next) = tried.last_mut().unwrap_or(self).with_stages(stages, watch)? else {
                break;
            };
            let (nodes, is_enough) = (next.nodes() as f64, next.is_enough());
            tried.push(next);
            // What a raise has shown is news for the grids before it, too.
            let least = tried.iter().map(Grid::nodes).fold(self.nodes(), usize::min) as f64;
            if is_enough || nodes > PATIENCE * least {
                break;
            }
        }
        let counts = tried.last().unwrap_or(self).outcome.solution.counts;
        self.outcome.solution.counts = counts;
        let best = tried.into_iter().min_by_key(|grid| (grid.nodes(), !grid.is_enough()));
        let mut best = best.filter(|best| best.nodes() <= self.nodes());
        best.iter_mut().for_each(|best| best.outcome.solution.counts = counts);
        Ok(best)
    }

    /// The same intervals with so many stages, and what they gain; nothing if they cannot be
    /// solved.
    fn with_stages(&mut self, stages: usize, watch: &mut Watch) -> Result<Option<Grid>, Refusal> {
        let mut problem = self.problem.clone();
        let intervals = problem.method.intervals();
        problem.method.scheme = problem.method.scheme.with_stages(stages);
        let outcome = self.again(&on_trial(&problem), &vec![1; intervals], watch)?;
        self.outcome.solution.counts = outcome.solution.counts;
        // What is solved is not given away for what is nearly solved.
        if !is_good(&outcome)
            || outcome.solution.status != Status::Solved
                && self.outcome.solution.status == Status::Solved
        {
            self.errors.gains = vec![1.0; intervals];
            return Ok(None);
        }
        let mut next = Grid::new(problem, outcome);
        next.errors.gains = self.errors.gains_to(&next.errors);
        self.errors.gains.clone_from(&next.errors.gains);
        Ok(Some(next))
    }

    /// More intervals; nothing if they are too many, or cannot be solved: that is no reason to lose
    /// the answer on these.
    fn divided(&mut self, parts: &[usize], watch: &mut Watch) -> Result<Option<Grid>, Refusal> {
        if parts.iter().sum::<usize>() > MOST {
            return Ok(None);
        }
        let problem = divided(&self.problem, parts);
        let outcome = self.again(&problem, parts, watch)?;
        if !is_good(&outcome) {
            return Ok(None);
        }
        let mut next = Grid::new(problem, outcome);
        next.errors.gains = self.errors.gains_of_parts(parts);
        Ok(Some(next))
    }

    /// The solution on another grid, from that on this one and with its widths.
    fn again(
        &self,
        problem: &Problem,
        parts: &[usize],
        watch: &mut Watch,
    ) -> Result<Outcome, Refusal> {
        let (from, to) = (TranscribedNlp::new(&self.problem), TranscribedNlp::new(problem));
        let start = transferred(&from, &Start::near(&self.outcome.solution), &to, parts);
        solve_near(problem, start, &self.outcome, watch)
    }
}

fn divided(problem: &Problem, parts: &[usize]) -> Problem {
    let mut finer = problem.clone();
    let times = problem.method.grid.times();
    let uniform = |k: usize| k as f64 / parts.len() as f64;
    let point = |k: usize| times.get(k).copied().unwrap_or_else(|| uniform(k));
    let mut mesh = Vec::new();
    for (k, parts) in parts.iter().enumerate() {
        let length = (point(k + 1) - point(k)) / *parts as f64;
        mesh.extend((0..*parts).map(|part| point(k) + part as f64 * length));
    }
    mesh.push(1.0);
    finer.method.grid = problem::Grid::Mesh(mesh);
    finer
}
