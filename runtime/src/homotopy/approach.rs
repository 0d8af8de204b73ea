//! To the grid and the width that the model names, from coarse grids and wide layers.
//!
//! The width shrinks on the coarsest grid, roughly, then the last width is solved on every second finer grid, each solve begun where the one before ended
//! ([`prolong`]): far from the solution an iteration costs little, and on the finest grid few are left. Where this fails, widths shrink on the finest grid,
//! from half the size of the switching function on; where that fails, too, it is tried at once and with all patience.

use super::Watch;
use super::run::{Goal, Run, is_good, is_retried};
use crate::linalg::Stages;
use crate::nlp::{Nlp, Solution, Start, constraint_violation};
use crate::problem::Problem;
use crate::prolong::prolong;
use crate::transcribe::TranscribedNlp;

/// A grid of fewer intervals is not made coarser by half: it would say too little of the problem.
const COARSE: usize = 500;
/// Widths on the way, relative to the one that is named, and to which error; a wide layer needs but half the coarsest grid.
const WIDER: [(f64, bool, f64); 3] = [(8.0, true, 1e-2), (4.0, true, ROUGH), (2.0, false, ROUGH)];
/// ... if that has as many intervals.
const FEWEST: usize = 100;
/// More is not asked of a solve with another width, nor of one on the coarsest grid or on another one: which of several close minima is found is decided
/// on finer grids.
const ROUGH: f64 = 1e-3;
const COARSEST: f64 = 1e-4;
const CLOSE: f64 = 1e-5;
/// A solve on the way that takes longer leads nowhere.
const MOST_ITERATIONS: usize = 300;
const WIDE: f64 = 0.5;
const MOST_HALVINGS: i32 = 12;

/// One solve on the way.
#[derive(Clone, Copy)]
struct Step {
    intervals: usize,
    /// The width of all layers; as they are if there is none.
    sigma: Option<f64>,
    tol: f64,
}

impl Run<'_> {
    /// Solves with the widths that the model names, if there are surfaces.
    pub(super) fn named(
        &mut self,
        nlp: &mut TranscribedNlp,
        start: Start,
        widths: &[f64],
        watch: &mut Watch,
    ) -> Solution {
        let (all, patience) = (self.goal().limit, self.patience());
        let direct = self.on_one_grid(nlp.chain(), widths);
        let path = self.path(nlp.chain(), widths);
        // What was solved before, or is easy, is not approached.
        if start.warm.is_some() || path.len() == 1 {
            return self.climb(nlp, start, &direct, all, watch);
        }
        let first = self.climb(nlp, start.clone(), &path, patience, watch);
        if !is_retried(&first.status) || all <= patience {
            return first;
        }
        if let [sigma] = widths {
            let halved = self.on_one_grid(nlp.chain(), &halved(nlp, [&start.v, &first.v], *sigma));
            let second = self.climb(nlp, start.clone(), &halved, patience, watch);
            if !is_retried(&second.status) {
                return second;
            }
        }
        self.climb(nlp, start, &direct, all, watch)
    }

    /// Solves with the widths as they are, over coarse grids where there are any.
    pub(super) fn as_they_are(
        &mut self,
        nlp: &mut TranscribedNlp,
        start: Start,
        watch: &mut Watch,
    ) -> Solution {
        let path = self.path(nlp.chain(), &[]);
        if start.warm.is_none() && path.len() > 1 {
            let solution = self.climb(nlp, start.clone(), &path, self.patience(), watch);
            if !is_retried(&solution.status) {
                return solution;
            }
        }
        self.solve(nlp, &start, self.goal(), watch)
    }

    /// The limit of iterations for a solve that another one may replace.
    pub(super) fn patience(&self) -> usize {
        MOST_ITERATIONS.min(self.goal().limit)
    }

    /// From step to step; the last ones are on the grid of `nlp`.
    fn climb(
        &mut self,
        nlp: &mut TranscribedNlp,
        mut start: Start,
        steps: &[Step],
        limit: usize,
        watch: &mut Watch,
    ) -> Solution {
        let mut chain = nlp.chain();
        let split = steps.partition_point(|step| step.intervals < chain.intervals);
        let (coarser, last) = steps.split_at(split);
        for steps in coarser.chunk_by(|a, b| a.intervals == b.intervals) {
            let problem = on_grid(self.problem, steps[0].intervals);
            let mut coarse = TranscribedNlp::new(&problem);
            start = prolong(chain, &start, coarse.chain());
            chain = coarse.chain();
            let solution = self.walk(&mut coarse, start, steps, limit, watch);
            start = Start::after(&solution);
            if !is_good(&solution.status) {
                return carried_over(nlp, chain, &start, solution);
            }
        }
        start = prolong(chain, &start, nlp.chain());
        self.walk(nlp, start, last, limit, watch)
    }

    /// From step to step on one grid.
    fn walk(
        &mut self,
        nlp: &mut TranscribedNlp,
        mut start: Start,
        steps: &[Step],
        limit: usize,
        watch: &mut Watch,
    ) -> Solution {
        let (last, before) = steps.split_last().expect("each grid has a step");
        for step in before {
            let solution = self.step(nlp, &start, step, limit, watch);
            if !is_good(&solution.status) {
                return solution;
            }
            start = Start::after(&solution);
        }
        self.step(nlp, &start, last, limit, watch)
    }

    fn step(
        &mut self,
        nlp: &mut TranscribedNlp,
        start: &Start,
        step: &Step,
        limit: usize,
        watch: &mut Watch,
    ) -> Solution {
        if let Some(sigma) = step.sigma {
            self.sigma.fill(sigma);
        }
        self.solve(nlp, start, Goal { tol: step.tol, limit }, watch)
    }

    /// Widths shrink on the coarsest grid, and the last one goes to finer grids.
    fn path(&self, chain: Stages, widths: &[f64]) -> Vec<Step> {
        let grids = grids(self.problem, chain);
        let rough = |sigma: &f64| Step { intervals: grids[0], sigma: Some(*sigma), tol: ROUGH };
        let mut path: Vec<Step> = match widths {
            [sigma] if !self.sigma.is_empty() => wider(grids[0], *sigma, is_plain(self.problem, chain)),
            [before @ .., _] => before.iter().map(rough).collect(),
            [] => Vec::new(),
        };
        let sigma = widths.last().copied();
        let tolerances = [COARSEST].into_iter().chain(std::iter::repeat(CLOSE));
        path.extend(grids.iter().zip(tolerances).map(|(intervals, tol)| Step {
            intervals: *intervals,
            sigma,
            tol,
        }));
        self.within_tolerance(path)
    }

    /// One width after the other on the grid of the model.
    fn on_one_grid(&self, chain: Stages, widths: &[f64]) -> Vec<Step> {
        let step = |sigma| Step { intervals: chain.intervals, sigma, tol: ROUGH };
        let steps = if widths.is_empty() {
            vec![step(None)]
        } else {
            widths.iter().map(|w| step(Some(*w))).collect()
        };
        self.within_tolerance(steps)
    }

    /// The last step to the tolerance of the model, no other one beyond it.
    fn within_tolerance(&self, mut steps: Vec<Step>) -> Vec<Step> {
        let tol = self.goal().tol;
        steps.iter_mut().for_each(|step| step.tol = step.tol.max(tol));
        steps.iter_mut().next_back().into_iter().for_each(|step| step.tol = tol);
        steps
    }
}

/// Coarser grids, the coarsest first, and the grid itself; that one alone where an interval holds more than states and constant controls.
fn grids(problem: &Problem, chain: Stages) -> Vec<usize> {
    let coarser = |n: &usize| (is_plain(problem, chain) && *n >= COARSE).then_some(n / 2);
    let mut grids: Vec<usize> = std::iter::successors(Some(chain.intervals), coarser).collect();
    grids.reverse();
    grids
}

fn is_plain(problem: &Problem, chain: Stages) -> bool {
    chain.inner == 0 && chain.states == problem.layout.x
}

/// Wider layers than the one that is named.
fn wider(intervals: usize, sigma: f64, is_plain: bool) -> Vec<Step> {
    let half = if is_plain && intervals / 2 >= FEWEST { intervals / 2 } else { intervals };
    let step = |(wider, on_half, tol): (f64, bool, f64)| Step {
        intervals: if on_half { half } else { intervals },
        sigma: Some(wider * sigma),
        tol,
    };
    WIDER.into_iter().map(step).collect()
}

fn on_grid(problem: &Problem, intervals: usize) -> Problem {
    let mut problem = problem.clone();
    problem.method.intervals = intervals;
    problem
}

/// What ended on a coarse grid, seen on the grid of the problem.
fn carried_over(nlp: &mut TranscribedNlp, from: Stages, end: &Start, solution: Solution) -> Solution {
    let Start { v, warm } = prolong(from, end, nlp.chain());
    let objective = nlp.values(&v, &mut vec![0.0; nlp.row_bounds().len()]);
    let constraint_violation = constraint_violation(nlp, &v);
    let multipliers = warm.map_or(solution.multipliers, |warm| warm.multipliers);
    Solution { v, multipliers, objective, constraint_violation, ..solution }
}

/// Half the size of a switching function, halved until it is the width.
fn halved(nlp: &TranscribedNlp, known: [&Vec<f64>; 2], sigma: f64) -> Vec<f64> {
    let sizes = known.into_iter().flat_map(|v| nlp.guard_sizes(v));
    let size = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
    let halvings = (WIDE * size / sigma).log2().ceil().clamp(1.0, f64::from(MOST_HALVINGS)) as i32;
    (0..=halvings).rev().map(|k| sigma * 2.0_f64.powi(k)).collect()
}
