//! The recursion along the chain, compiled several times: for common sizes as constants, whose
//! loops unroll, and for machines with and without fused multiply-add and registers of four
//! numbers.

use super::recursion::Recursion;
use super::sizes::Sizes;
use super::solve::Travel;
use crate::linalg::dense::lanes::Lanes;

/// **The table** of sizes that are compiled as constants: states, controls, border; without inner
/// variables. All others go by the sizes that they are given (0, 0, 0). Each row is 80 kB of
/// machine code: all 140 up to (7, 3, 4) would make the program half as large again.
macro_rules! with_constant_sizes {
    ($this:ident.$function:ident($($arguments:expr),*)) => {
        match $this.sizes {
            Sizes { n: 2, m: 1, inner: 0, q: 0 } => $this.$function::<2, 1, 0>($($arguments),*),
            Sizes { n: 4, m: 1, inner: 0, q: 0 } => $this.$function::<4, 1, 0>($($arguments),*),
            Sizes { n: 5, m: 2, inner: 0, q: 1 } => $this.$function::<5, 2, 1>($($arguments),*),
            Sizes { n: 2, m: 1, inner: 0, q: 2 } => $this.$function::<2, 1, 2>($($arguments),*),
            Sizes { n: 2, m: 1, inner: 0, q: 3 } => $this.$function::<2, 1, 3>($($arguments),*),
            Sizes { n: 4, m: 1, inner: 0, q: 3 } => $this.$function::<4, 1, 3>($($arguments),*),
            _ => $this.$function::<0, 0, 0>($($arguments),*),
        }
    };
}

/// The values that are factored.
#[derive(Clone, Copy)]
pub(super) struct Matrix<'a> {
    pub(super) hessian: &'a [f64],
    pub(super) jacobian: &'a [f64],
    pub(super) sigma: &'a [f64],
    pub(super) d: &'a [f64],
}

impl Recursion {
    /// Factors all intervals; returns how many negative eigenvalues there are beyond one per row,
    /// or `None` at a zero pivot or when there are more than `most`.
    pub(super) fn factor_chain(&mut self, matrix: Matrix, most: usize) -> Option<usize> {
        #[cfg(target_arch = "x86_64")]
        if self.fused {
            // SAFETY: `fused` is set only if this machine has both features.
            #[allow(unsafe_code)]
            return unsafe { with_constant_sizes!(self.factor_fused(matrix, most)) };
        }
        with_constant_sizes!(self.factor_plain(matrix, most))
    }

    /// Goes backward: what travels is the gradient of the value function of the last state, and
    /// becomes that of the first.
    pub(super) fn backward(&self, travel: &mut Travel, a: &mut [f64], b: &mut [f64]) {
        #[cfg(target_arch = "x86_64")]
        if self.fused {
            // SAFETY: `fused` is set only if this machine has both features.
            #[allow(unsafe_code)]
            return unsafe { with_constant_sizes!(self.backward_fused(travel, a, b)) };
        }
        with_constant_sizes!(self.backward_plain(travel, a, b))
    }

    /// Goes forward: what travels is `(x, theta)` at the first state, and becomes that at the last.
    pub(super) fn forward(&self, travel: &mut Travel, a: &mut [f64], b: &mut [f64]) {
        #[cfg(target_arch = "x86_64")]
        if self.fused {
            // SAFETY: `fused` is set only if this machine has both features.
            #[allow(unsafe_code)]
            return unsafe { with_constant_sizes!(self.forward_fused(travel, a, b)) };
        }
        with_constant_sizes!(self.forward_plain(travel, a, b))
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn factor_fused<const N: usize, const M: usize, const Q: usize>(
        &mut self,
        matrix: Matrix,
        most: usize,
    ) -> Option<usize> {
        self.factor_intervals::<true>(self.sizes.known::<N, M, Q>(), matrix, most)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn backward_fused<const N: usize, const M: usize, const Q: usize>(
        &self,
        travel: &mut Travel,
        a: &mut [f64],
        b: &mut [f64],
    ) {
        self.backward_intervals::<true>(self.sizes.known::<N, M, Q>(), travel, (a, b))
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn forward_fused<const N: usize, const M: usize, const Q: usize>(
        &self,
        travel: &mut Travel,
        a: &mut [f64],
        b: &mut [f64],
    ) {
        self.forward_intervals::<true>(self.sizes.known::<N, M, Q>(), travel, (a, b))
    }

    fn factor_plain<const N: usize, const M: usize, const Q: usize>(
        &mut self,
        matrix: Matrix,
        most: usize,
    ) -> Option<usize> {
        self.factor_intervals::<false>(self.sizes.known::<N, M, Q>(), matrix, most)
    }

    fn backward_plain<const N: usize, const M: usize, const Q: usize>(
        &self,
        travel: &mut Travel,
        a: &mut [f64],
        b: &mut [f64],
    ) {
        self.backward_intervals::<false>(self.sizes.known::<N, M, Q>(), travel, (a, b))
    }

    fn forward_plain<const N: usize, const M: usize, const Q: usize>(
        &self,
        travel: &mut Travel,
        a: &mut [f64],
        b: &mut [f64],
    ) {
        self.forward_intervals::<false>(self.sizes.known::<N, M, Q>(), travel, (a, b))
    }

    #[inline(always)]
    fn factor_intervals<const FUSED: bool>(
        &mut self,
        sizes: Sizes,
        matrix: Matrix,
        most: usize,
    ) -> Option<usize> {
        let Recursion { stages, assembly, fixed, factors, condensed, block, value, .. } = self;
        let mut negative = 0;
        for first in (0..stages.intervals).step_by(Lanes::COUNT).rev() {
            let intervals = first..(first + Lanes::COUNT).min(stages.intervals);
            condensed.fill::<FUSED>(
                sizes,
                (stages, assembly),
                matrix,
                intervals.clone(),
                factors,
            )?;
            for k in intervals.rev() {
                let penalties = if factors.penalised { &matrix.d[stages.defects(k)] } else { &[] };
                let fixed = &fixed[stages.control(k)];
                let q = condensed.quadratic_mut(sizes, k - first);
                negative +=
                    block.factor::<FUSED>(sizes, q, factors, (k, fixed, penalties), value)?;
                // The rest cannot have fewer than no negative eigenvalues.
                if negative > most {
                    return None;
                }
            }
        }
        Some(negative)
    }
}
