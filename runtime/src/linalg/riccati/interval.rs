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
    /// `E`, `M T + N`, `Q`, `Q_uu` and `S`.
    e: Vec<f64>,
    y: Vec<f64>,
    q: Vec<f64>,
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
            uu: zeros(m * m),
            s: zeros(4 * n * n),
        }
    }
}

/// What one interval keeps for the solves that follow a factorisation.
pub(super) struct Interval {
    sizes: Sizes,
    fixed: Vec<bool>,
    /// Local rows over `(x, u, theta, x+)` and `1 / d` of each.
    local: Vec<f64>,
    weights: Vec<f64>,
    m: Vec<f64>,
    /// `[N; R]`, `2n x w`; only `N` is used unless the defects are penalised.
    coupling: Vec<f64>,
    /// `[T; L]`, `2n x w`.
    response: Vec<f64>,
    e: Lu,
    s: SymmetricFactor,
    penalised: bool,
    uu: SymmetricFactor,
    gain: Vec<f64>,
    /// From the backward to the forward pass: `x+` (and multipliers) at `w = 0`, pull on `x+`, `u` at `z = 0`.
    offset: Vec<f64>,
    pull: Vec<f64>,
    feed_forward: Vec<f64>,
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
    pub(super) fn add_diagonals(&mut self, block: &mut Block, stages: &Stages, k: usize, sigma: &[f64], d: &[f64]) {
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
        let Sizes { n, m, q } = self.sizes;
        self.join_next(block, value);
        let removed = if self.penalised { self.remove_penalised(block)? } else { self.remove_next(block)? };
        // The common sizes as constants: the compiler unrolls their loops.
        match (n, m, q) {
            (5, 2, 1) => self.reduce(block, 5, 2, 1),
            (2, 1, 1) => self.reduce(block, 2, 1, 1),
            (2, 1, 2) => self.reduce(block, 2, 1, 2),
            (2, 1, 3) => self.reduce(block, 2, 1, 3),
            (4, 1, 3) => self.reduce(block, 4, 1, 3),
            _ => self.reduce(block, n, m, q),
        }
        self.add_theta(block, value);
        Some(removed + self.remove_controls(block, value)?)
    }

    /// `M` and `N`.
    fn join_next(&mut self, block: &mut Block, value: &[f64]) {
        let (n, m, all, w, kept) =
            (self.sizes.n, self.sizes.m, self.sizes.all(), self.sizes.reduced(), self.sizes.kept());
        for i in 0..n {
            let hessian = &block.hessian[(w + i) * all..][..all];
            let next = &value[i * kept..][..kept];
            for j in 0..n {
                self.m[i * n + j] = hessian[w + j] + next[j];
            }
            let row = &mut self.coupling[i * w..][..w];
            row.copy_from_slice(&hessian[..w]);
            for j in 0..self.sizes.q {
                row[n + m + j] += next[n + j];
            }
        }
    }

    /// `T = -E^-1 R`
    fn remove_next(&mut self, block: &mut Block) -> Option<usize> {
        let (n, w, all) = (self.sizes.n, self.sizes.reduced(), self.sizes.all());
        for i in 0..n {
            let defect = &block.defects[i * all..][..all];
            for j in 0..w {
                self.response[i * w + j] = -defect[j];
            }
            block.e[i * n..][..n].copy_from_slice(&defect[w..]);
        }
        if !self.e.factor(&block.e) {
            return None;
        }
        self.e.solve(&mut self.response[..n * w], w);
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

    /// `Q` without `Theta`.
    #[inline(always)]
    fn reduce(&mut self, block: &mut Block, n: usize, m: usize, q: usize) {
        let w = n + m + q;
        for i in 0..w {
            block.q[i * w..][..w].copy_from_slice(&block.hessian[i * (w + n)..][..w]);
        }
        if self.penalised {
            transposed_product_add(&self.coupling, &self.response, &mut block.q, 2 * n, w);
            return;
        }
        block.y[..n * w].copy_from_slice(&self.coupling[..n * w]);
        for i in 0..n {
            for l in 0..n {
                let factor = self.m[i * n + l];
                for j in 0..w {
                    block.y[i * w + j] += factor * self.response[l * w + j];
                }
            }
        }
        transposed_product_add(&self.response[..n * w], &block.y[..n * w], &mut block.q, n, w);
        transposed_product_add(&self.coupling[..n * w], &self.response[..n * w], &mut block.q, n, w);
    }

    fn add_theta(&self, block: &mut Block, value: &[f64]) {
        let (n, m, w, kept) = (self.sizes.n, self.sizes.m, self.sizes.reduced(), self.sizes.kept());
        for i in 0..self.sizes.q {
            for j in 0..self.sizes.q {
                block.q[(n + m + i) * w + n + m + j] += value[(n + i) * kept + n + j];
            }
        }
    }

    /// Removes `u_k`; writes `V_k` to `value`.
    fn remove_controls(&mut self, block: &mut Block, value: &mut [f64]) -> Option<usize> {
        let (m, w, kept) = (self.sizes.m, self.sizes.reduced(), self.sizes.kept());
        self.fix_controls(&mut block.q);
        for i in 0..kept {
            let row = &block.q[self.position(i) * w..][..w];
            for j in 0..kept {
                value[i * kept + j] = row[self.position(j)];
            }
        }
        if m == 0 {
            return Some(0);
        }
        let n = self.sizes.n;
        for i in 0..m {
            let row = &block.q[(n + i) * w..][..w];
            block.uu[i * m..][..m].copy_from_slice(&row[n..n + m]);
            for j in 0..kept {
                self.gain[i * kept + j] = -row[self.position(j)];
            }
        }
        let negative = self.uu.factor(&block.uu)?;
        self.uu.solve(&mut self.gain, kept);
        for i in 0..kept {
            for l in 0..m {
                let factor = block.q[self.position(i) * w + n + l];
                for j in 0..kept {
                    value[i * kept + j] += factor * self.gain[l * kept + j];
                }
            }
        }
        Some(negative)
    }

    /// Position in `w` of entry `i` of `z = (x, theta)`.
    #[inline(always)]
    fn position(&self, i: usize) -> usize {
        if i < self.sizes.n { i } else { i + self.sizes.m }
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

    /// Backward pass of a solve: `gradient` is that of `V_{k+1}` and becomes that of `V_k`.
    pub(super) fn backward(&mut self, stages: &Stages, k: usize, a: &[f64], b: &[f64], gradient: &mut [f64]) {
        let (n, m, w) = (self.sizes.n, self.sizes.m, self.sizes.reduced());
        let mut g = vec![0.0; self.sizes.all()];
        self.local_gradient(&b[stages.local(k)], &mut g);
        for (i, index) in (stages.state(k).start..stages.control(k).end).enumerate() {
            g[i] -= a[index];
        }
        for i in 0..n {
            self.pull[i] = gradient[i] + g[w + i];
        }
        for i in 0..self.sizes.q {
            g[n + m + i] += gradient[n + i];
        }
        self.eliminate_next(&b[stages.defects(k)], &mut g);
        self.eliminate_controls(&mut g, gradient);
    }

    /// Local rows: `g -= J' diag(1/d) b`
    fn local_gradient(&self, b: &[f64], g: &mut [f64]) {
        let all = self.sizes.all();
        for (i, value) in b.iter().enumerate() {
            let factor = -self.weights[i] * value;
            for j in 0..all {
                g[j] += factor * self.local[i * all + j];
            }
        }
    }

    fn eliminate_next(&mut self, b: &[f64], g: &mut [f64]) {
        let (n, w) = (self.sizes.n, self.sizes.reduced());
        if self.penalised {
            for i in 0..n {
                self.offset[i] = -self.pull[i];
                self.offset[n + i] = b[i];
            }
            self.s.solve(&mut self.offset, 1);
            for i in 0..2 * n {
                add_scaled(g, &self.coupling[i * w..][..w], self.offset[i]);
            }
            return;
        }
        self.offset[..n].copy_from_slice(b);
        self.e.solve(&mut self.offset[..n], 1);
        for i in 0..n {
            let m_row = &self.m[i * n..][..n];
            let y = self.pull[i] + dot(m_row, &self.offset[..n]);
            add_scaled(g, &self.response[i * w..][..w], y);
            add_scaled(g, &self.coupling[i * w..][..w], self.offset[i]);
        }
    }

    fn eliminate_controls(&mut self, g: &mut [f64], gradient: &mut [f64]) {
        let (n, m, kept) = (self.sizes.n, self.sizes.m, self.sizes.kept());
        for i in 0..m {
            if self.fixed[i] {
                g[n + i] = 0.0;
            }
            self.feed_forward[i] = -g[n + i];
        }
        for i in 0..kept {
            gradient[i] = g[self.position(i)];
        }
        for i in 0..m {
            add_scaled(gradient, &self.gain[i * kept..][..kept], g[n + i]);
        }
        self.uu.solve(&mut self.feed_forward, 1);
    }

    /// Forward pass of a solve: `x` is `x_k` and becomes `x_{k+1}`.
    pub(super) fn forward(
        &mut self,
        stages: &Stages,
        k: usize,
        a: &mut [f64],
        b: &mut [f64],
        x: &mut [f64],
        theta: &[f64],
    ) {
        let (n, m, q, w, kept) =
            (self.sizes.n, self.sizes.m, self.sizes.q, self.sizes.reduced(), self.sizes.kept());
        let mut all = vec![0.0; self.sizes.all()];
        all[..n].copy_from_slice(x);
        all[n + m..n + m + q].copy_from_slice(theta);
        for i in 0..m {
            let gain = &self.gain[i * kept..][..kept];
            all[n + i] = self.feed_forward[i] + dot(&gain[..n], x) + dot(&gain[n..], theta);
        }
        for i in 0..n {
            all[w + i] = self.offset[i] + dot(&self.response[i * w..][..w], &all[..w]);
        }
        a[stages.state(k).start..stages.control(k).end].copy_from_slice(&all[..n + m]);
        self.defect_multipliers(&all, &mut b[stages.defects(k)]);
        for (i, row) in stages.local(k).enumerate() {
            let width = all.len();
            b[row] = self.weights[i] * (dot(&self.local[i * width..][..width], &all) - b[row]);
        }
        x.copy_from_slice(&all[w..]);
    }

    fn defect_multipliers(&self, all: &[f64], multipliers: &mut [f64]) {
        let (n, w) = (self.sizes.n, self.sizes.reduced());
        for i in 0..n {
            multipliers[i] = if self.penalised {
                self.offset[n + i] + dot(&self.response[(n + i) * w..][..w], &all[..w])
            } else {
                let from_next = dot(&self.m[i * n..][..n], &all[w..]);
                -(self.pull[i] + from_next + dot(&self.coupling[i * w..][..w], &all[..w]))
            };
        }
        if !self.penalised {
            self.e.solve_transposed(multipliers);
        }
    }
}

#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[inline(always)]
fn add_scaled(target: &mut [f64], source: &[f64], factor: f64) {
    for (t, s) in target.iter_mut().zip(source) {
        *t += factor * s;
    }
}

/// `H += factor * row' row`
fn add_outer_product(hessian: &mut [f64], row: &[f64], factor: f64) {
    let width = row.len();
    for (i, value) in row.iter().enumerate().filter(|(_, value)| **value != 0.0) {
        add_scaled(&mut hessian[i * width..][..width], row, factor * value);
    }
}

/// `Q += A' B` with `rows x w` matrices.
#[inline(always)]
fn transposed_product_add(a: &[f64], b: &[f64], q: &mut [f64], rows: usize, w: usize) {
    for l in 0..rows {
        let b_row = &b[l * w..l * w + w];
        for i in 0..w {
            let factor = a[l * w + i];
            let q_row = &mut q[i * w..i * w + w];
            for j in 0..w {
                q_row[j] += factor * b_row[j];
            }
        }
    }
}
