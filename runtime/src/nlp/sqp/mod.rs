//! Sequential quadratic programming: for programmes whose solution is nearly known.
//!
//! At an iterate `v` with multipliers `lambda`, the programme is replaced by
//!
//! ```text
//!     minimise  g'd + 1/2 d'B d    subject to   lower - c <= J d <= upper - c,   lower - v <= d <= upper - v
//! ```
//!
//! which the conic solver solves ([`subproblem`]); its solution is the direction of a line search
//! ([`search`]) that asks the filter, its multipliers are the next ones. `B` is the Hessian of the
//! Lagrangian, made convex in ways that do not change the solution of the subproblem where that can
//! be ([`curvature`]), so that near the solution the iterates are those of Newton's method with the
//! right conditions active. Where the subproblem has no feasible point, or its solution leads
//! nowhere, violations alone are made smaller ([`restoration`]). (Nocedal & Wright, Numerical
//! Optimization, 2nd ed., chapter 18.) The loop is in [`algorithm`].

mod algorithm;
mod curvature;
mod point;
mod residuals;
mod restoration;
mod search;
mod subproblem;
mod working;

use super::conclusion::{Ended, conclude};
use super::scaling::Scaled;
use super::{Multipliers, Nlp, Options, Progress, Solution, Start, Status, Watch, interior_point};
use algorithm::Algorithm;

/// Solves the programme from `start`. Progress is reported unscaled, once per iteration. Where this
/// ends without a solution, the interior point method is asked: far from a solution it finds more,
/// and nobody is told "infeasible" for want of luck.
pub fn solve(nlp: &mut dyn Nlp, start: &Start, options: &Options, watch: &mut Watch) -> Solution {
    let first = attempt(nlp, start, options, watch);
    let is_lost = matches!(
        first.status,
        Status::Acceptable | Status::Infeasible | Status::NumericalFailure | Status::NotFinite(_)
    );
    if !is_lost {
        return first;
    }
    let done = first.counts.iterations;
    // Where this method ended before, there is no room for a barrier.
    let mut second =
        interior_point::solve(nlp, &start.clone().with_room(), options, &mut |progress| {
            watch(&Progress { iteration: done + progress.iteration, ..*progress })
        });
    second.counts.add(&first.counts);
    second
}

/// The same without a second opinion.
pub(super) fn attempt(
    nlp: &mut dyn Nlp,
    start: &Start,
    options: &Options,
    watch: &mut Watch,
) -> Solution {
    let mut scaled = Scaled::new(nlp, &start.v);
    let objective_scale = scaled.objective();
    let start = scaled.start(start);
    let mut watch = |progress: &Progress| {
        watch(&Progress { objective: progress.objective / objective_scale, ..*progress })
    };
    // Those of an earlier solve, or none.
    let multipliers =
        start.warm.map_or_else(|| Multipliers::zeros(&scaled), |warm| warm.multipliers);
    let mut algorithm = Algorithm::new(&mut scaled, &start.v, multipliers, *options);
    let status = algorithm.run(&mut scaled, &mut watch);
    let kkt_error = algorithm.residuals.error();
    let Algorithm { at, mut multipliers, counts, .. } = algorithm;
    let mut v = at.v;
    scaled.unscale(&mut v, &mut multipliers);
    let (mu, is_saddle, decrement) = (0.0, false, f64::INFINITY);
    conclude(
        nlp,
        Ended { status, v, multipliers, mu, kkt_error, is_saddle, decrement, counts },
        options,
    )
}
