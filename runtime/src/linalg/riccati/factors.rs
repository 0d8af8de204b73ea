//! What the solves need of a factorisation: one stretch of each table for each interval.

use super::sizes::Sizes;
use std::ops::Range;

/// See [`super::interval`] for the names.
pub(super) struct Factors {
    /// `[T F; N M]`, with columns for `(w, y, x+)`; where rows are penalised, all of the response
    /// to `(w, b)`.
    response: Vec<f64>,
    /// `A`, square in `(y, x+)`; empty until a row is penalised.
    compliance: Vec<f64>,
    /// Whether the last factorisation had penalised rows.
    pub(super) penalised: bool,
    /// `Q_uu^-1` and `gain`.
    inverse: Vec<f64>,
    gain: Vec<f64>,
    /// Values of the local rows, and `1 / d` of each row.
    local: Vec<f64>,
    weights: Vec<f64>,
    local_values: usize,
    local_constraints: usize,
}

impl Factors {
    pub(super) fn new(
        sizes: Sizes,
        intervals: usize,
        local_constraints: usize,
        local_values: usize,
    ) -> Self {
        let zeros = |length: usize| vec![0.0; intervals * length];
        let m = sizes.m;
        Factors {
            response: zeros(2 * sizes.next() * sizes.all()),
            compliance: Vec::new(),
            penalised: false,
            inverse: zeros(m * m),
            gain: zeros(m * sizes.kept()),
            local: zeros(local_values),
            weights: zeros(local_constraints),
            local_values,
            local_constraints,
        }
    }

    #[inline(always)]
    pub(super) fn response(&self, sizes: Sizes, k: usize) -> &[f64] {
        stretch(&self.response, k, 2 * sizes.next() * sizes.all())
    }

    #[inline(always)]
    pub(super) fn response_mut(&mut self, sizes: Sizes, k: usize) -> &mut [f64] {
        stretch_mut(&mut self.response, k, 2 * sizes.next() * sizes.all())
    }

    #[inline(always)]
    pub(super) fn responses_mut(&mut self, sizes: Sizes, intervals: Range<usize>) -> &mut [f64] {
        stretches_mut(&mut self.response, intervals, 2 * sizes.next() * sizes.all())
    }

    /// `Q_uu^-1` and `gain`.
    #[inline(always)]
    pub(super) fn controls(&self, sizes: Sizes, k: usize) -> (&[f64], &[f64]) {
        let Sizes { m, .. } = sizes;
        (stretch(&self.inverse, k, m * m), stretch(&self.gain, k, m * sizes.kept()))
    }

    #[inline(always)]
    pub(super) fn controls_mut(&mut self, sizes: Sizes, k: usize) -> (&mut [f64], &mut [f64]) {
        let Sizes { m, .. } = sizes;
        (stretch_mut(&mut self.inverse, k, m * m), stretch_mut(&mut self.gain, k, m * sizes.kept()))
    }

    /// Values and weights of the local rows.
    #[inline(always)]
    pub(super) fn local(&self, k: usize) -> (&[f64], &[f64]) {
        (
            stretch(&self.local, k, self.local_values),
            stretch(&self.weights, k, self.local_constraints),
        )
    }

    /// Values of the local rows of these intervals.
    #[inline(always)]
    pub(super) fn local_mut(&mut self, intervals: Range<usize>) -> &mut [f64] {
        stretches_mut(&mut self.local, intervals, self.local_values)
    }

    #[inline(always)]
    pub(super) fn weights_mut(&mut self, intervals: Range<usize>) -> &mut [f64] {
        stretches_mut(&mut self.weights, intervals, self.local_constraints)
    }

    pub(super) fn compliance(&self, n: usize, k: usize) -> &[f64] {
        stretch(&self.compliance, k, n * n)
    }

    pub(super) fn keep_compliance<'a>(
        &mut self,
        n: usize,
        k: usize,
        rows: impl Iterator<Item = &'a [f64]>,
    ) {
        // The recursion goes backward: the first interval is the last one that needs room.
        let end = (k + 1) * n * n;
        if self.compliance.len() < end {
            self.compliance.resize(end, 0.0);
        }
        let kept = stretch_mut(&mut self.compliance, k, n * n).chunks_exact_mut(n);
        kept.zip(rows).for_each(|(kept, row)| kept.copy_from_slice(row));
    }
}

#[inline(always)]
fn stretch(table: &[f64], k: usize, length: usize) -> &[f64] {
    &table[k * length..][..length]
}

#[inline(always)]
fn stretch_mut(table: &mut [f64], k: usize, length: usize) -> &mut [f64] {
    &mut table[k * length..][..length]
}

#[inline(always)]
fn stretches_mut(table: &mut [f64], intervals: Range<usize>, length: usize) -> &mut [f64] {
    &mut table[intervals.start * length..intervals.end * length]
}
