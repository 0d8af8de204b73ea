//! The loop: look, decide, step.

use super::curvature::{Convexity, Curvature};
use super::point::Point;
use super::residuals::{Residuals, largest};
use super::search::{Accepted, Search};
use super::subproblem::{Direction, Subproblem};
use super::working::Working;
use crate::nlp::convex::one_sided::Sides;
use crate::nlp::filter::{Filter, Reference};
use crate::nlp::{Counts, Derivatives, Multipliers, Nlp, Options, Progress, Status, Stop, Watch};
use std::ops::ControlFlow;

/// An error this small is acceptable where nothing more can be gained.
const ACCEPTABLE_ERROR: f64 = 1e-6;
/// Variables beyond this, at a point that is feasible relative to them, have left the problem.
const DIVERGED: f64 = 1e10;
/// Where a direction leads nowhere, more and more is added to the Hessian, from the first to the
/// last of these, before violations alone are looked at.
const FIRST_CAUTION: f64 = 1e-8;
const MOST_CAUTION: f64 = 10.0;
const CAUTION_GROWTH: f64 = 10.0;
const CAUTION_DECAY: f64 = 0.01;
/// A line search that keeps less than the first fraction of a step asks for more caution, one that
/// keeps more than the second for less.
const CUT_SHORT: f64 = 0.1;
const NOT_CUT: f64 = 0.5;
/// A whole step is taken without a line search if no more than this is left of the optimality
/// error.
const HALVED: f64 = 0.5;

/// The state of a solve.
pub(super) struct Algorithm {
    pub(super) at: Point,
    pub(super) multipliers: Multipliers,
    pub(super) residuals: Residuals,
    pub(super) counts: Counts,
    pub(super) derivatives: Derivatives,
    /// Derivatives at the end of a whole step.
    trial: Derivatives,
    /// Of all iterates so far.
    smallest_error: f64,
    pub(super) curvature: Curvature,
    pub(super) sides: Sides,
    pub(super) filter: Filter,
    /// The violation where the restoration phase began, within one.
    pub(super) restored_from: Option<f64>,
    /// How often the filter was emptied at a feasible point.
    pub(super) emptied: usize,
    /// What is added to the Hessian at least.
    caution: f64,
    pub(super) options: Options,
    pub(super) progress: Progress,
}

impl Algorithm {
    pub(super) fn new(
        nlp: &mut dyn Nlp,
        v: &[f64],
        multipliers: Multipliers,
        options: Options,
    ) -> Self {
        let mut counts = Counts::default();
        let at = Point::new(nlp, v.to_vec(), &mut counts);
        Algorithm {
            filter: Filter::new(at.violation),
            at,
            multipliers,
            residuals: Residuals::default(),
            counts,
            derivatives: Derivatives::new(nlp),
            trial: Derivatives::new(nlp),
            smallest_error: f64::INFINITY,
            curvature: Curvature::new(nlp),
            sides: Sides::new(nlp),
            restored_from: None,
            emptied: 0,
            caution: 0.0,
            options,
            progress: Progress::default(),
        }
    }

    /// Iterates to the end.
    pub(super) fn run(&mut self, nlp: &mut dyn Nlp, watch: &mut Watch) -> Status {
        if nlp
            .variable_bounds()
            .iter()
            .chain(nlp.row_bounds())
            .any(|bounds| bounds.lower > bounds.upper)
        {
            return Status::Infeasible;
        }
        loop {
            if let Some(status) = self.look(nlp, watch).or_else(|| self.step(nlp)) {
                return status;
            }
        }
    }

    /// Derivatives and residuals; the status if this is the end.
    fn look(&mut self, nlp: &mut dyn Nlp, watch: &mut Watch) -> Option<Status> {
        self.differentiate(nlp);
        self.residuals = Residuals::new(nlp, &self.at, &self.derivatives, &self.multipliers);
        if !self.is_finite() {
            return Some(Status::NotFinite(nlp.not_finite(&self.at.v).unwrap_or_default()));
        }
        self.progress = Progress {
            iteration: self.counts.iterations,
            restoration: self.restored_from.is_some(),
            objective: self.at.objective,
            primal_infeasibility: self.residuals.primal,
            dual_infeasibility: self.residuals.dual,
            ..self.progress
        };
        match watch(&self.progress) {
            ControlFlow::Break(Stop::TimeLimit) => Some(Status::TimeLimit),
            ControlFlow::Break(Stop::Interrupted) => Some(Status::Interrupted),
            ControlFlow::Continue(()) => self.finished(),
        }
    }

    /// Derivatives at the iterate, in a restoration phase without those of the objective.
    pub(super) fn differentiate(&mut self, nlp: &mut dyn Nlp) {
        self.counts.derivatives += 1;
        let weight = if self.restored_from.is_some() { 0.0 } else { 1.0 };
        nlp.derivatives(&self.at.v, weight, &self.multipliers.rows, &mut self.derivatives);
        self.derivatives.gradient.iter_mut().for_each(|value| *value *= weight);
    }

    fn is_finite(&self) -> bool {
        let Derivatives { hessian, jacobian, gradient } = &self.derivatives;
        let all = [hessian, jacobian, gradient];
        self.at.is_finite() && all.into_iter().flatten().all(|value| value.is_finite())
    }

    fn finished(&mut self) -> Option<Status> {
        if self.restored_from.is_none() {
            self.smallest_error = self.smallest_error.min(self.residuals.error());
        }
        let size = largest(self.at.v.iter().copied());
        if self.restored_from.is_none() && self.residuals.error() <= self.options.tol {
            Some(Status::Solved)
        } else if size > DIVERGED && self.residuals.primal <= self.options.tol * size {
            Some(Status::Unbounded)
        } else if self.counts.iterations >= self.options.max_iter {
            Some(Status::IterationLimit)
        } else {
            None
        }
    }

    /// One step; the status if there is none.
    fn step(&mut self, nlp: &mut dyn Nlp) -> Option<Status> {
        if self.restored_from.is_some() {
            return self.restore(nlp);
        }
        while self.caution <= MOST_CAUTION {
            match self.advance(nlp) {
                Ok(()) => return None,
                Err(delta) => self.caution = (CAUTION_GROWTH * delta).max(FIRST_CAUTION),
            }
        }
        self.caution = 0.0;
        if self.residuals.primal <= self.options.tol {
            return Some(self.stuck());
        }
        self.begin_restoration(nlp);
        self.restore(nlp)
    }

    /// Follows the solution of the subproblem; if there is none, or it leads nowhere, what was
    /// added to the Hessian for it.
    fn advance(&mut self, nlp: &mut dyn Nlp) -> Result<(), f64> {
        let (working, convexity) = self.convexify(nlp).ok_or(f64::INFINITY)?;
        let tolerance = self.accuracy();
        let Algorithm { at, derivatives, sides, counts, .. } = self;
        let subproblem = Subproblem { nlp, at, derivatives, working: &working, convexity };
        let direction = subproblem.solve(sides, None, tolerance, counts).ok_or(convexity.delta)?;
        let accepted = self.whole_step(nlp, &direction).or_else(|| self.searched(nlp, &direction));
        let accepted = accepted.ok_or(convexity.delta)?;
        self.progress.regularization = convexity.delta;
        self.judge(accepted.alpha, convexity.delta);
        self.move_to(accepted, &direction);
        Ok(())
    }

    /// The whole step, if it halves the smallest optimality error so far: near the solution the
    /// filter compares what is rounding.
    fn whole_step(&mut self, nlp: &mut dyn Nlp, direction: &Direction) -> Option<Accepted> {
        let v = self.at.v.iter().zip(&direction.d).map(|(v, d)| v + d).collect();
        let point = Point::new(nlp, v, &mut self.counts);
        if !point.is_finite() {
            return None;
        }
        self.counts.derivatives += 1;
        nlp.derivatives(&point.v, 1.0, &direction.multipliers.rows, &mut self.trial);
        let error = Residuals::new(nlp, &point, &self.trial, &direction.multipliers).error();
        (error <= HALVED * self.smallest_error).then_some(Accepted { point, alpha: 1.0, trials: 1 })
    }

    /// Where the line search ends.
    fn searched(&mut self, nlp: &mut dyn Nlp, direction: &Direction) -> Option<Accepted> {
        let Algorithm { at, derivatives, counts, curvature, filter, .. } = self;
        let slope = derivatives.gradient.iter().zip(&direction.d).map(|(g, d)| g * d).sum();
        let from = Reference { theta: at.violation, phi: at.objective, slope };
        let smallest = filter.smallest_step(from);
        let search = Search { nlp, at, d: &direction.d, curvature, counts };
        search.run(smallest, |point, alpha| {
            filter.judge(from, alpha, point.violation, point.objective)
        })
    }

    /// Learns from a line search.
    fn judge(&mut self, alpha: f64, delta: f64) {
        if alpha < CUT_SHORT {
            self.caution = (CAUTION_GROWTH * delta).clamp(FIRST_CAUTION, MOST_CAUTION);
        } else if alpha > NOT_CUT {
            let less = CAUTION_DECAY * self.caution;
            self.caution = if less < FIRST_CAUTION { 0.0 } else { less };
        }
    }

    /// The equations suffice to make the Hessian convex, or the bounds that are active now are
    /// taken for equations as well.
    fn convexify(&mut self, nlp: &dyn Nlp) -> Option<(Working, Convexity)> {
        let Algorithm { at, derivatives, multipliers, curvature, counts, .. } = self;
        let caution = self.caution;
        let equations = Working::equations(nlp, at);
        if let Some(convexity) = curvature.with(derivatives, &equations, caution, counts) {
            return Some((equations, convexity));
        }
        let active = Working::active(nlp, at, multipliers);
        let convexity = curvature.regularized(derivatives, &active, caution, counts)?;
        Some((active, convexity))
    }

    pub(super) fn move_to(&mut self, accepted: Accepted, direction: &Direction) {
        let Accepted { point, alpha, trials } = accepted;
        self.counts.iterations += 1;
        self.progress.step = largest(direction.d.iter().copied());
        (self.progress.alpha_primal, self.progress.alpha_dual, self.progress.trials) =
            (alpha, alpha, trials);
        self.at = point;
        let Multipliers { rows, lower, upper } = &direction.multipliers;
        mix(&mut self.multipliers.rows, rows, alpha);
        mix(&mut self.multipliers.lower, lower, alpha);
        mix(&mut self.multipliers.upper, upper, alpha);
    }

    pub(super) fn stuck(&self) -> Status {
        if self.residuals.error() <= ACCEPTABLE_ERROR {
            Status::Acceptable
        } else {
            Status::NumericalFailure
        }
    }

    /// What is asked of the conic solver.
    pub(super) fn accuracy(&self) -> f64 {
        (0.1 * self.options.tol).max(1e-10)
    }
}

fn mix(target: &mut [f64], new: &[f64], alpha: f64) {
    target.iter_mut().zip(new).for_each(|(value, new)| *value += alpha * (new - *value));
}
