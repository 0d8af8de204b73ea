//! One step of the recursion.
//!
//! With `w = (x, u, theta)`, defects `R w + E x+ = b` and next value function `V+ = (P, Lambda, Theta)`:
//!
//! ```text
//!     M = H_{++} + P          N = H_{+w} + [0 0 Lambda']         T = -E^-1 R
//!     Q = H_ww + Theta + T'(M T + N) + N' T
//!     gain = -Q_uu^-1 Q_uz,   V = Q_zz + Q_zu gain               z = (x, theta)
//! ```
//!
//! Where the defects are penalised (`d > 0`: restoration), `x+` and the multipliers are removed together by the
//! factors of `S = [M E'; E -d]`, and `[T; L] = -S^-1 [N; R]` gives `Q = H_ww + Theta + [N; R]' [T; L]`.

use super::kernels::{add_outer_product, add_product, add_symmetric_product, add_transposed_product};
use crate::linalg::{Lu, Stages, SymmetricFactor};

/// Sizes of states, controls and border.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    pub(super) n: usize,
    pub(super) m: usize,
    pub(super) q: usize,
}

impl Sizes {
    /// `(x, u, theta)`
    pub(super) fn reduced(&self) -> usize {
        self.n + self.m + self.q
    }
    /// `(x, u, theta, x+)`
    pub(super) fn all(&self) -> usize {
        self.reduced() + self.n
    }
    /// `(x, theta)`
    pub(super) fn kept(&self) -> usize {
        self.n + self.q
    }
}

/// Dense matrices of one interval, shared scratch: Hessian and rows over `(x, u, theta, x+)`.
pub(super) struct Block {
    pub(super) hessian: Vec<f64>,
    pub(super) defects: Vec<f64>,
    pub(super) local: Vec<f64>,
    /// `d` of the defects.
    penalties: Vec<f64>,
    /// `E`, `N + M T / 2`, `Q`, `Q_uz`, `Q_uu` and `S`.
    e: Vec<f64>,
    y: Vec<f64>,
    q: Vec<f64>,
    side: Vec<f64>,
    uu: Vec<f64>,
    s: Vec<f64>,
}

impl Block {
    pub(super) fn new(sizes: Sizes, local_rows: usize) -> Self {
        let Sizes { n, m, .. } = sizes;
        let (w, all) = (sizes.reduced(), sizes.all());
        let zeros = |length: usize| vec![0.0; length];
        Block {
            hessian: zeros(all * all),
            defects: zeros(n * all),
            local: zeros(local_rows * all),
            penalties: zeros(n),
            e: zeros(n * n),
            y: zeros(n * w),
            q: zeros(w * w),
            side: zeros(m * sizes.kept()),
            uu: zeros(m * m),
            s: zeros(4 * n * n),
        }
    }
}

/// What one interval keeps for the solves that follow a factorisation.
pub(super) struct Interval {
    pub(super) sizes: Sizes,
    pub(super) fixed: Vec<bool>,
    /// Local rows over `(x, u, theta, x+)` and `1 / d` of each.
    pub(super) local: Vec<f64>,
    pub(super) weights: Vec<f64>,
    pub(super) m: Vec<f64>,
    /// `[N; R]`, `2n x w`; only `N` is used unless the defects are penalised.
    pub(super) coupling: Vec<f64>,
    /// `[T; L]`, `2n x w`.
    pub(super) response: Vec<f64>,
    pub(super) e: Lu,
    pub(super) s: SymmetricFactor,
    pub(super) penalised: bool,
    pub(super) uu: SymmetricFactor,
    pub(super) gain: Vec<f64>,
    /// From the backward to the forward pass: `x+` (and multipliers) at `w = 0`, pull on `x+`, `u` at `z = 0`.
    pub(super) offset: Vec<f64>,
    pub(super) pull: Vec<f64>,
    pub(super) feed_forward: Vec<f64>,
}

impl Interval {
    pub(super) fn new(sizes: Sizes, local_rows: usize, fixed: Vec<bool>) -> Self {
        let Sizes { n, m, .. } = sizes;
        let zeros = |length: usize| vec![0.0; length];
        Interval {
            sizes,
            fixed,
            local: zeros(local_rows * sizes.all()),
            weights: zeros(local_rows),
            m: zeros(n * n),
            coupling: zeros(2 * n * sizes.reduced()),
            response: zeros(2 * n * sizes.reduced()),
            e: Lu::new(n),
            s: SymmetricFactor::new(2 * n),
            penalised: false,
            uu: SymmetricFactor::new(m),
            gain: zeros(m * sizes.kept()),
            offset: zeros(2 * n),
            pull: zeros(n),
            feed_forward: zeros(m),
        }
    }

    /// Adds barrier terms and condenses the local rows: `H += J' diag(1/d) J`.
    pub(super) fn add_diagonals(
        &mut self,
        block: &mut Block,
        stages: &Stages,
        k: usize,
        sigma: &[f64],
        d: &[f64],
    ) {
        let (n, m, all) = (self.sizes.n, self.sizes.m, self.sizes.all());
        let start = stages.state(k).start;
        for i in 0..n + m {
            block.hessian[i * all + i] += sigma[start + i];
        }
        block.penalties.copy_from_slice(&d[stages.defects(k)]);
        self.penalised = block.penalties.iter().any(|&penalty| penalty > 0.0);
        self.local.copy_from_slice(&block.local);
        for (i, row) in stages.local(k).enumerate() {
            self.weights[i] = 1.0 / d[row];
            add_outer_product(&mut block.hessian, &self.local[i * all..][..all], self.weights[i]);
        }
    }

    /// Factors the interval. `value` comes in as `V_{k+1}` and leaves as `V_k`. Returns how many negative
    /// eigenvalues there are beyond one per row, or `None` at a zero pivot.
    pub(super) fn factor(&mut self, block: &mut Block, value: &mut [f64]) -> Option<usize> {
        // Common sizes as constants: the compiler unrolls and vectorises their loops.
        match self.sizes {
            Sizes { n: 5, m: 2, q: 1 } => self.factor_sized(Sizes { n: 5, m: 2, q: 1 }, block, value),
            Sizes { n: 2, m: 1, q: 2 } => self.factor_sized(Sizes { n: 2, m: 1, q: 2 }, block, value),
            Sizes { n: 2, m: 1, q: 3 } => self.factor_sized(Sizes { n: 2, m: 1, q: 3 }, block, value),
            Sizes { n: 4, m: 1, q: 3 } => self.factor_sized(Sizes { n: 4, m: 1, q: 3 }, block, value),
            sizes => self.factor_sized(sizes, block, value),
        }
    }

    #[inline(always)]
    fn factor_sized(&mut self, sizes: Sizes, block: &mut Block, value: &mut [f64]) -> Option<usize> {
        self.join_next(sizes, block, value);
        let removed =
            if self.penalised { self.remove_penalised(block)? } else { self.remove_next(sizes, block)? };
        self.reduce(sizes, block);
        self.add_theta(sizes, block, value);
        Some(removed + self.remove_controls(sizes, block, value)?)
    }

    /// `M` and `N`.
    #[inline(always)]
    fn join_next(&mut self, sizes: Sizes, block: &mut Block, value: &[f64]) {
        let Sizes { n, m, q } = sizes;
        let (all, w, kept) = (sizes.all(), sizes.reduced(), sizes.kept());
        for i in 0..n {
            let hessian = &block.hessian[(w + i) * all..][..all];
            let next = &value[i * kept..][..kept];
            for j in 0..n {
                self.m[i * n + j] = hessian[w + j] + next[j];
            }
            let row = &mut self.coupling[i * w..][..w];
            row.copy_from_slice(&hessian[..w]);
            for j in 0..q {
                row[n + m + j] += next[n + j];
            }
        }
    }

    /// `T = -E^-1 R`
    #[inline(always)]
    fn remove_next(&mut self, sizes: Sizes, block: &mut Block) -> Option<usize> {
        let (n, w, all) = (sizes.n, sizes.reduced(), sizes.all());
        for i in 0..n {
            let defect = &block.defects[i * all..][..all];
            for j in 0..w {
                self.response[i * w + j] = -defect[j];
            }
            block.e[i * n..][..n].copy_from_slice(&defect[w..]);
        }
        if !self.e.factor(n, &block.e) {
            return None;
        }
        self.e.solve(n, &mut self.response[..n * w], w);
        Some(0)
    }

    /// `[T; L] = -S^-1 [N; R]`
    fn remove_penalised(&mut self, block: &mut Block) -> Option<usize> {
        let (n, w, all) = (self.sizes.n, self.sizes.reduced(), self.sizes.all());
        block.s.fill(0.0);
        for i in 0..n {
            let defect = &block.defects[i * all..][..all];
            block.s[i * 2 * n..][..n].copy_from_slice(&self.m[i * n..][..n]);
            block.s[(n + i) * 2 * n..][..n].copy_from_slice(&defect[w..]);
            block.s[(n + i) * 2 * n + n + i] = -block.penalties[i];
            self.coupling[(n + i) * w..][..w].copy_from_slice(&defect[..w]);
        }
        let negative = self.s.factor(&block.s)?;
        for (response, coupling) in self.response.iter_mut().zip(&self.coupling) {
            *response = -coupling;
        }
        self.s.solve(&mut self.response, w);
        // A block with too few negative eigenvalues has a wrong sign just as well: count it as one.
        Some(negative.abs_diff(n))
    }

    /// The lower triangle of `Q` without `Theta`; with `Z = N + M T / 2` it is `H_ww + T'Z + Z'T`.
    #[inline(always)]
    fn reduce(&mut self, sizes: Sizes, block: &mut Block) {
        let (n, w, all) = (sizes.n, sizes.reduced(), sizes.all());
        for i in 0..w {
            block.q[i * w..][..w].copy_from_slice(&block.hessian[i * all..][..w]);
        }
        if self.penalised {
            add_transposed_product(&self.coupling, &self.response, &mut block.q, 2 * n, w);
            return;
        }
        let response = &self.response[..n * w];
        block.y.copy_from_slice(&self.coupling[..n * w]);
        add_product(0.5, &self.m, response, &mut block.y, n, w);
        add_symmetric_product(response, &block.y, &mut block.q, n, w);
    }

    #[inline(always)]
    fn add_theta(&self, sizes: Sizes, block: &mut Block, value: &[f64]) {
        let Sizes { n, m, q } = sizes;
        let (w, kept) = (sizes.reduced(), sizes.kept());
        for i in 0..q {
            for j in 0..q {
                block.q[(n + m + i) * w + n + m + j] += value[(n + i) * kept + n + j];
            }
        }
    }

    /// Removes `u_k`; writes `V_k` to `value`.
    #[inline(always)]
    fn remove_controls(&mut self, sizes: Sizes, block: &mut Block, value: &mut [f64]) -> Option<usize> {
        let Sizes { n, m, .. } = sizes;
        let (w, kept) = (sizes.reduced(), sizes.kept());
        let position = |i: usize| if i < n { i } else { i + m };
        self.fix_controls(&mut block.q);
        for i in 0..kept {
            for j in 0..=i {
                let entry = block.q[position(i) * w + position(j)];
                value[i * kept + j] = entry;
                value[j * kept + i] = entry;
            }
        }
        if m == 0 {
            return Some(0);
        }
        for i in 0..m {
            for j in 0..kept {
                // Only the lower triangle of Q is filled.
                let (row, column) = if j < n { (n + i, j) } else { (position(j), n + i) };
                block.side[i * kept + j] = block.q[row * w + column];
                self.gain[i * kept + j] = -block.side[i * kept + j];
            }
            block.uu[i * m..][..m].copy_from_slice(&block.q[(n + i) * w + n..][..m]);
        }
        let negative = self.uu.factor(&block.uu)?;
        self.uu.solve(&mut self.gain, kept);
        add_transposed_product(&block.side, &self.gain, value, m, kept);
        Some(negative)
    }

    fn fix_controls(&self, q: &mut [f64]) {
        let (n, w) = (self.sizes.n, self.sizes.reduced());
        for (i, _) in self.fixed.iter().enumerate().filter(|(_, fixed)| **fixed) {
            for j in 0..w {
                q[(n + i) * w + j] = 0.0;
                q[j * w + n + i] = 0.0;
            }
            q[(n + i) * w + n + i] = 1.0;
        }
    }
}
