//! To the grid and the width that the model names, from coarse grids and wide layers.
//!
//! The width shrinks on the coarsest grid, roughly, then the last width is solved on one finer grid
//! after the other, each time more accurately, and each solve is begun where the one before ended
//! ([`prolong`]): far from the solution an iteration costs little, and on the finest grid few are
//! left. Where this fails, widths shrink on the finest grid, from half the size of the switching
//! function on, or from far above the width; where that fails, too, it is tried at once and with
//! all patience. So a failure on a coarse grid or in a wide layer is never the last word: what the
//! model names has been tried.

use super::Watch;
use super::run::{Goal, Run, is_good, is_lost, is_retried};
use crate::linalg::Stages;
use crate::nlp::{Nlp, Solution, Start, Status, constraint_violation};
use crate::problem::Problem;
use crate::prolong::{Times, prolong};
use crate::transcribe::TranscribedNlp;

/// A grid of fewer intervals is not made coarser by half: it would say too little of the problem.
const COARSE: usize = 250;
/// Widths on the way, relative to the one that is named.
const WIDER: [f64; 3] = [8.0, 4.0, 2.0];
/// More is not asked of a solve with another width, nor of the coarsest grid; from grid to grid it
/// is `FINER` times as much, but never more than `CLOSE`: which of several close minima is found is
/// decided on finer grids.
const ROUGH: f64 = 1e-2;
/// The same where there is no coarse grid, and no finer one will put right what was found.
const CAREFUL: f64 = 1e-3;
const COARSEST: f64 = 1e-3;
const FINER: f64 = 0.1;
const CLOSE: f64 = 1e-5;
/// A solve on the way that takes longer leads nowhere.
const MOST_ITERATIONS: usize = 300;
const WIDE: f64 = 0.5;
/// A guess or a failure on which the switching function is nearly 0 says nothing of its size: there
/// are at least so many.
const FEWEST_HALVINGS: f64 = 8.0;
const MOST_HALVINGS: f64 = 12.0;

impl Run<'_> {
    /// Solves with the widths that the model names, if there are surfaces.
    pub(super) fn named(
        &mut self,
        nlp: &mut TranscribedNlp,
        start: Start,
        widths: &[f64],
        watch: &mut Watch,
    ) -> Solution {
        let goal = self.goal();
        let patience = Goal { limit: MOST_ITERATIONS.min(goal.limit), ..goal };
        let grids = grids(self.problem);
        let shrinking = match widths {
            [sigma] if !self.sigma.is_empty() => {
                WIDER.iter().map(|wider| wider * sigma).chain([*sigma]).collect()
            }
            _ => widths.to_vec(),
        };
        // What was solved before, or is easy, is not approached.
        if start.warm.is_some() || grids.len() == 1 && shrinking.len() <= 1 {
            return self.shrink(nlp, start, widths, goal, watch);
        }
        let first = self.climb(nlp, start.clone(), (&grids, &shrinking), patience, watch);
        let is_out_of_iterations =
            first.status == Status::IterationLimit && goal.limit <= patience.limit;
        if !is_retried(&first.status) || is_out_of_iterations {
            return first;
        }
        if let [sigma] = widths {
            let halved = halved(nlp, [&start.v, &first.v], *sigma);
            let second = self.shrink(nlp, start.clone(), &halved, patience, watch);
            if !is_retried(&second.status) {
                return second;
            }
        }
        let last = self.shrink(nlp, start.clone(), widths, goal, watch);
        match widths {
            [.., sigma] if is_lost(&last.status) && self.is_wider_than(*sigma) => {
                self.shrink(nlp, start, &[*sigma], goal, watch)
            }
            _ => last,
        }
    }

    /// Whether the last solve was one with a wider layer.
    fn is_wider_than(&self, sigma: f64) -> bool {
        self.sigma.iter().any(|width| *width > sigma)
    }

    /// From grid to grid, the last of which is that of `nlp`; widths shrink on the first one.
    pub(super) fn climb(
        &mut self,
        nlp: &mut TranscribedNlp,
        mut start: Start,
        (grids, mut widths): (&[usize], &[f64]),
        goal: Goal,
        watch: &mut Watch,
    ) -> Solution {
        let mut chain = nlp.chain();
        let times = Times::new(nlp.interval(), self.problem.path_bounds.len());
        let mut accuracy = COARSEST;
        for &intervals in &grids[..grids.len() - 1] {
            let problem = on_grid(self.problem, intervals);
            let mut coarse = TranscribedNlp::new(&problem);
            start = prolong(&times, chain, &start, coarse.chain());
            chain = coarse.chain();
            let close = Goal { tol: goal.tol.max(accuracy), ..goal };
            let solution = self.shrink(&mut coarse, start, widths, close, watch);
            start = Start::after(&solution);
            if !is_good(&solution.status) {
                return carried_over(nlp, &times, (chain, &start), solution);
            }
            widths = &widths[widths.len().saturating_sub(1)..];
            accuracy = (FINER * accuracy).max(CLOSE);
        }
        start = prolong(&times, chain, &start, nlp.chain());
        self.shrink(nlp, start, widths, goal, watch)
    }

    /// From width to width on one grid; with the widths as they are if none are given.
    fn shrink(
        &mut self,
        nlp: &mut TranscribedNlp,
        mut start: Start,
        widths: &[f64],
        goal: Goal,
        watch: &mut Watch,
    ) -> Solution {
        let Some((last, before)) = widths.split_last() else {
            return self.solve(nlp, &start, goal, watch);
        };
        let is_coarse = nlp.chain().intervals < self.problem.method.intervals;
        let rough = Goal { tol: goal.tol.max(if is_coarse { ROUGH } else { CAREFUL }), ..goal };
        for width in before {
            self.sigma.fill(*width);
            let solution = self.solve(nlp, &start, rough, watch);
            if !is_good(&solution.status) {
                return solution;
            }
            start = Start::after(&solution);
        }
        self.sigma.fill(*last);
        self.solve(nlp, &start, goal, watch)
    }
}

/// Coarser grids, the coarsest first, and the grid itself; that one alone where its intervals
/// differ in length.
pub(super) fn grids(problem: &Problem) -> Vec<usize> {
    let method = &problem.method;
    let coarser = |n: &usize| (method.mesh.is_empty() && *n >= COARSE).then_some(n / 2);
    let mut grids: Vec<usize> = std::iter::successors(Some(method.intervals), coarser).collect();
    grids.reverse();
    grids
}

fn on_grid(problem: &Problem, intervals: usize) -> Problem {
    let mut problem = problem.clone();
    problem.method.intervals = intervals;
    problem
}

/// What ended on a coarse grid, seen on the grid of the problem.
fn carried_over(
    nlp: &mut TranscribedNlp,
    times: &Times,
    (from, end): (Stages, &Start),
    solution: Solution,
) -> Solution {
    let Start { v, warm } = prolong(times, from, end, nlp.chain());
    let objective = nlp.values(&v, &mut vec![0.0; nlp.row_bounds().len()]);
    let constraint_violation = constraint_violation(nlp, &v);
    let multipliers = warm.map_or(solution.multipliers, |warm| warm.multipliers);
    Solution { v, multipliers, objective, constraint_violation, ..solution }
}

/// Half the size of a switching function, halved until it is the width.
fn halved(nlp: &TranscribedNlp, known: [&Vec<f64>; 2], sigma: f64) -> Vec<f64> {
    let sizes = known.into_iter().flat_map(|v| nlp.guard_sizes(v));
    let size = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
    let halvings = (WIDE * size / sigma).log2().ceil().clamp(FEWEST_HALVINGS, MOST_HALVINGS) as i32;
    (0..=halvings).rev().map(|k| sigma * 2.0_f64.powi(k)).collect()
}
