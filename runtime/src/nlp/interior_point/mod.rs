//! A primal-dual interior point method with a filter line search, in Ipopt's vocabulary.
//!
//! After A. Waechter and L. T. Biegler, "On the implementation of an interior-point filter line-search algorithm for
//! large-scale nonlinear programming", Mathematical Programming 106 (2006) 25-57. The loop is in
//! [`algorithm`]; each noun of it has a file.

mod algorithm;
mod barrier;
mod iterate;
mod kkt;
mod residuals;
mod restoration;
mod search;
mod space;
mod start;
mod vectors;
mod watchdog;

use super::scaling::Scaled;
use super::{Multipliers, Nlp, Options, Progress, Solution, Start, Status, Watch};
use crate::linalg::is_sparse_cheaper;
use crate::problem::Linear;
use algorithm::Algorithm;

/// Solves the programme from `start`. Progress is reported unscaled, once per iteration. Nobody is told "infeasible" for want of luck: where an attempt ends
/// without a solution others are made, each along another path, with the iterations that are left.
pub fn solve(nlp: &mut dyn Nlp, start: &Start, options: &Options, watch: &mut Watch) -> Solution {
    let is_automatic = options.linear == Linear::Automatic;
    let mut options = Options { linear: factorization(nlp, options.linear), ..*options };
    let mut best = attempt(nlp, start, &options, watch);
    // Other rounding and regularisation.
    if is_automatic && options.linear == Linear::Riccati && is_lost(&best) {
        options.linear = Linear::SparseLdl;
        best = another(best, nlp, start, &options, Algorithm::run, watch);
    }
    // Where the objective led away from all that is feasible.
    if start.warm.is_none() && is_lost(&best) {
        best = another(best, nlp, start, &options, Algorithm::run_from_feasible, watch);
    }
    best
}

/// The factorisation to begin with: the recursion wherever there are stages, unless its border makes it too dear.
fn factorization(nlp: &dyn Nlp, linear: Linear) -> Linear {
    match (linear, nlp.stages()) {
        (Linear::Automatic, None) => Linear::SparseLdl,
        (Linear::Automatic, Some(stages)) => {
            let is_dear = is_sparse_cheaper(stages, nlp.hessian_structure(), nlp.jacobian_structure());
            if is_dear { Linear::SparseLdl } else { Linear::Riccati }
        }
        (named, _) => named,
    }
}

/// Whether another attempt may end otherwise.
fn is_lost(solution: &Solution) -> bool {
    matches!(solution.status, Status::Infeasible | Status::NumericalFailure)
}

/// Makes another attempt, and answers with the one that says more.
fn another(
    first: Solution,
    nlp: &mut dyn Nlp,
    start: &Start,
    options: &Options,
    run: impl FnOnce(&mut Algorithm, &mut dyn Nlp, &mut Watch) -> Status,
    watch: &mut Watch,
) -> Solution {
    let mut counts = first.counts;
    if counts.iterations >= options.max_iter {
        return first;
    }
    let options = Options { max_iter: options.max_iter.saturating_sub(counts.iterations), ..*options };
    let second = attempt_with(nlp, start, &options, run, &mut |progress| {
        watch(&Progress { iteration: counts.iterations + progress.iteration, ..*progress })
    });
    counts.add(&second.counts);
    let is_taken = match second.status {
        Status::Solved | Status::Acceptable => true,
        // A verdict says more than a failure.
        Status::Infeasible => first.status == Status::NumericalFailure,
        _ => false,
    };
    // Whoever stops the search is not told that there is nothing.
    let is_stopped = matches!(second.status, Status::TimeLimit | Status::Interrupted);
    let status = if is_taken || is_stopped { second.status.clone() } else { first.status.clone() };
    let best = if is_taken { second } else { first };
    Solution { status, counts, ..best }
}

/// One attempt, without another opinion.
pub(super) fn attempt(nlp: &mut dyn Nlp, start: &Start, options: &Options, watch: &mut Watch) -> Solution {
    attempt_with(nlp, start, options, Algorithm::run, watch)
}

fn attempt_with(
    nlp: &mut dyn Nlp,
    start: &Start,
    options: &Options,
    run: impl FnOnce(&mut Algorithm, &mut dyn Nlp, &mut Watch) -> Status,
    watch: &mut Watch,
) -> Solution {
    let mut scaled = Scaled::new(nlp, &start.v);
    let objective_scale = scaled.objective();
    let start = scaled.start(start);
    let mut watch = |progress: &Progress| {
        watch(&Progress { objective: progress.objective / objective_scale, ..*progress })
    };
    let mut algorithm = start::prepare(&mut scaled, &start, *options);
    let status = run(&mut algorithm, &mut scaled, &mut watch);
    let mu = algorithm.barrier.mu;
    let Algorithm { at, counts, residuals, space, .. } = algorithm;
    let mut multipliers = Multipliers {
        rows: at.lambda,
        lower: at.lower[..space.variables].to_vec(),
        upper: at.upper[..space.variables].to_vec(),
    };
    let mut v = at.y[..space.variables].to_vec();
    scaled.unscale(&mut v, &mut multipliers);
    let mut rows = vec![0.0; multipliers.rows.len()];
    let objective = nlp.values(&v, &mut rows);
    let constraint_violation = super::constraint_violation(nlp, &v);
    let kkt_error = residuals.error(0.0);
    Solution { status, v, multipliers, mu, objective, kkt_error, constraint_violation, global: false, counts }
}
