//! The restoration phase: to smaller violations, where the subproblem has no feasible point or its
//! solution leads nowhere.
//!
//! ```text
//!     minimise  theta(v)  =  the sum of all violations of rows
//! ```
//!
//! by the same method: the subproblem with slacks at the price 1 and without the objective is its
//! own quadratic programme, and a row that can be satisfied has a multiplier between -1 and 1. It
//! ends at a point that the filter accepts, or at the smallest violation near by.

use super::algorithm::Algorithm;
use super::residuals::Residuals;
use super::search::Search;
use super::subproblem::{Direction, Subproblem};
use super::working::Working;
use crate::nlp::{Multipliers, Nlp, Status};

const PRICE: f64 = 1.0;
/// The wish to stay near: what is added to the Hessian at least.
const PROXIMITY: f64 = 1e-6;
const ARMIJO: f64 = 1e-4;
const SHORTEST: f64 = 1e-10;
const REQUIRED_DECREASE: f64 = 0.9;
/// A gradient of the violation that is smaller than this is none; nor is a decrease of less than
/// this part of it, if the rows were linear.
const STATIONARY: f64 = 1e-6;
/// The filter is emptied so many times.
const MOST_RESTARTS: usize = 4;

impl Algorithm {
    /// Begins a restoration phase here.
    pub(super) fn begin_restoration(&mut self, nlp: &mut dyn Nlp) {
        self.counts.restorations += 1;
        self.filter.add(self.at.violation, self.at.objective);
        self.restored_from = Some(self.at.violation);
        self.multipliers = Multipliers::zeros(nlp);
        self.differentiate(nlp);
    }

    /// One step of it; the status if there is none.
    pub(super) fn restore(&mut self, nlp: &mut dyn Nlp) -> Option<Status> {
        let working = Working::tight(nlp, &self.at, &self.multipliers, PRICE);
        let tolerance = self.accuracy();
        let Algorithm { at, derivatives, sides, counts, curvature, .. } = self;
        let Some(convexity) = curvature.regularized(derivatives, &working, PROXIMITY, counts)
        else {
            return Some(Status::NumericalFailure);
        };
        let subproblem = Subproblem { nlp, at, derivatives, working: &working, convexity };
        let Some(mut direction) = subproblem.solve(sides, Some(PRICE), tolerance, counts) else {
            return Some(Status::NumericalFailure);
        };
        direction
            .multipliers
            .rows
            .iter_mut()
            .for_each(|lambda| *lambda = lambda.clamp(-PRICE, PRICE));
        self.progress.regularization = convexity.delta;
        let slope = Residuals::new(nlp, &self.at, &self.derivatives, &direction.multipliers);
        let is_stationary =
            slope.dual <= STATIONARY || self.gain(&direction) <= STATIONARY * self.at.violation;
        if is_stationary && slope.primal > self.options.tol {
            self.multipliers = direction.multipliers;
            return Some(Status::Infeasible);
        }
        if !self.descend(nlp, &direction) {
            return Some(self.stuck());
        }
        self.leave(nlp)
    }

    fn gain(&self, direction: &Direction) -> f64 {
        self.at.violation - direction.violation
    }

    /// The line search on the violation.
    fn descend(&mut self, nlp: &mut dyn Nlp, direction: &Direction) -> bool {
        let gain = self.gain(direction);
        let Algorithm { at, curvature, counts, .. } = self;
        let before = at.violation;
        let search = Search { nlp, at, d: &direction.d, curvature, counts };
        let accepted =
            search.run(SHORTEST, |point, alpha| point.violation <= before - ARMIJO * alpha * gain);
        let Some(accepted) = accepted.filter(|_| gain > 0.0) else { return false };
        self.move_to(accepted, direction);
        true
    }

    /// Ends the phase if the filter accepts the point, or if nothing is violated any more.
    fn leave(&mut self, nlp: &dyn Nlp) -> Option<Status> {
        let required = self.restored_from.map_or(f64::INFINITY, |theta| REQUIRED_DECREASE * theta);
        let is_accepted = self.at.violation <= required
            && self.filter.accepts(self.at.violation, self.at.objective);
        if !is_accepted && self.at.violation > self.options.tol {
            return None;
        }
        if !is_accepted {
            self.filter.clear();
            self.emptied += 1;
        }
        self.restored_from = None;
        self.multipliers = Multipliers::zeros(nlp);
        (self.emptied > MOST_RESTARTS).then_some(Status::NumericalFailure)
    }
}
