//! Solving a problem: choose the solver, and lead it to the grid and to the smoothing widths of the
//! model by easier ones.
//!
//! [`continuation`] goes over coarse grids ([`grid_sequencing`]) and large smoothing widths to
//! those that the model names; [`smoothing_widths`] finds widths where it names none; [`run`] is
//! what both do again and again: one solve. [`refinement`] finds the grid, [`multistart`] and
//! [`warm_start`] begin elsewhere than at the guess of the model.

mod by_parameters;
mod continuation;
mod covariance;
mod grid_sequencing;
pub mod multistart;
mod other_multipliers;
mod parametric;
mod prolong;
pub mod refinement;
mod run;
mod smoothing_widths;
mod tuning;
pub mod warm_start;

use crate::nlp::{Nlp, Progress, Solution, Start, Status, Stop, convex};
use crate::problem::{Chain, Origin, Problem, Solver};
use crate::solution::modes::modes;
pub use crate::solution::{Attempt, ChainOutcome, Limiting, Outcome};
use crate::solution::{Trajectory, gain_of_pauses};
use crate::transcribe::chain::{ChainNlp, own_multipliers};
pub use by_parameters::by_parameters_of_chain;
pub use covariance::covariance_of_chain;
pub use other_multipliers::with_other_multipliers;
pub use parametric::{Movement, movement_of_chain};
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

/// Solves a problem of one phase with its own method, from its own guess or from `start`.
pub fn solve(
    problem: &Problem,
    start: Option<Start>,
    watch: &mut Watch,
) -> Result<Outcome, Refusal> {
    Ok(solve_chain(&Chain::single(problem.clone()), start, watch)?.into_single())
}

/// Solves a chain of phases with the method of the first and the grids and schemes of all, from its
/// own guess or from `start`.
pub fn solve_chain(
    chain: &Chain,
    start: Option<Start>,
    watch: &mut Watch,
) -> Result<ChainOutcome, Refusal> {
    let mut nlp = ChainNlp::new(chain);
    let mut run = Run::new(chain);
    run.apply_sigma(&mut nlp);
    let mut start = start.unwrap_or_else(|| Start { v: nlp.guess(), warm: None });
    warm_start::make_room(&mut nlp, chain, &mut start);
    run.apply_sigma(&mut nlp);
    let solver = chain.method().solver;
    let is_open = matches!(solver, Solver::Automatic | Solver::Convex);
    let is_convex = convex::is_quadratic_program(chain) && convex::is_proved(&mut nlp);
    if !is_convex && solver == Solver::Convex {
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
    let mut solution = match widths(chain) {
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
    let is_impossible = is_proof(chain) && proof.is_some_and(|it| it.status == Status::Infeasible);
    if is_impossible {
        solution.status = Status::Infeasible;
    }
    let mut outcome = finish(run, &mut nlp, solution, false);
    outcome.is_impossible = is_impossible;
    Ok(outcome)
}

/// Solves a chain from a start that is near its solution, with the widths that another solve has
/// ended with.
pub(crate) fn solve_near(
    chain: &Chain,
    start: Start,
    before: &ChainOutcome,
    watch: &mut Watch,
) -> Result<ChainOutcome, Refusal> {
    if before.convex {
        return solve_chain(chain, Some(start), watch);
    }
    let mut nlp = ChainNlp::new(chain);
    let (counts, sigma) = (before.solution.counts, before.sigma.clone());
    let mut run = Run { chain, counts, sigma, attempts: Vec::new() };
    let target = run.target();
    let solution = run.solve(&mut nlp, &start, target, watch);
    Ok(finish(run, &mut nlp, solution, false))
}

/// The widths the model names, in their order; `None` where the choice is ours.
fn widths(chain: &Chain) -> Option<Vec<f64>> {
    let method = chain.method();
    let widths: Vec<f64> = method.continuation.iter().copied().chain(method.sigma).collect();
    let is_ours = widths.is_empty() && chain.surfaces().next().is_some();
    (!is_ours).then_some(widths)
}

/// Whether what is proved of the smoothed problem is proved of the one that is meant.
fn is_proof(chain: &Chain) -> bool {
    chain.surfaces().next().is_none() || widths(chain).is_some()
}

fn finish(run: Run, nlp: &mut ChainNlp, solution: Solution, convex: bool) -> ChainOutcome {
    let Run { chain, sigma, attempts, .. } = run;
    let slopes = nlp.slopes_of_links(&solution);
    let mut widths = sigma.iter().copied();
    let phases = chain.phases.iter().enumerate().map(|(at, problem)| {
        let own = widths.by_ref().take(problem.surfaces.len()).collect();
        phase(problem, nlp, at, own, (&solution, &slopes))
    });
    let phases: Vec<Outcome> = phases.collect();
    let limiting = limiting(nlp, &solution, &phases, chain.method().tol);
    let is_impossible = convex && is_proof(chain) && solution.status == Status::Infeasible;
    ChainOutcome { solution, phases, sigma, convex, limiting, is_impossible, attempts }
}

/// The part of a phase in the solution of a chain.
fn phase(
    problem: &Problem,
    nlp: &mut ChainNlp,
    at: usize,
    sigma: Vec<f64>,
    (whole, slopes): (&Solution, &[f64]),
) -> Outcome {
    let shape = nlp.shape().phases[at].clone();
    let solution = Solution {
        v: shape.own(&whole.v),
        multipliers: own_multipliers(&shape, &whole.multipliers),
        ..whole.without_vectors()
    };
    let own = nlp.phase_at(at, &whole.v);
    let mut trajectory = Trajectory::new(problem, own, &solution);
    trajectory.add_costates_of_links(problem, &shape.own(slopes), shape.stages);
    trajectory.hamiltonian.pause = gain_of_pauses(problem, &trajectory);
    let surfaces = trajectory.switching.iter().zip(&sigma);
    let modes = surfaces.map(|(psi, sigma)| modes(&trajectory.time, psi, *sigma)).collect();
    Outcome {
        solution,
        trajectory,
        sigma,
        modes,
        convex: false,
        limiting: None,
        is_impossible: false,
        attempts: Vec::new(),
    }
}

fn limiting(
    nlp: &mut ChainNlp,
    solution: &Solution,
    phases: &[Outcome],
    tol: f64,
) -> Option<Limiting> {
    if solution.status.is_solved() {
        return None;
    }
    let violations = crate::nlp::violations(nlp, &solution.v);
    let worst = largest(&violations, |_| true).filter(|worst| violations[*worst] > tol)?;
    // A condition may be missed by as little as each step, and all steps together by far more.
    let step = largest(&violations, |row| nlp.is_defect(row));
    let place_of = |row| nlp.constraint_place(row);
    let in_all = |row: usize| -> f64 {
        let own = place_of(row);
        let is_same = |other: &usize| {
            let place = place_of(*other);
            (place.phase, place.origin.span) == (own.phase, own.origin.span)
        };
        let violated = (0..violations.len()).filter(|it| violations[*it] > 0.0);
        violated.filter(is_same).map(|it| violations[it]).sum()
    };
    let is_spread = |step: &usize| in_all(*step) > violations[worst] && !nlp.is_defect(worst);
    let (row, condition) = match step.filter(is_spread) {
        Some(step) => (step, Some(place_of(worst).origin)),
        None if nlp.is_defect(worst) => (worst, strongest_condition(nlp, solution)),
        None => (worst, None),
    };
    let place = place_of(row);
    let time = place.grid_point.map(|k| phases[place.phase].trajectory.time[k]);
    let (phase, violation, in_all) = (place.phase, violations[row], in_all(row));
    Some(Limiting { origin: place.origin, condition, phase, time, violation, in_all })
}

/// The row of the largest violation among some.
fn largest(violations: &[f64], is_asked: impl Fn(usize) -> bool) -> Option<usize> {
    let rows = (0..violations.len()).filter(|row| is_asked(*row));
    // The first of equals.
    rows.rev().max_by(|a, b| violations[*a].total_cmp(&violations[*b]))
}

/// The path or boundary condition with the largest multiplier.
fn strongest_condition(nlp: &ChainNlp, solution: &Solution) -> Option<Origin> {
    let rows = solution.multipliers.constraints.iter().enumerate();
    let conditions = rows.filter(|(row, lambda)| !nlp.is_defect(*row) && **lambda != 0.0);
    let strongest = conditions.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    Some(nlp.constraint_place(strongest.0).origin)
}
