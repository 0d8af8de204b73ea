//! One solve after the other, with what they share: the widths, the work done, and the person who
//! watches.

use super::tuning::run::NEAR;
use super::{Attempt, Level, Watch};
use crate::nlp::{Counts, Options, Progress, Solution, Start, Status, convex, interior_point};
use crate::problem::{Chain, Order};
use crate::transcribe::chain::ChainNlp;

/// All solves of one problem.
pub(super) struct Run<'p> {
    pub(super) chain: &'p Chain,
    /// The work of all solves so far.
    pub(super) counts: Counts,
    /// The smoothing width of each surface, phase by phase.
    pub(super) sigma: Vec<f64>,
    /// All solves so far.
    pub(super) attempts: Vec<Attempt>,
}

/// How one solve is to end.
#[derive(Clone, Copy)]
pub(super) struct Target {
    /// Tolerance on the optimality error.
    pub(super) tol: f64,
    /// Most iterations.
    pub(super) limit: usize,
}

/// Whether another start may help: it was neither solved nor stopped.
pub(super) fn is_retried(status: &Status) -> bool {
    !status.is_solved() && !matches!(status, Status::TimeLimit | Status::Interrupted)
}

/// Whether it found nothing feasible, or no way on: that says something of this grid, this width
/// and this start only.
pub(crate) fn is_lost(status: &Status) -> bool {
    matches!(status, Status::Infeasible | Status::NumericalFailure)
}

impl<'p> Run<'p> {
    /// Before the first solve, with the widths that the problem has.
    pub(super) fn new(chain: &'p Chain) -> Self {
        let sigma = chain.surfaces().map(|(_, width)| width.value).collect();
        Run { chain, counts: Counts::default(), sigma, attempts: Vec::new() }
    }

    /// What the model asks of a solve.
    pub(super) fn target(&self) -> Target {
        Target { tol: self.chain.method().tol, limit: self.chain.method().max_iter }
    }

    /// The options of a solve with such an end.
    pub(super) fn options(&self, target: Target) -> Options {
        let method = self.chain.method();
        let is_final = target.tol <= method.tol;
        Options { tol: target.tol, max_iter: target.limit, linear: method.linear, is_final }
    }

    /// Gives the NLP the widths as they are now.
    pub(super) fn apply_sigma(&self, nlp: &mut ChainNlp) {
        nlp.set_widths(&self.sigma);
    }

    /// One solve; a warm start that fails is repeated with fresh multipliers, unless it is near a
    /// solution.
    pub(super) fn solve(
        &mut self,
        nlp: &mut ChainNlp,
        start: &Start,
        target: Target,
        watch: &mut Watch,
    ) -> Solution {
        let solution = self.once(nlp, start, target, watch);
        let is_near = solution.kkt_error <= NEAR;
        if start.warm.is_none() || is_near || !is_retried(&solution.status) {
            return solution;
        }
        self.once(nlp, &Start { v: start.v.clone(), warm: None }, target, watch)
    }

    /// The answer of the conic solver to a convex problem.
    pub(super) fn conic(
        &self,
        nlp: &mut ChainNlp,
        start: &Start,
        options: &Options,
        watch: &mut Watch,
    ) -> Option<Solution> {
        let intervals = nlp.intervals();
        let level = Level { intervals, stages: None, sigma: &self.sigma };
        convex::solve(nlp, start, options, &mut |progress| watch(progress, level))
    }

    /// One solve; its counts are those of all solves so far.
    pub(super) fn once(
        &mut self,
        nlp: &mut ChainNlp,
        start: &Start,
        target: Target,
        watch: &mut Watch,
    ) -> Solution {
        self.apply_sigma(nlp);
        let method = self.chain.method();
        let options = self.options(target);
        let stages = (method.order == Order::Auto).then(|| method.scheme.stages());
        let level = Level { intervals: nlp.intervals(), stages, sigma: &self.sigma };
        self.attempts.push(Attempt { intervals: level.intervals, sigma: self.sigma.clone() });
        let before = self.counts.iterations;
        let mut solution = interior_point::solve(nlp, start, &options, &mut |progress| {
            watch(&Progress { iteration: before + progress.iteration, ..*progress }, level)
        });
        self.counts.add(&solution.counts);
        solution.counts = self.counts;
        solution
    }
}
