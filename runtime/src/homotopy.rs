//! Solving a problem: choose the solver, and drive the smoothing widths down where the model leaves them open.
//!
//! Widths the model names are used as they are. Otherwise each surface gets `FACTORS` times the size its switching
//! function has along the trajectory found so far, one solve after another, each started from the one before.

use crate::modes::{Span, modes};
use crate::nlp::{Counts, Nlp, Options, Progress, Solution, Start, Status, Stop, convex, interior_point};
use crate::problem::{Problem, Solver};
use crate::trajectory::Trajectory;
use crate::transcribe::TranscribedNlp;
use std::ops::ControlFlow;

/// Smoothing widths relative to the size of the switching function, where the model names none.
const FACTORS: [f64; 3] = [0.1, 0.03, 0.01];

/// A solved (or not solved) problem.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The last solution; its counts are those of all solves together.
    pub solution: Solution,
    /// The same in the words of the model.
    pub trajectory: Trajectory,
    /// The smoothing width of each surface at the end.
    pub sigma: Vec<f64>,
    /// The modes of each surface.
    pub modes: Vec<Vec<Span>>,
    /// Whether the conic solver was used.
    pub convex: bool,
    /// The worst row, by name and time, if the point is not feasible.
    pub limiting: Option<Limiting>,
}

/// The constraint that is violated most.
#[derive(Clone, Debug, PartialEq)]
pub struct Limiting {
    /// Where it stands in the model.
    pub origin: crate::problem::Origin,
    /// The time of its largest violation, if it belongs to one.
    pub time: Option<f64>,
    /// How far it is violated.
    pub violation: f64,
}

/// Why a problem is not handed to the solver that was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// `solver = convex`, and the transcribed problem is not.
    NotConvex,
}

/// What is reported while solving: the iteration, and the width of the layer.
pub type Watch<'a> = dyn FnMut(&Progress, &[f64]) -> ControlFlow<Stop> + 'a;

/// Solves a problem with its own method, from its own guess or from `start`.
pub fn solve(problem: &Problem, start: Option<Start>, watch: &mut Watch) -> Result<Outcome, Refusal> {
    let mut nlp = TranscribedNlp::new(problem);
    let mut run = Run { problem, counts: Counts::default(), sigma: initial_sigma(problem) };
    run.apply_sigma(&mut nlp);
    let mut start = start.unwrap_or_else(|| Start { v: nlp.guess(), warm: None });
    if problem.method.solver != Solver::InteriorPoint && convex::is_quadratic_programme(problem) {
        let method = &problem.method;
        if let Some(solution) = convex::solve(&mut nlp, &start, method.tol, method.max_iter) {
            return Ok(run.finish(&mut nlp, solution, true));
        }
    }
    if problem.method.solver == Solver::Convex {
        return Err(Refusal::NotConvex);
    }
    let widths = run.widths();
    let mut solution = None;
    for width in widths {
        run.set_width(&mut nlp, width, &start.v);
        let next = run.solve_once(&mut nlp, &start, watch);
        let go_on = is_good(&next.status);
        start = Start { v: next.v.clone(), warm: Some(next.multipliers.clone()) };
        solution = Some(next);
        if !go_on {
            break;
        }
    }
    let solution = solution.expect("there is at least one width");
    Ok(run.finish(&mut nlp, solution, false))
}

/// A width to solve with.
#[derive(Clone, Copy)]
enum Width {
    /// As the problem has it.
    Given,
    /// The same for all surfaces.
    Absolute(f64),
    /// Relative to the size of each switching function.
    Relative(f64),
}

struct Run<'p> {
    problem: &'p Problem,
    counts: Counts,
    sigma: Vec<f64>,
}

fn initial_sigma(problem: &Problem) -> Vec<f64> {
    problem.surfaces.iter().map(|surface| problem.parameters[surface.sigma].value).collect()
}

fn is_good(status: &Status) -> bool {
    matches!(status, Status::Solved | Status::Acceptable)
}

impl Run<'_> {
    fn widths(&self) -> Vec<Width> {
        let method = &self.problem.method;
        let mut widths: Vec<Width> = method.continuation.iter().map(|width| Width::Absolute(*width)).collect();
        match method.sigma {
            Some(sigma) => widths.push(Width::Absolute(sigma)),
            None if !widths.is_empty() => {}
            None if self.problem.surfaces.is_empty() => widths.push(Width::Given),
            None => widths.extend(FACTORS.map(Width::Relative)),
        }
        widths
    }

    fn set_width(&mut self, nlp: &mut TranscribedNlp, width: Width, v: &[f64]) {
        match width {
            Width::Given => {}
            Width::Absolute(sigma) => self.sigma.fill(sigma),
            Width::Relative(factor) => {
                for (sigma, size) in self.sigma.iter_mut().zip(nlp.guard_sizes(v)) {
                    *sigma = factor * if size > 0.0 { size } else { 1.0 };
                }
            }
        }
        self.apply_sigma(nlp);
    }

    fn apply_sigma(&self, nlp: &mut TranscribedNlp) {
        for (surface, sigma) in self.problem.surfaces.iter().zip(&self.sigma) {
            nlp.set_parameter(surface.sigma, *sigma);
        }
    }

    /// One solve; a warm start that fails is repeated with fresh multipliers.
    fn solve_once(&mut self, nlp: &mut TranscribedNlp, start: &Start, watch: &mut Watch) -> Solution {
        let solution = self.interior_point(nlp, start, watch);
        let stopped = matches!(solution.status, Status::TimeLimit | Status::Interrupted);
        if is_good(&solution.status) || start.warm.is_none() || stopped {
            return solution;
        }
        self.interior_point(nlp, &Start { v: start.v.clone(), warm: None }, watch)
    }

    fn interior_point(&mut self, nlp: &mut TranscribedNlp, start: &Start, watch: &mut Watch) -> Solution {
        let method = &self.problem.method;
        let options = Options { tol: method.tol, max_iter: method.max_iter, linear: method.linear };
        let sigma = &self.sigma;
        let before = self.counts.iterations;
        let mut solution = interior_point::solve(nlp, start, &options, &mut |progress| {
            watch(&Progress { iteration: before + progress.iteration, ..*progress }, sigma)
        });
        self.counts.add(&solution.counts);
        solution.counts = self.counts;
        solution
    }

    fn finish(self, nlp: &mut TranscribedNlp, solution: Solution, convex: bool) -> Outcome {
        let trajectory = Trajectory::new(self.problem, nlp, &solution);
        let surfaces = trajectory.guards.iter().zip(&self.sigma);
        let modes = surfaces.map(|(guard, sigma)| modes(&trajectory.time, guard, *sigma)).collect();
        let limiting = limiting(nlp, &solution, &trajectory, self.problem.method.tol);
        Outcome { solution, trajectory, sigma: self.sigma, modes, convex, limiting }
    }
}

fn limiting(nlp: &mut TranscribedNlp, solution: &Solution, trajectory: &Trajectory, tol: f64) -> Option<Limiting> {
    let (row, violation) = crate::nlp::worst_row(nlp, &solution.v)?;
    if is_good(&solution.status) || violation <= tol {
        return None;
    }
    let place = nlp.row_place(row);
    let time = place.grid_point.map(|k| trajectory.time[k]);
    Some(Limiting { origin: place.origin, time, violation })
}
