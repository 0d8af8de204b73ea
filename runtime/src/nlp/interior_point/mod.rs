//! A primal-dual interior point method with a filter line search, in Ipopt's vocabulary.
//!
//! After A. Waechter and L. T. Biegler, "On the implementation of an interior-point filter
//! line-search algorithm for large-scale nonlinear programming", Mathematical Programming 106
//! (2006) 25-57. The loop is in [`algorithm`]; each noun of it has a file.

mod acceptance;
mod algorithm;
mod barrier;
mod error_scaling;
mod filter;
mod formulation;
mod inertia;
mod initialisation;
mod iterate;
mod kinks;
mod kkt;
mod line_search;
mod residuals;
mod restoration;
mod saddle;
mod search_direction;
mod termination;
mod tuning;
mod vectors;
mod watchdog;

use super::conclusion::{Ended, conclude};
use super::scaling::Scaled;
use super::scaling::factors::ScalingFactors;
use super::{
    Multipliers, Nlp, Options, Progress, Solution, Start, Status, Watch, constraint_violation,
};
use crate::linalg::solvers::{cheapest, more_robust};
use crate::problem::Linear;
use algorithm::Algorithm;
use tuning::fallback::{FAR, MORE_WORK, MOST_FLAT_POINTS, MOST_RESCALINGS};

/// Solves the NLP from `start`. Progress is reported unscaled, once per iteration. Nobody is
/// told "infeasible" for want of luck: where an attempt ends without a solution others are made,
/// each along another path, with the iterations that are left.
pub fn solve(nlp: &mut dyn Nlp, start: &Start, options: &Options, watch: &mut Watch) -> Solution {
    let is_automatic = options.linear == Linear::Automatic;
    let mut options = *options;
    if is_automatic {
        let (hessian, jacobian) = (nlp.hessian_structure(), nlp.jacobian_structure());
        options.linear = cheapest(nlp.stages(), &nlp.phases(), hessian, jacobian);
    }
    let mut best = attempt(nlp, start, &options, watch);
    if options.is_final {
        best = rescaled_by_the_answer(best, nlp, start, &options, watch);
        let was_solved = best.status.is_solved();
        best = away_from_flat_points(best, nlp, &options, watch);
        if was_solved && !best.status.is_solved() {
            return best;
        }
    }
    // Solver fallback: other rounding and regularisation.
    if is_automatic
        && let Some(next) = more_robust(options.linear)
        && is_lost(&best)
    {
        options.linear = next;
        best = fallback(best, nlp, &options, from(start, Algorithm::run), watch);
    }
    // Phase-I restart: where the objective led away from all that is feasible.
    if start.warm.is_none() && is_lost(&best) {
        best = fallback(best, nlp, &options, from(start, Algorithm::run_with_phase_one), watch);
    }
    if start.warm.is_none() && is_lost(&best) {
        best = in_other_sizes(best, nlp, start, &options, watch);
    }
    best
}

/// In the sizes that conditions and equations ask for, where these are others.
fn in_other_sizes(
    best: Solution,
    nlp: &mut dyn Nlp,
    start: &Start,
    options: &Options,
    watch: &mut Watch,
) -> Solution {
    let used = ScalingFactors::new(nlp, &start.v);
    let factors = ScalingFactors::of_equations(nlp, &start.v);
    if factors.distance(&used) <= FAR {
        return best;
    }
    let run = |nlp: &mut dyn Nlp, options: &Options, watch: &mut Watch| {
        attempt_scaled(nlp, factors, start, options, Algorithm::run, watch)
    };
    fallback(best, nlp, options, run, watch)
}

/// Guess and bounds may say little of how large an answer is. Where a solve ends without one that
/// can be called so, others begin at its end, scaled by what was found.
fn rescaled_by_the_answer(
    mut best: Solution,
    nlp: &mut dyn Nlp,
    start: &Start,
    options: &Options,
    watch: &mut Watch,
) -> Solution {
    let is_open =
        |it: &Solution| matches!(it.status, Status::Acceptable | Status::NumericalFailure);
    if !is_open(&best) {
        return best;
    }
    let mut used = ScalingFactors::new(nlp, &start.v);
    for _ in 0..MOST_RESCALINGS {
        let factors = ScalingFactors::of_answer(nlp, &best.v);
        if !is_open(&best) || factors.distance(&used) <= FAR {
            break;
        }
        used = factors.clone();
        let start = Start { v: best.v.clone(), warm: None };
        let run = |nlp: &mut dyn Nlp, options: &Options, watch: &mut Watch| {
            attempt_scaled(nlp, factors, &start, options, Algorithm::run, watch)
        };
        best = fallback(best, nlp, options, run, watch);
    }
    best
}

/// Where curvature or derivatives of higher order say that an answer is no minimum, others begin
/// beside it; the lowest objective is the answer, or that there is none.
fn away_from_flat_points(
    mut best: Solution,
    nlp: &mut dyn Nlp,
    options: &Options,
    watch: &mut Watch,
) -> Solution {
    for _ in 0..MOST_FLAT_POINTS {
        let Some(v) = best.descent.take().filter(|_| best.status.is_solved()) else {
            break;
        };
        // After a slow end not many times the work: it may be as slow beside it.
        let max_iter = match best.status {
            Status::Acceptable => options.max_iter.min(MORE_WORK * best.counts.iterations),
            _ => options.max_iter,
        };
        let next = fallback(
            best.clone(),
            nlp,
            &Options { max_iter, ..*options },
            from(&Start { v: v.clone(), warm: None }, Algorithm::run),
            watch,
        );
        let is_solved = next.status == Status::Solved || next.status == Status::Unbounded;
        let is_lower = is_solved && next.objective < best.objective;
        best.counts = next.counts;
        if is_lower {
            best = next;
        } else if is_feasible_and_lower(nlp, &v, &best, options.tol) {
            return no_minimum(best, options);
        }
    }
    best
}

/// Whether a point meets all conditions and has a lower objective than an answer.
fn is_feasible_and_lower(nlp: &mut dyn Nlp, v: &[f64], answer: &Solution, tol: f64) -> bool {
    let mut rows = vec![0.0; nlp.constraint_bounds().len()];
    let is_lower = nlp.values(v, &mut rows) < answer.objective;
    is_lower && constraint_violation(nlp, v) <= tol
}

/// What lies beside a better point, where nothing was found from that.
fn no_minimum(answer: Solution, options: &Options) -> Solution {
    let status = match answer.counts.iterations >= options.max_iter {
        true => Status::IterationLimit,
        false => Status::NumericalFailure,
    };
    Solution { status, is_saddle: true, ..answer }
}

/// Whether another attempt may end otherwise.
fn is_lost(solution: &Solution) -> bool {
    matches!(solution.status, Status::Infeasible | Status::NumericalFailure)
}

/// Makes another attempt, and answers with the one that says more.
fn fallback(
    first: Solution,
    nlp: &mut dyn Nlp,
    options: &Options,
    attempt: impl FnOnce(&mut dyn Nlp, &Options, &mut Watch) -> Solution,
    watch: &mut Watch,
) -> Solution {
    let mut counts = first.counts;
    if counts.iterations >= options.max_iter {
        return first;
    }
    let options =
        Options { max_iter: options.max_iter.saturating_sub(counts.iterations), ..*options };
    let second = attempt(nlp, &options, &mut |progress| {
        watch(&Progress { iteration: counts.iterations + progress.iteration, ..*progress })
    });
    counts.add(&second.counts);
    let is_taken = match second.status {
        Status::Solved => true,
        Status::Acceptable => first.status != Status::Acceptable,
        // The end of one attempt is where the next begins.
        Status::NumericalFailure => first.status == Status::NumericalFailure,
        // A verdict says more than a failure.
        Status::Infeasible => first.status == Status::NumericalFailure,
        // It falls without end at points that meet all conditions: there is no optimum.
        Status::Unbounded => true,
        _ => false,
    };
    // Whoever stops the search is not told that there is nothing.
    let is_stopped = matches!(second.status, Status::TimeLimit | Status::Interrupted);
    let status = if is_taken || is_stopped { second.status.clone() } else { first.status.clone() };
    let best = if is_taken { second } else { first };
    Solution { status, counts, ..best }
}

/// One attempt, without fallbacks.
pub(super) fn attempt(
    nlp: &mut dyn Nlp,
    start: &Start,
    options: &Options,
    watch: &mut Watch,
) -> Solution {
    from(start, Algorithm::run)(nlp, options, watch)
}

/// An attempt from `start`, scaled by what is known there.
fn from(
    start: &Start,
    run: impl FnOnce(&mut Algorithm, &mut dyn Nlp, &mut Watch) -> Status,
) -> impl FnOnce(&mut dyn Nlp, &Options, &mut Watch) -> Solution {
    move |nlp, options, watch| {
        let factors = ScalingFactors::new(nlp, &start.v);
        attempt_scaled(nlp, factors, start, options, run, watch)
    }
}

fn attempt_scaled(
    nlp: &mut dyn Nlp,
    factors: ScalingFactors,
    start: &Start,
    options: &Options,
    run: impl FnOnce(&mut Algorithm, &mut dyn Nlp, &mut Watch) -> Status,
    watch: &mut Watch,
) -> Solution {
    let mut scaled = Scaled::with(nlp, factors);
    let objective_scale = scaled.objective();
    let start = scaled.start(start);
    let mut watch = |progress: &Progress| {
        watch(&Progress { objective: progress.objective / objective_scale, ..*progress })
    };
    let mut algorithm = initialisation::prepare(&mut scaled, &start, *options);
    let status = run(&mut algorithm, &mut scaled, &mut watch);
    let mu = algorithm.barrier.mu;
    let Algorithm { at, counts, residuals, formulation, is_saddle, mut descent, .. } = algorithm;
    let (decrement, assessed) = (algorithm.decrement, algorithm.assessed);
    let assessed = assessed.filter(|_| scaled.is_as_written());
    descent.iter_mut().for_each(|v| scaled.unscale_point(v));
    let decrement = decrement / objective_scale;
    let mut multipliers = Multipliers {
        constraints: at.lambda,
        lower: at.lower[..formulation.variables].to_vec(),
        upper: at.upper[..formulation.variables].to_vec(),
    };
    let mut v = at.y[..formulation.variables].to_vec();
    scaled.unscale(&mut v, &mut multipliers);
    let kkt_error = residuals.error(0.0);
    conclude(
        nlp,
        Ended {
            status,
            v,
            multipliers,
            mu,
            kkt_error,
            is_saddle,
            descent,
            assessed,
            decrement,
            counts,
        },
        options,
    )
}
