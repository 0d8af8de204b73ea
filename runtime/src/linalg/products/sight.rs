//! What an interval of a chain sees of the vectors: `[x_k u_k y_k x_{k+1} | globals | rows]`.

use crate::linalg::structure::phases::PhaseStages;
use std::ops::Range;

/// Intervals of a batch.
pub(super) const BATCH: usize = 16;
/// One number of each interval of a batch; the last batch of a chain may have fewer, and leaves
/// zeros or what was there.
pub(super) type Numbers = [f64; BATCH];
pub(super) const NOTHING: Numbers = [0.0; BATCH];

/// Where the numbers that an interval of a chain sees are.
pub(super) struct Sight {
    pub(super) chain: PhaseStages,
    /// `(x_k, u_k, y_k, x_{k+1})`
    window: usize,
}

impl Sight {
    pub(super) fn new(chain: PhaseStages) -> Self {
        let window = chain.stages.variable_step() + chain.stages.states;
        Sight { chain, window }
    }

    pub(super) fn first_row(&self) -> usize {
        self.window + self.chain.globals.len()
    }

    pub(super) fn len(&self) -> usize {
        self.first_row() + self.chain.stages.row_step()
    }

    /// The place of a variable that is at `index` in interval 0 and moves by `step`.
    pub(super) fn variable(&self, index: usize, step: usize) -> Option<usize> {
        let PhaseStages { stages, variables, globals, .. } = &self.chain;
        if let Some(at) = globals.iter().position(|it| *it == index) {
            return (step == 0).then_some(self.window + at);
        }
        let place = index.checked_sub(variables.start).filter(|it| *it < self.window);
        place.filter(|_| step == stages.variable_step() || stages.intervals == 1)
    }

    /// That of a row.
    pub(super) fn row(&self, index: usize, step: usize) -> Option<usize> {
        let PhaseStages { stages, rows, .. } = &self.chain;
        let place = index.checked_sub(rows.start).filter(|it| *it < stages.row_step());
        let place = place.filter(|_| step == stages.row_step() || stages.intervals == 1);
        place.map(|it| self.first_row() + it)
    }

    pub(super) fn batches(&self) -> impl Iterator<Item = Range<usize>> + use<> {
        let all = self.chain.stages.intervals;
        (0..all).step_by(BATCH).map(move |first| first..(first + BATCH).min(all))
    }

    #[inline(always)]
    pub(super) fn see_variables(&self, batch: &Range<usize>, v: &[f64], seen: &mut [Numbers]) {
        let PhaseStages { stages, variables, globals, .. } = &self.chain;
        let own = &v[variables.start..variables.end];
        see(batch, own, stages.variable_step(), &mut seen[..self.window]);
        for (place, global) in seen[self.window..].iter_mut().zip(globals) {
            *place = [v[*global]; BATCH];
        }
    }

    #[inline(always)]
    pub(super) fn see_rows(&self, batch: &Range<usize>, w: &[f64], seen: &mut [Numbers]) {
        let own = &w[self.chain.rows.start..];
        see(batch, own, self.chain.stages.row_step(), &mut seen[self.first_row()..]);
    }

    #[inline(always)]
    pub(super) fn tell_variables(&self, batch: &Range<usize>, found: &[Numbers], a: &mut [f64]) {
        let PhaseStages { stages, variables, globals, .. } = &self.chain;
        let own = &mut a[variables.start..variables.end];
        tell(batch, &found[..self.window], own, stages.variable_step());
        for (global, value) in globals.iter().zip(&found[self.window..]) {
            a[*global] += value[..batch.len()].iter().sum::<f64>();
        }
    }

    #[inline(always)]
    pub(super) fn tell_rows(&self, batch: &Range<usize>, found: &[Numbers], b: &mut [f64]) {
        let own = &mut b[self.chain.rows.start..];
        tell(batch, &found[self.first_row()..], own, self.chain.stages.row_step());
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
