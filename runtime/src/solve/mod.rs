//! Solving a problem: choose the solver, and lead it to the grid and to the smoothing widths of the
//! model by easier ones.
//!
//! [`continuation`] goes over coarse grids ([`grid_sequencing`]) and large smoothing widths to
//! those that the model names; [`smoothing_widths`] finds widths where it names none; [`run`] is
//! what both do again and again: one solve. [`refinement`] finds the grid, [`multistart`] and
//! [`warm_start`] begin elsewhere than at the guess of the model.

mod continuation;
mod grid_sequencing;
pub mod multistart;
mod prolong;
pub mod refinement;
mod run;
mod smoothing_widths;
mod tuning;
pub mod warm_start;

use crate::nlp::{Nlp, Progress, Solution, Start, Status, Stop, convex};
use crate::problem::{Origin, Problem, Solver};
use crate::solution::modes::modes;
pub use crate::solution::{Attempt, Limiting, Outcome};
use crate::solution::{Trajectory, gain_of_pauses};
use crate::transcribe::TranscribedNlp;
use run::Run;
use std::ops::ControlFlow;

/// Why a problem is not handed to the solver that was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// `solver = convex`, and the transcribed problem is not.
    NotConvex,
}

/// Where a solve is on its way.
#[derive(Clone, Copy, Debug)]
pub struct Level<'a> {
    /// Intervals of the grid.
    pub intervals: usize,
    /// Stages of the scheme, where their number is found on the way.
    pub stages: Option<usize>,
    /// The smoothing width of each surface.
    pub sigma: &'a [f64],
}

/// What is reported while solving.
pub type Watch<'a> = dyn FnMut(&Progress, Level) -> ControlFlow<Stop> + 'a;

/// Solves a problem with its own method, from its own guess or from `start`.
pub fn solve(
    problem: &Problem,
    start: Option<Start>,
    watch: &mut Watch,
) -> Result<Outcome, Refusal> {
    let mut nlp = TranscribedNlp::new(problem);
    let mut run = Run::new(problem);
    run.apply_sigma(&mut nlp);
    let start = start.unwrap_or_else(|| Start { v: nlp.guess(), warm: None });
    let is_open = matches!(problem.method.solver, Solver::Automatic | Solver::Convex);
    let is_convex = convex::is_quadratic_program(problem) && convex::is_proved(&mut nlp);
    if !is_convex && problem.method.solver == Solver::Convex {
        return Err(Refusal::NotConvex);
    }
    let options = run.options(run.target());
    let mut conic =
        if is_open && is_convex { run.conic(&mut nlp, &start, &options, watch) } else { None };
    let is_stopped = |it: &Solution| matches!(it.status, Status::TimeLimit | Status::Interrupted);
    if let Some(stopped) = conic.take_if(|it| is_stopped(it)) {
        return Ok(finish(run, &mut nlp, stopped, true));
    }
    // Where it finds no optimum the interior point method has a word, a best iterate, and a row to
    // blame.
    if let Some(solution) = conic.as_ref().filter(|it| it.status == Status::Solved) {
        return Ok(finish(run, &mut nlp, solution.clone(), true));
    }
    let mut solution = match widths(problem) {
        Some(widths) => run.with_named_widths(&mut nlp, start.clone(), &widths, watch),
        None => run.with_chosen_widths(&mut nlp, start.clone(), watch),
    };
    // Of a convex program every local optimum is a global one.
    solution.global = is_open && is_convex && solution.status == Status::Solved;
    let is_lost = matches!(solution.status, Status::Infeasible | Status::NumericalFailure);
    let proof = if is_lost && is_convex {
        conic.or_else(|| run.conic(&mut nlp, &start, &options, watch))
    } else {
        None
    };
    let is_impossible = proof.is_some_and(|it| it.status == Status::Infeasible);
    if is_impossible {
        solution.status = Status::Infeasible;
    }
    let mut outcome = finish(run, &mut nlp, solution, false);
    outcome.is_impossible = is_impossible;
    Ok(outcome)
}

/// Solves a problem from a start that is near its solution, with the widths that another solve has
/// ended with.
pub(crate) fn solve_near(
    problem: &Problem,
    start: Start,
    before: &Outcome,
    watch: &mut Watch,
) -> Result<Outcome, Refusal> {
    if before.convex {
        return solve(problem, Some(start), watch);
    }
    let mut nlp = TranscribedNlp::new(problem);
    let (counts, sigma) = (before.solution.counts, before.sigma.clone());
    let mut run = Run { problem, counts, sigma, attempts: Vec::new() };
    let target = run.target();
    let solution = run.solve(&mut nlp, &start, target, watch);
    Ok(finish(run, &mut nlp, solution, false))
}

/// The widths the model names, in their order; `None` where the choice is ours.
fn widths(problem: &Problem) -> Option<Vec<f64>> {
    let method = &problem.method;
    let widths: Vec<f64> = method.continuation.iter().copied().chain(method.sigma).collect();
    let is_ours = widths.is_empty() && !problem.surfaces.is_empty();
    (!is_ours).then_some(widths)
}

fn finish(run: Run, nlp: &mut TranscribedNlp, solution: Solution, convex: bool) -> Outcome {
    let Run { problem, sigma, attempts, .. } = run;
    let mut trajectory = Trajectory::new(problem, nlp, &solution);
    trajectory.hamiltonian.pause = gain_of_pauses(problem, &trajectory);
    let surfaces = trajectory.switching.iter().zip(&sigma);
    let modes = surfaces.map(|(psi, sigma)| modes(&trajectory.time, psi, *sigma)).collect();
    let limiting = limiting(nlp, &solution, &trajectory, problem.method.tol);
    let is_impossible = convex && solution.status == Status::Infeasible;
    Outcome { solution, trajectory, sigma, modes, convex, limiting, is_impossible, attempts }
}

fn limiting(
    nlp: &mut TranscribedNlp,
    solution: &Solution,
    trajectory: &Trajectory,
    tol: f64,
) -> Option<Limiting> {
    let (row, violation) = crate::nlp::worst_constraint(nlp, &solution.v)?;
    if solution.status.is_solved() || violation <= tol {
        return None;
    }
    let place = nlp.constraint_place(row);
    let time = place.grid_point.map(|k| trajectory.time[k]);
    let condition = if nlp.is_defect(row) { strongest_condition(nlp, solution) } else { None };
    Some(Limiting { origin: place.origin, condition, time, violation })
}

/// The path or boundary condition with the largest multiplier.
fn strongest_condition(nlp: &TranscribedNlp, solution: &Solution) -> Option<Origin> {
    let rows = solution.multipliers.constraints.iter().enumerate();
    let conditions = rows.filter(|(row, lambda)| !nlp.is_defect(*row) && **lambda != 0.0);
    let strongest = conditions.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    Some(nlp.constraint_place(strongest.0).origin)
}
