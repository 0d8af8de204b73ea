//! What an interval sees of the vectors of a chain: `[x_k u_k y_k x_{k+1} | globals | rows]`.

use crate::linalg::structure::stages::Stages;
use std::ops::Range;

/// Intervals of a batch.
pub(super) const BATCH: usize = 16;
/// One number of each interval of a batch; the last batch of a chain may have fewer, and leaves
/// zeros or what was there.
pub(super) type Numbers = [f64; BATCH];
pub(super) const NOTHING: Numbers = [0.0; BATCH];

/// Where the numbers that an interval sees are; nothing where there is no chain.
#[derive(Clone, Copy)]
pub(super) struct Sight {
    pub(super) stages: Stages,
    /// `(x_k, u_k, y_k, x_{k+1})`
    window: usize,
}

const NO_STAGES: Stages = Stages {
    intervals: 0,
    states: 0,
    controls: 0,
    inner: 0,
    globals: 0,
    local_constraints: 0,
    coupling_constraints: 0,
};

impl Sight {
    /// Without stages there is nothing to see.
    pub(super) fn new(stages: Option<Stages>) -> Self {
        let stages = stages.unwrap_or(NO_STAGES);
        Sight { stages, window: stages.variable_step() + stages.states }
    }

    pub(super) fn first_row(&self) -> usize {
        self.window + self.stages.globals
    }

    pub(super) fn len(&self) -> usize {
        self.first_row() + self.stages.row_step()
    }

    /// The place of a variable that is at `index` in interval 0 and moves by `step`.
    pub(super) fn variable(&self, index: usize, step: usize) -> Option<usize> {
        let (stages, globals) = (&self.stages, self.stages.globals());
        if globals.contains(&index) {
            return (step == 0).then(|| self.window + index - globals.start);
        }
        let moves_along = step == stages.variable_step() || stages.intervals == 1;
        (moves_along && index < self.window).then_some(index)
    }

    pub(super) fn row(&self, index: usize, step: usize) -> Option<usize> {
        let moves_along = step == self.stages.row_step() || self.stages.intervals == 1;
        (moves_along && index < self.stages.row_step()).then(|| self.first_row() + index)
    }

    pub(super) fn batches(self) -> impl Iterator<Item = Range<usize>> {
        let all = self.stages.intervals;
        (0..all).step_by(BATCH).map(move |first| first..(first + BATCH).min(all))
    }

    #[inline(always)]
    pub(super) fn see_variables(&self, batch: &Range<usize>, v: &[f64], seen: &mut [Numbers]) {
        see(batch, v, self.stages.variable_step(), &mut seen[..self.window]);
        for (place, value) in seen[self.window..].iter_mut().zip(&v[self.stages.globals()]) {
            *place = [*value; BATCH];
        }
    }

    #[inline(always)]
    pub(super) fn see_rows(&self, batch: &Range<usize>, w: &[f64], seen: &mut [Numbers]) {
        see(batch, w, self.stages.row_step(), &mut seen[self.first_row()..]);
    }

    #[inline(always)]
    pub(super) fn tell_variables(&self, batch: &Range<usize>, found: &[Numbers], a: &mut [f64]) {
        tell(batch, &found[..self.window], a, self.stages.variable_step());
        for (sum, value) in a[self.stages.globals()].iter_mut().zip(&found[self.window..]) {
            *sum += value[..batch.len()].iter().sum::<f64>();
        }
    }

    #[inline(always)]
    pub(super) fn tell_rows(&self, batch: &Range<usize>, found: &[Numbers], b: &mut [f64]) {
        tell(batch, &found[self.first_row()..], b, self.stages.row_step());
    }
}

/// The numbers of each interval of a batch.
#[inline(always)]
fn see(batch: &Range<usize>, vector: &[f64], step: usize, seen: &mut [Numbers]) {
    for (l, k) in batch.clone().enumerate() {
        for (place, value) in seen.iter_mut().zip(&vector[k * step..]) {
            place[l] = *value;
        }
    }
}

/// Adds what was found for each interval of a batch.
#[inline(always)]
fn tell(batch: &Range<usize>, found: &[Numbers], vector: &mut [f64], step: usize) {
    for (l, k) in batch.clone().enumerate() {
        for (sum, value) in vector[k * step..].iter_mut().zip(found) {
            *sum += value[l];
        }
    }
}
