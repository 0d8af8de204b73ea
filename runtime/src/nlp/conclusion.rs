//! What a solver found, in the end: the one place where a status is given, by measures of the
//! program as it was written.

use super::assessment::Assessment;
use super::{Counts, Multipliers, Nlp, Options, Solution, Status, objective_and_violation};

/// Where a solver came to its end, in the units of the program, and what it says of that itself.
pub(super) struct Ended {
    pub(super) status: Status,
    pub(super) v: Vec<f64>,
    pub(super) multipliers: Multipliers,
    /// See [`Solution::mu`].
    pub(super) mu: f64,
    /// See [`Solution::kkt_error`].
    pub(super) kkt_error: f64,
    /// See [`Solution::is_saddle`].
    pub(super) is_saddle: bool,
    /// See [`Solution::descent`].
    pub(super) descent: Option<Vec<f64>>,
    /// The measures of the program there, where they are known.
    pub(super) assessed: Option<Assessment>,
    /// The Newton decrement, in units of the objective; infinite where it is not known.
    pub(super) decrement: f64,
    pub(super) counts: Counts,
}

/// The solution with the status that it deserves. A solve on the way to another has the status that
/// the solver gives.
pub(super) fn conclude(nlp: &mut dyn Nlp, ended: Ended, options: &Options) -> Solution {
    let Ended { mut status, v, multipliers, mu, kkt_error, is_saddle, descent, .. } = ended;
    let (decrement, counts) = (ended.decrement, ended.counts);
    let mut improvement = f64::INFINITY;
    if options.is_final {
        let assessment = ended.assessed.unwrap_or_else(|| Assessment::new(nlp, &v, &multipliers));
        let assessment = assessment.with_decrement(decrement);
        improvement = assessment.improvement();
        status = judged(status, &assessment, is_saddle, options.tol);
    }
    let (objective, constraint_violation) = objective_and_violation(nlp, &v);
    let status = if status.is_solved() && !objective.is_finite() {
        Status::NotFinite(nlp.not_finite(&v).unwrap_or_default())
    } else {
        status
    };
    let global = false;
    Solution {
        status,
        v,
        multipliers,
        mu,
        objective,
        kkt_error,
        improvement,
        constraint_violation,
        global,
        is_saddle,
        descent,
        counts,
    }
}

/// A solver may be too sure of itself, or too modest; where it was stopped there is nothing to
/// judge.
fn judged(status: Status, found: &Assessment, is_saddle: bool, tol: f64) -> Status {
    match status {
        // A point from which the objective falls to second order is no optimum, not even a rough
        // one.
        Status::Solved | Status::Acceptable if is_saddle => Status::NumericalFailure,
        Status::Solved if found.is_convincing(tol) => Status::Solved,
        Status::Solved | Status::Acceptable | Status::NumericalFailure => {
            if found.is_acceptable(tol) { Status::Acceptable } else { Status::NumericalFailure }
        }
        // What meets all conditions is feasible, whatever a search for less violation says.
        Status::Infeasible if found.is_feasible(tol) => Status::NumericalFailure,
        // What falls without end falls at points that meet all conditions.
        Status::Unbounded if !found.is_feasible(tol) => Status::NumericalFailure,
        status => status,
    }
}
