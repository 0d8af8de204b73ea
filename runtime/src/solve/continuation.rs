//! Continuation: to the grid and the smoothing width that the model names, from coarse grids and
//! larger widths.
//!
//! The width shrinks on the coarsest grid, roughly, then the last width is solved on one finer grid
//! after the other, each time more accurately, and each solve is begun where the one before ended
//! ([`prolong`](super::prolong)): far from the solution an iteration costs little, and on the
//! finest grid few are left. Where this fails, widths shrink on the finest grid, from half the size
//! of the switching function on, or from far above the width; where that fails, too, it is tried at
//! once and with all patience. So a failure on a coarse grid or with a large width is never the
//! last word: what the model names has been tried.

use super::Watch;
use super::grid_sequencing::grids;
use super::run::{Run, Target, is_lost, is_retried};
use super::tuning::continuation::{
    COARSE_GRID_TOLERANCE, FEWEST_HALVINGS, INTERMEDIATE_TOLERANCE, MOST_HALVINGS, MOST_ITERATIONS,
    WIDE, WIDER,
};
use crate::nlp::{Solution, Start, Status};
use crate::transcribe::chain::ChainNlp;

impl Run<'_> {
    /// Solves with the widths that the model names, if there are surfaces.
    pub(super) fn with_named_widths(
        &mut self,
        nlp: &mut ChainNlp,
        start: Start,
        widths: &[f64],
        watch: &mut Watch,
    ) -> Solution {
        let target = self.target();
        let patience = Target { limit: MOST_ITERATIONS.min(target.limit), ..target };
        let grids = grids(self.chain);
        let shrinking = match widths {
            [sigma] if !self.sigma.is_empty() => {
                WIDER.iter().map(|wider| wider * sigma).chain([*sigma]).collect()
            }
            _ => widths.to_vec(),
        };
        // What was solved before, or is easy, is not approached.
        if start.warm.is_some() || grids.len() == 1 && shrinking.len() <= 1 {
            return self.shrink(nlp, start, widths, target, watch);
        }
        let first = self.over_grids(nlp, start.clone(), (&grids, &shrinking), patience, watch);
        let is_out_of_iterations =
            first.status == Status::IterationLimit && target.limit <= patience.limit;
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
        let last = self.shrink(nlp, start.clone(), widths, target, watch);
        match widths {
            [.., sigma] if is_lost(&last.status) && self.is_wider_than(*sigma) => {
                self.shrink(nlp, start, &[*sigma], target, watch)
            }
            _ => last,
        }
    }

    /// Whether the last solve was one with a wider layer.
    fn is_wider_than(&self, sigma: f64) -> bool {
        self.sigma.iter().any(|width| *width > sigma)
    }

    /// From width to width on one grid; with the widths as they are if none are given.
    pub(super) fn shrink(
        &mut self,
        nlp: &mut ChainNlp,
        mut start: Start,
        widths: &[f64],
        target: Target,
        watch: &mut Watch,
    ) -> Solution {
        let Some((last, before)) = widths.split_last() else {
            return self.solve(nlp, &start, target, watch);
        };
        let all = self.chain.phases.iter().map(|phase| phase.method.intervals());
        let is_coarse = nlp.intervals() < all.sum();
        let rough = Target {
            tol: target.tol.max(if is_coarse {
                COARSE_GRID_TOLERANCE
            } else {
                INTERMEDIATE_TOLERANCE
            }),
            ..target
        };
        for width in before {
            self.sigma.fill(*width);
            let solution = self.solve(nlp, &start, rough, watch);
            if !solution.status.is_solved() {
                return solution;
            }
            start = Start::after(&solution);
        }
        self.sigma.fill(*last);
        self.solve(nlp, &start, target, watch)
    }
}

/// Half the size of a switching function, halved until it is the width.
fn halved(nlp: &mut ChainNlp, known: [&Vec<f64>; 2], sigma: f64) -> Vec<f64> {
    let sizes = known.into_iter().flat_map(|v| nlp.switching_function_sizes(v));
    let size = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
    let halvings = (WIDE * size / sigma).log2().ceil().clamp(FEWEST_HALVINGS, MOST_HALVINGS) as i32;
    (0..=halvings).rev().map(|k| sigma * 2.0_f64.powi(k)).collect()
}
