//! Widths of our own choice, where the model names none: each surface gets a fraction of the size
//! that its switching function has along the trajectory found so far, one solve after another; a
//! warm start takes those of the earlier solution. Where a step is too long it is halved; where
//! even short steps fail, the last width that could be solved is the answer. Where the
//! first and largest width cannot be solved, that is no verdict: smaller ones are begun with at
//! once.
//!
//! A guess that rests on a surface says nothing of the size of its function. Then the first
//! solution says it, and the first solve is repeated with it.

use super::Watch;
use super::grid_sequencing::grids;
use super::run::{Run, Target, is_lost, is_retried};
use super::tuning::smoothing_widths::{
    DECREASE, FIRST_FACTOR, LAST_FACTOR, MOST_FAILURES, MOST_ITERATIONS, MOST_SIZINGS, ROUGH,
    ROUNDING, SHRUNK, THINNER, TOO_THIN, TOO_WIDE, WIDE, WIDER,
};
use crate::nlp::{Solution, Start, Status};
use crate::transcribe::chain::ChainNlp;

impl Run<'_> {
    /// Solves with widths of our own choice, as small as can be solved.
    pub(super) fn with_chosen_widths(
        &mut self,
        nlp: &mut ChainNlp,
        mut start: Start,
        watch: &mut Watch,
    ) -> Solution {
        if let Some(warm) = start.warm.take_if(|warm| warm.widths.len() == self.sigma.len()) {
            self.sigma.clone_from(&warm.widths);
            let warm = Start { v: start.v.clone(), warm: Some(warm) };
            let solution = self.once(nlp, &warm, self.patience(), watch);
            if !is_retried(&solution.status) {
                return solution;
            }
        }
        self.set_relative(nlp, &start.v, FIRST_FACTOR);
        let widest = self.sigma.clone();
        let first = self.sized(nlp, &start, watch);
        let (mut best, mut factor) = self.or_thinner(nlp, &start, first, watch);
        let thin = is_lost(&best.status).then(|| (best.clone(), self.sigma.clone()));
        if thin.is_some() {
            best = self.or_wider(nlp, &start, best, &widest, watch);
        }
        if self.is_far_too_wide(nlp, &best.v) {
            factor = factor.max(self.relative(nlp, &best.v));
        }
        let (mut decrease, mut failures) = (DECREASE, 0);
        while best.status.is_solved() && factor > LAST_FACTOR && failures < MOST_FAILURES {
            let before = self.sigma.clone();
            let next = (factor * decrease).max(LAST_FACTOR);
            self.decrease(nlp, &best.v, next, next / factor);
            let target = self.patience();
            let solution = self.once(nlp, &Start::near(&best), target, watch);
            if solution.status.is_solved() {
                (factor, best) = (next, solution);
                continue;
            }
            self.sigma = before;
            (failures, decrease) = (failures + 1, decrease.sqrt());
            if matches!(solution.status, Status::TimeLimit | Status::Interrupted) {
                best.status = solution.status;
            }
        }
        // A layer that stays far too wide is no answer to one that was too thin.
        if let Some((lost, widths)) = thin
            && self.is_far_too_wide(nlp, &best.v)
        {
            (best, self.sigma) = (lost, widths);
        }
        self.apply_sigma(nlp);
        best.counts = self.counts;
        best
    }

    /// The widest layer; where the guess said nothing of the size of a switching function, with the
    /// size that it turns out to have.
    fn sized(&mut self, nlp: &mut ChainNlp, start: &Start, watch: &mut Watch) -> Solution {
        let first = self.first(nlp, start.clone(), watch);
        self.resized(nlp, start, first, watch)
    }

    /// Where the guess said nothing of that size and nothing was found, the widest layer may be too
    /// thin: a far wider one.
    fn or_wider(
        &mut self,
        nlp: &mut ChainNlp,
        start: &Start,
        lost: Solution,
        widest: &[f64],
        watch: &mut Watch,
    ) -> Solution {
        let is_open = self.is_open(nlp, start);
        if !is_open.contains(&true) {
            return lost;
        }
        let thin = self.sigma.clone();
        let wider =
            widest.iter().zip(is_open).map(|(it, is_open)| if is_open { WIDE * it } else { *it });
        self.sigma = wider.collect();
        let wide = self.first(nlp, start.clone(), watch);
        if !wide.status.is_solved() {
            self.sigma = thin;
            return lost;
        }
        self.resized(nlp, start, wide, watch)
    }

    /// The first solve again, until width and size fit.
    fn resized(
        &mut self,
        nlp: &mut ChainNlp,
        start: &Start,
        mut best: Solution,
        watch: &mut Watch,
    ) -> Solution {
        let mut is_open = self.is_open(nlp, start);
        for _ in 0..MOST_SIZINGS {
            let (before, sizes) = (self.sigma.clone(), nlp.switching_function_sizes(&best.v));
            self.resize(&is_open, &sizes);
            if self.sigma == before {
                break;
            }
            let solution = self.first(nlp, start.clone(), watch);
            if !solution.status.is_solved() {
                self.sigma = before;
                if matches!(solution.status, Status::TimeLimit | Status::Interrupted) {
                    best.status = solution.status;
                }
                break;
            }
            best = solution;
            let after = nlp.switching_function_sizes(&best.v);
            self.undo_where_held(&mut is_open, &before, &|at| after[at] < SHRUNK * sizes[at]);
        }
        best
    }

    /// Widths that fit the sizes of the functions, where they are still open.
    fn resize(&mut self, is_open: &[bool], sizes: &[f64]) {
        for ((sigma, size), _) in self.sigma.iter_mut().zip(sizes).zip(is_open).filter(|it| *it.1) {
            let fitting = FIRST_FACTOR * size;
            let fits = *sigma <= TOO_WIDE * fitting && *sigma >= TOO_THIN * fitting;
            if fitting > 0.0 && fitting.is_finite() && !fits {
                *sigma = fitting;
            }
        }
    }

    /// A function that is held says nothing of its size: its width follows that of the others, and
    /// is open no longer.
    fn undo_where_held(
        &mut self,
        is_open: &mut [bool],
        before: &[f64],
        shrinks: &dyn Fn(usize) -> bool,
    ) {
        let narrower = |at: usize| self.sigma[at] < before[at];
        let is_held: Vec<bool> = (0..before.len()).map(|at| narrower(at) && shrinks(at)).collect();
        let moving = (0..before.len()).filter(|at| is_open[*at] && !is_held[*at]);
        let factor = moving.map(|at| self.sigma[at] / before[at]).fold(f64::INFINITY, f64::min);
        let factor = if factor.is_finite() { factor.min(1.0) } else { 1.0 };
        for at in (0..before.len()).filter(|at| is_held[*at]) {
            self.sigma[at] = factor * before[at];
            is_open[at] = false;
        }
    }

    /// The widest layer: over coarse grids where there are any, from far wider ones, or at once and
    /// with all patience.
    fn first(&mut self, nlp: &mut ChainNlp, start: Start, watch: &mut Watch) -> Solution {
        let grids = grids(self.chain);
        if start.warm.is_some() {
            return self.solve(nlp, &start, self.target(), watch);
        }
        let is_coarse = grids.len() > 1;
        let found = match is_coarse {
            true => self.over_grids(nlp, start.clone(), (&grids, &[]), self.patience(), watch),
            false => self.solve(nlp, &start, self.patience(), watch),
        };
        if !is_retried(&found.status) {
            return found;
        }
        let wider = self.begun_wider(nlp, start.clone(), watch);
        if !is_retried(&wider.status) {
            return wider;
        }
        let is_same = !is_coarse && found.status != Status::IterationLimit;
        if is_same { found } else { self.solve(nlp, &start, self.target(), watch) }
    }

    /// From layers on both sides of which something changes, wherever the guess is, to these.
    fn begun_wider(&mut self, nlp: &mut ChainNlp, mut start: Start, watch: &mut Watch) -> Solution {
        let widths = self.sigma.clone();
        let rough = Target { tol: self.target().tol.max(ROUGH), ..self.patience() };
        for factor in WIDER {
            self.sigma = widths.iter().map(|width| factor * width).collect();
            let solution = self.solve(nlp, &start, rough, watch);
            if !solution.status.is_solved() {
                self.sigma = widths;
                return solution;
            }
            start = Start::after(&solution);
        }
        self.sigma = widths;
        self.solve(nlp, &start, self.patience(), watch)
    }

    /// What was found with the widest layer; where it is lost, with thinner ones, relative to the
    /// size of each switching function where it was lost.
    fn or_thinner(
        &mut self,
        nlp: &mut ChainNlp,
        start: &Start,
        first: Solution,
        watch: &mut Watch,
    ) -> (Solution, f64) {
        let (sizes, widest) = (first.v.clone(), self.sigma.clone());
        let (mut last, mut factor) = (first, FIRST_FACTOR);
        for thinner in THINNER {
            if !is_lost(&last.status) {
                break;
            }
            self.set_relative(nlp, &sizes, thinner);
            self.sigma
                .iter_mut()
                .zip(&widest)
                .for_each(|(sigma, widest)| *sigma = sigma.min(*widest));
            if self.sigma != widest {
                (last, factor) = (self.solve(nlp, start, self.target(), watch), thinner);
            }
        }
        (last, factor)
    }

    fn patience(&self) -> Target {
        let target = self.target();
        Target { limit: MOST_ITERATIONS.min(target.limit), ..target }
    }

    /// Widths relative to the size of each switching function along `v`; to its unit where `v`
    /// rests on the surface.
    fn set_relative(&mut self, nlp: &mut ChainNlp, v: &[f64], factor: f64) {
        let units = self.chain.surfaces().map(|(_, width)| width.unit);
        let sizes = nlp.switching_function_sizes(v).into_iter().zip(units);
        for (sigma, (size, unit)) in self.sigma.iter_mut().zip(sizes) {
            *sigma = factor * if size > ROUNDING * unit { size } else { unit };
        }
    }

    /// Whether no layer is as thin as the widest should be.
    fn is_far_too_wide(&self, nlp: &mut ChainNlp, v: &[f64]) -> bool {
        self.relative(nlp, v) > TOO_WIDE * FIRST_FACTOR
    }

    /// The least width relative to the size of its switching function along `v`; 0 if none has one.
    fn relative(&self, nlp: &mut ChainNlp, v: &[f64]) -> f64 {
        let sizes = self.sigma.iter().zip(nlp.switching_function_sizes(v));
        let relative = sizes.map(|(sigma, size)| sigma / size).filter(|it| it.is_finite());
        relative.reduce(f64::min).unwrap_or(0.0)
    }

    /// Smaller widths, by the factor `decrease`; but not below `factor` times the size of the
    /// switching function. On a held surface that size is the layer itself, and says nothing.
    fn decrease(&mut self, nlp: &mut ChainNlp, v: &[f64], factor: f64, decrease: f64) {
        for (sigma, size) in self.sigma.iter_mut().zip(nlp.switching_function_sizes(v)) {
            *sigma = (factor * size).clamp(decrease * *sigma, *sigma);
        }
    }

    /// Where a guess says nothing of the size of a switching function, because it rests on the
    /// surface.
    fn is_open(&self, nlp: &mut ChainNlp, start: &Start) -> Vec<bool> {
        let units = self.chain.surfaces().map(|(_, width)| width.unit);
        let sizes = nlp.switching_function_sizes(&start.v).into_iter();
        sizes.zip(units).map(|(size, unit)| size <= ROUNDING * unit).collect()
    }
}
