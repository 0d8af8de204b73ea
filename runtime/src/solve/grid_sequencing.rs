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
use crate::nlp::{Nlp, Solution, Start, constraint_violation};
use crate::problem::{Chain, Grid, Problem};
use crate::transcribe::chain::{ChainNlp, Shape};

/// The intervals of each phase.
pub(super) type Intervals = Vec<usize>;

impl Run<'_> {
    /// From grid to grid, the last of which is that of `nlp`; widths shrink on the first one.
    pub(super) fn over_grids(
        &mut self,
        nlp: &mut ChainNlp,
        mut start: Start,
        (grids, mut widths): (&[Intervals], &[f64]),
        target: Target,
        watch: &mut Watch,
    ) -> Solution {
        let mut shape = nlp.shape().clone();
        let mut accuracy = COARSEST;
        for intervals in &grids[..grids.len() - 1] {
            let coarser = on_grid(self.chain, intervals);
            let mut coarse = ChainNlp::new(&coarser);
            start = prolonged(&shape, &start, &coarse);
            let close = Target { tol: target.tol.max(accuracy), ..target };
            let solution = self.shrink(&mut coarse, start, widths, close, watch);
            start = Start::after(&solution);
            if !solution.status.is_solved() {
                return on_final_grid(nlp, coarse.shape(), &start, solution);
            }
            shape = coarse.shape().clone();
            widths = &widths[widths.len().saturating_sub(1)..];
            accuracy = (FINER * accuracy).max(CLOSE);
        }
        start = prolonged(&shape, &start, nlp);
        self.shrink(nlp, start, widths, target, watch)
    }
}

/// Coarser grids, the coarsest first, and the grid itself; that one alone where its intervals
/// differ in length. Each phase is coarsened as long as it has intervals to spare.
pub(super) fn grids(chain: &Chain) -> Vec<Intervals> {
    let is_uniform = |phase: &Problem| phase.method.grid.times().is_empty();
    let coarser = |grid: &Intervals| {
        let of = |(n, phase): (&usize, &Problem)| {
            if is_uniform(phase) && *n >= COARSE { n / 2 } else { *n }
        };
        let halved: Intervals = grid.iter().zip(&chain.phases).map(of).collect();
        (halved != *grid).then_some(halved)
    };
    let own = chain.phases.iter().map(|phase| phase.method.intervals()).collect();
    let mut grids: Vec<Intervals> = std::iter::successors(Some(own), coarser).collect();
    grids.reverse();
    grids
}

fn on_grid(chain: &Chain, intervals: &Intervals) -> Chain {
    let mut chain = chain.clone();
    for (phase, intervals) in chain.phases.iter_mut().zip(intervals) {
        if phase.method.intervals() != *intervals {
            phase.method.grid = Grid::Uniform(*intervals);
        }
    }
    chain
}

/// A start on the grids of another transcription of the same chain.
fn prolonged(from: &Shape, start: &Start, to: &ChainNlp) -> Start {
    let phases = to.each().zip(from.split(start)).zip(&from.phases);
    let own = phases.map(|((to, start), from)| {
        let times = Times::new(to.interval(), to.problem().path_bounds.len());
        prolong(&times, from.stages, &start, to.chain())
    });
    to.shape().joined(&own.collect::<Vec<_>>(), start)
}

/// What ended on a coarse grid, seen on the grid of the problem.
fn on_final_grid(nlp: &mut ChainNlp, from: &Shape, end: &Start, solution: Solution) -> Solution {
    let Start { v, warm } = prolonged(from, end, nlp);
    let objective = nlp.values(&v, &mut vec![0.0; nlp.constraint_bounds().len()]);
    let constraint_violation = constraint_violation(nlp, &v);
    let multipliers = warm.map_or(solution.multipliers, |warm| warm.multipliers);
    Solution { v, multipliers, objective, constraint_violation, ..solution }
}
