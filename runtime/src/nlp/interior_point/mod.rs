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
use crate::problem::Linear;
use algorithm::Algorithm;

/// Solves the programme from `start`. Progress is reported unscaled, once per iteration. Where the recursion ends without a solution, the sparse
/// factorisation is asked, whose other rounding and regularisation lead along another path: nobody is told "infeasible" for want of luck.
pub fn solve(nlp: &mut dyn Nlp, start: &Start, options: &Options, watch: &mut Watch) -> Solution {
    let first = attempt(nlp, start, options, watch);
    let is_lost = matches!(first.status, Status::Infeasible | Status::NumericalFailure);
    if !is_lost || options.linear != Linear::Automatic || nlp.stages().is_none() {
        return first;
    }
    let second = attempt(nlp, start, &Options { linear: Linear::SparseLdl, ..*options }, watch);
    // A verdict says more than a failure.
    let is_taken = match second.status {
        Status::Solved | Status::Acceptable => true,
        Status::Infeasible => first.status == Status::NumericalFailure,
        _ => false,
    };
    let mut counts = first.counts;
    counts.add(&second.counts);
    Solution { counts, ..if is_taken { second } else { first } }
}

/// One attempt, without a second opinion.
pub(super) fn attempt(nlp: &mut dyn Nlp, start: &Start, options: &Options, watch: &mut Watch) -> Solution {
    let mut scaled = Scaled::new(nlp, &start.v);
    let objective_scale = scaled.objective;
    let mut watch = |progress: &Progress| {
        watch(&Progress { objective: progress.objective / objective_scale, ..*progress })
    };
    let mut algorithm = start::prepare(&mut scaled, start, *options);
    let status = algorithm.run(&mut scaled, &mut watch);
    let mu = algorithm.barrier.mu;
    let Algorithm { at, counts, residuals, space, .. } = algorithm;
    let mut multipliers = Multipliers {
        rows: at.lambda,
        lower: at.lower[..space.variables].to_vec(),
        upper: at.upper[..space.variables].to_vec(),
    };
    scaled.unscale(&mut multipliers);
    let v = at.y[..space.variables].to_vec();
    let mut rows = vec![0.0; multipliers.rows.len()];
    let objective = nlp.values(&v, &mut rows);
    let constraint_violation = super::constraint_violation(nlp, &v);
    let kkt_error = residuals.error(0.0);
    Solution { status, v, multipliers, mu, objective, kkt_error, constraint_violation, global: false, counts }
}
