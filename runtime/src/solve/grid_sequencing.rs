//! Grid sequencing: from coarse uniform grids to the one that the model names.
//!
//! Smoothing widths shrink on the coarsest grid, roughly; then the last width is solved on one
//! finer grid after the other, each time more accurately, and each solve is begun where the one
//! before ended ([`prolong`]): far from the solution an iteration costs little, and on the finest
//! grid few are left.

use super::Watch;
use super::prolong::{Times, prolong};
use super::run::{Run, Target};
use super::tuning::grid_sequencing::{CLOSE, COARSE, COARSEST, FINER};
use crate::linalg::Stages;
use crate::nlp::{Nlp, Solution, Start, constraint_violation};
use crate::problem::{Grid, Problem};
use crate::transcribe::TranscribedNlp;

impl Run<'_> {
    /// From grid to grid, the last of which is that of `nlp`; widths shrink on the first one.
    pub(super) fn over_grids(
        &mut self,
        nlp: &mut TranscribedNlp,
        mut start: Start,
        (grids, mut widths): (&[usize], &[f64]),
        target: Target,
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
            let close = Target { tol: target.tol.max(accuracy), ..target };
            let solution = self.shrink(&mut coarse, start, widths, close, watch);
            start = Start::after(&solution);
            if !solution.status.is_solved() {
                return on_final_grid(nlp, &times, (chain, &start), solution);
            }
            widths = &widths[widths.len().saturating_sub(1)..];
            accuracy = (FINER * accuracy).max(CLOSE);
        }
        start = prolong(&times, chain, &start, nlp.chain());
        self.shrink(nlp, start, widths, target, watch)
    }
}

/// Coarser grids, the coarsest first, and the grid itself; that one alone where its intervals
/// differ in length.
pub(super) fn grids(problem: &Problem) -> Vec<usize> {
    let method = &problem.method;
    let coarser = |n: &usize| (method.grid.times().is_empty() && *n >= COARSE).then_some(n / 2);
    let mut grids: Vec<usize> = std::iter::successors(Some(method.intervals()), coarser).collect();
    grids.reverse();
    grids
}

fn on_grid(problem: &Problem, intervals: usize) -> Problem {
    let mut problem = problem.clone();
    problem.method.grid = Grid::Uniform(intervals);
    problem
}

/// What ended on a coarse grid, seen on the grid of the problem.
fn on_final_grid(
    nlp: &mut TranscribedNlp,
    times: &Times,
    (from, end): (Stages, &Start),
    solution: Solution,
) -> Solution {
    let Start { v, warm } = prolong(times, from, end, nlp.chain());
    let objective = nlp.values(&v, &mut vec![0.0; nlp.constraint_bounds().len()]);
    let constraint_violation = constraint_violation(nlp, &v);
    let multipliers = warm.map_or(solution.multipliers, |warm| warm.multipliers);
    Solution { v, multipliers, objective, constraint_violation, ..solution }
}
