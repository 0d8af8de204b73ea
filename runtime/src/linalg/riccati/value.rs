//! The value function that travels backward along the chain.

use super::sizes::Sizes;

/// A value function: the lower triangle of `[P Lambda; Lambda' Theta]`, where `Q` has it.
pub(super) struct Value {
    pub(super) rows: Vec<f64>,
}

impl Value {
    pub(super) fn new(sizes: Sizes) -> Self {
        Value { rows: vec![0.0; sizes.reduced() * sizes.reduced()] }
    }

    /// Entry `(i, j)` over `(x, theta)`.
    #[inline(always)]
    pub(super) fn at(&self, sizes: Sizes, i: usize, j: usize) -> f64 {
        let rows = &self.rows[..sizes.reduced() * sizes.reduced()];
        rows[i.max(j) * sizes.reduced() + i.min(j)]
    }

    /// Takes it from the whole square matrix.
    pub(super) fn set(&mut self, sizes: Sizes, square: &[f64]) {
        for (target, row) in
            self.rows.chunks_exact_mut(sizes.reduced()).zip(square.chunks_exact(sizes.kept()))
        {
            target[..row.len()].copy_from_slice(row);
        }
    }

    /// Gives back the whole square matrix.
    pub(super) fn write(&self, sizes: Sizes, square: &mut [f64]) {
        for (i, row) in square.chunks_exact_mut(sizes.kept()).enumerate() {
            row.iter_mut().enumerate().for_each(|(j, target)| *target = self.at(sizes, i, j));
        }
    }
}
