//! Solving a problem: choose the solver, and drive the smoothing widths down where the model leaves them open.
//!
//! A width that the model names is approached: from twice that width first; where this takes too long, from half the size of the switching function on,
//! halved from solve to solve; where that fails, too, at once and with all patience. Solves on the way are rough. Where the model names none, each surface gets a fraction of the size
//! its switching function has along the trajectory found so far, one solve after another, each started from the one before. Where
//! a step is too long it is halved; where even short steps fail, the last width that could be solved is the answer.

use crate::modes::{Span, modes};
use crate::nlp::{Counts, Nlp, Options, Progress, Solution, Start, Status, Stop, convex, interior_point};
use crate::problem::{Origin, Problem, Solver};
use crate::trajectory::Trajectory;
use crate::transcribe::TranscribedNlp;
use std::ops::ControlFlow;

/// Smoothing widths relative to the size of the switching function, where the model names none.
const FIRST_FACTOR: f64 = 0.1;
const LAST_FACTOR: f64 = 0.01;
/// From one width to the next; after a failure the square root of it, and so on.
const DECREASE: f64 = 0.3;
const MOST_FAILURES: usize = 3;
/// A step that takes longer than this is too long.
const MOST_ITERATIONS: usize = 300;
/// A width that is named is approached from twice this width, with at most so many iterations for each of the two; else by halving
/// from half the size of the switching function on.
const ABOVE: f64 = 2.0;
const QUICK: usize = 150;
const WIDE: f64 = 0.5;
const MOST_HALVINGS: i32 = 12;
/// The next solve begins at a barrier parameter of this size; more is not asked of a solve on the way.
const ROUGH: f64 = 1e-4;

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
    pub origin: Origin,
    /// Where it is a step of a differential equation: the condition that stands against the equations most.
    pub condition: Option<Origin>,
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
    let start = start.unwrap_or_else(|| Start { v: nlp.guess(), warm: None });
    if problem.method.solver != Solver::InteriorPoint && convex::is_quadratic_programme(problem) {
        let method = &problem.method;
        let solution = convex::solve(&mut nlp, &start, method.tol, method.max_iter);
        // Where there is no optimum the interior point method has a best iterate, and a row to blame.
        let has_word = |it: &Solution| it.status == Status::Solved || method.solver == Solver::Convex;
        if let Some(solution) = solution.filter(has_word) {
            return Ok(run.finish(&mut nlp, solution, true));
        }
    }
    if problem.method.solver == Solver::Convex {
        return Err(Refusal::NotConvex);
    }
    let solution = match (run.widths(), problem.method.sigma) {
        (Some(widths), Some(sigma)) if widths.len() == 1 && run.may_approach(&start) => {
            run.approach(&mut nlp, start, sigma, watch)
        }
        (Some(widths), _) => run.given(&mut nlp, start, &widths, watch),
        (None, _) => run.chosen(&mut nlp, start, watch),
    };
    Ok(run.finish(&mut nlp, solution, false))
}

/// Whether another start may help: it was neither solved nor stopped.
fn is_retried(status: &Status) -> bool {
    !is_good(status) && !matches!(status, Status::TimeLimit | Status::Interrupted)
}

fn warm(solution: &Solution) -> Start {
    Start { v: solution.v.clone(), warm: Some(solution.multipliers.clone()) }
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
    /// The widths the model names, in their order; `None` where the choice is ours.
    fn widths(&self) -> Option<Vec<f64>> {
        let method = &self.problem.method;
        let widths: Vec<f64> = method.continuation.iter().copied().chain(method.sigma).collect();
        let is_ours = widths.is_empty() && !self.problem.surfaces.is_empty();
        (!is_ours).then_some(widths)
    }

    /// Whether there are surfaces, and nothing better to start from than a guess.
    fn may_approach(&self, start: &Start) -> bool {
        !self.problem.surfaces.is_empty() && start.warm.is_none()
    }

    /// Solves with the one width that the model names.
    fn approach(
        &mut self,
        nlp: &mut TranscribedNlp,
        start: Start,
        sigma: f64,
        watch: &mut Watch,
    ) -> Solution {
        let most = self.problem.method.max_iter;
        let quick = self.pass(nlp, start.clone(), &[ABOVE * sigma, sigma], QUICK.min(most), watch);
        if !is_retried(&quick.status) || most <= QUICK {
            return quick;
        }
        let halvings = self.halvings(nlp, [&start.v, &quick.v], sigma);
        let widths: Vec<f64> = (0..=halvings).rev().map(|k| sigma * 2.0_f64.powi(k)).collect();
        let slow = self.pass(nlp, start.clone(), &widths, MOST_ITERATIONS.min(most), watch);
        if !is_retried(&slow.status) {
            return slow;
        }
        self.sigma.fill(sigma);
        self.solve_once(nlp, &start, most, watch)
    }

    /// How often half the size of a switching function can be halved until it is a width.
    fn halvings(&self, nlp: &TranscribedNlp, known: [&Vec<f64>; 2], sigma: f64) -> i32 {
        let sizes = known.into_iter().flat_map(|v| nlp.guard_sizes(v));
        let size = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
        let most = f64::from(MOST_HALVINGS);
        (WIDE * size / sigma).log2().ceil().clamp(1.0, most) as i32
    }

    /// Solves with one given width after the other.
    fn given(
        &mut self,
        nlp: &mut TranscribedNlp,
        start: Start,
        widths: &[f64],
        watch: &mut Watch,
    ) -> Solution {
        self.pass(nlp, start, widths, self.problem.method.max_iter, watch)
    }

    /// The same with a limit on the iterations of each solve.
    fn pass(
        &mut self,
        nlp: &mut TranscribedNlp,
        mut start: Start,
        widths: &[f64],
        limit: usize,
        watch: &mut Watch,
    ) -> Solution {
        let Some((last, before)) = widths.split_last() else {
            return self.solve_once(nlp, &start, limit, watch);
        };
        for width in before {
            self.sigma.fill(*width);
            let solution = self.roughly(nlp, &start, limit, watch);
            if !is_good(&solution.status) {
                return solution;
            }
            start = warm(&solution);
        }
        self.sigma.fill(*last);
        self.solve_once(nlp, &start, limit, watch)
    }

    /// Solves with widths of our own choice, as small as can be solved.
    fn chosen(&mut self, nlp: &mut TranscribedNlp, start: Start, watch: &mut Watch) -> Solution {
        let mut factor = FIRST_FACTOR;
        self.set_relative(nlp, &start.v);
        let mut best = self.solve_once(nlp, &start, self.problem.method.max_iter, watch);
        let (mut decrease, mut failures) = (DECREASE, 0);
        while is_good(&best.status) && factor > LAST_FACTOR && failures < MOST_FAILURES {
            let before = self.sigma.clone();
            let next = (factor * decrease).max(LAST_FACTOR);
            self.decrease(nlp, &best.v, next, next / factor);
            let limit = self.problem.method.max_iter.min(MOST_ITERATIONS);
            let solution = self.interior_point(nlp, &warm(&best), limit, self.problem.method.tol, watch);
            if is_good(&solution.status) {
                (factor, best) = (next, solution);
                continue;
            }
            self.sigma = before;
            (failures, decrease) = (failures + 1, decrease.sqrt());
            if matches!(solution.status, Status::TimeLimit | Status::Interrupted) {
                best.status = solution.status;
            }
        }
        self.apply_sigma(nlp);
        best.counts = self.counts;
        best
    }

    /// Widths relative to the size of each switching function along `v`.
    fn set_relative(&mut self, nlp: &TranscribedNlp, v: &[f64]) {
        for (sigma, size) in self.sigma.iter_mut().zip(nlp.guard_sizes(v)) {
            *sigma = FIRST_FACTOR * if size > 0.0 { size } else { 1.0 };
        }
    }

    /// Smaller widths, by the factor `decrease`; but not below `factor` times the size of the switching function. On a
    /// held surface that size is the layer itself, and says nothing.
    fn decrease(&mut self, nlp: &TranscribedNlp, v: &[f64], factor: f64, decrease: f64) {
        for (sigma, size) in self.sigma.iter_mut().zip(nlp.guard_sizes(v)) {
            *sigma = (factor * size).clamp(decrease * *sigma, *sigma);
        }
    }

    fn apply_sigma(&self, nlp: &mut TranscribedNlp) {
        for (surface, sigma) in self.problem.surfaces.iter().zip(&self.sigma) {
            nlp.set_parameter(surface.sigma, *sigma);
        }
    }

    /// One solve to the tolerance of the model.
    fn solve_once(
        &mut self,
        nlp: &mut TranscribedNlp,
        start: &Start,
        limit: usize,
        watch: &mut Watch,
    ) -> Solution {
        self.warmly(nlp, start, limit, self.problem.method.tol, watch)
    }

    /// One solve on the way.
    fn roughly(
        &mut self,
        nlp: &mut TranscribedNlp,
        start: &Start,
        limit: usize,
        watch: &mut Watch,
    ) -> Solution {
        self.warmly(nlp, start, limit, self.problem.method.tol.max(ROUGH), watch)
    }

    /// One solve; a warm start that fails is repeated with fresh multipliers.
    fn warmly(
        &mut self,
        nlp: &mut TranscribedNlp,
        start: &Start,
        limit: usize,
        tol: f64,
        watch: &mut Watch,
    ) -> Solution {
        let solution = self.interior_point(nlp, start, limit, tol, watch);
        if start.warm.is_none() || !is_retried(&solution.status) {
            return solution;
        }
        self.interior_point(nlp, &Start { v: start.v.clone(), warm: None }, limit, tol, watch)
    }

    fn interior_point(
        &mut self,
        nlp: &mut TranscribedNlp,
        start: &Start,
        max_iter: usize,
        tol: f64,
        watch: &mut Watch,
    ) -> Solution {
        self.apply_sigma(nlp);
        let options = Options { tol, max_iter, linear: self.problem.method.linear };
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

fn limiting(
    nlp: &mut TranscribedNlp,
    solution: &Solution,
    trajectory: &Trajectory,
    tol: f64,
) -> Option<Limiting> {
    let (row, violation) = crate::nlp::worst_row(nlp, &solution.v)?;
    if is_good(&solution.status) || violation <= tol {
        return None;
    }
    let place = nlp.row_place(row);
    let time = place.grid_point.map(|k| trajectory.time[k]);
    let condition = if nlp.is_defect(row) { strongest_condition(nlp, solution) } else { None };
    Some(Limiting { origin: place.origin, condition, time, violation })
}

/// The path or boundary condition with the largest multiplier.
fn strongest_condition(nlp: &TranscribedNlp, solution: &Solution) -> Option<Origin> {
    let rows = solution.multipliers.rows.iter().enumerate();
    let conditions = rows.filter(|(row, lambda)| !nlp.is_defect(*row) && **lambda != 0.0);
    let strongest = conditions.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    Some(nlp.row_place(strongest.0).origin)
}
