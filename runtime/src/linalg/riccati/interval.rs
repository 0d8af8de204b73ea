//! One step of the recursion.
//!
//! With `w = (x, u, theta)`, defects `R w + E x+ - D lambda = b`, next value function `V+ = (P, Lambda, Theta)` and
//! `pull`, the gradient by `x+` that a right side brings, the next state and the multipliers are removed together
//! (inner variables with them: `x+` stands for `(y, x+)` here, of which `V+` sees only the second part):
//!
//! ```text
//!     M = H_{++} + P      N = H_{+w} + [0 0 Lambda']       S = [ M  E' ]    S^-1 = [ A  F ]
//!                                                              [ E  -D ]           [ F' C ]
//!     [ x+     ] = S^-1 [ -N w - pull ] = [ T  F ] [ w ] - [ A  ] pull
//!     [ lambda ]        [  b - R w    ]   [ L  C ] [ b ]   [ F' ]
//!
//!     Q = H_ww + Theta + [N; R]' [T; L]
//!     gain = -Q_uu^-1 Q_uz,     V = Q_zz + Q_zu gain       z = (x, theta)
//! ```
//!
//! Rows without penalty (`D = 0`, always but in restoration) need nothing of twice the size:
//!
//! ```text
//!     [T F] = E^-1 [-R I]       [L C] = -F' ([N 0] + M [T F])       A = 0
//! ```

use super::factors::Factors;
use super::kernels::{View, add_lower_product, add_product, divide, invert_positive};
use crate::linalg::SymmetricFactor;

/// Sizes of states, controls, inner variables and border.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    pub(super) n: usize,
    pub(super) m: usize,
    pub(super) inner: usize,
    pub(super) q: usize,
}

impl Sizes {
    /// `(x, u, theta)`
    #[inline(always)]
    pub(super) fn reduced(&self) -> usize {
        self.n + self.m + self.q
    }
    /// `(y, x+)`
    #[inline(always)]
    pub(super) fn next(&self) -> usize {
        self.inner + self.n
    }
    /// `(x, u, theta, y, x+)`, and also `(x, u, theta, b)`
    #[inline(always)]
    pub(super) fn all(&self) -> usize {
        self.reduced() + self.next()
    }
    /// `(x, theta)`
    #[inline(always)]
    pub(super) fn kept(&self) -> usize {
        self.n + self.q
    }
    /// Where entry `i` of `(x, theta)` stands in `(x, u, theta)`.
    #[inline(always)]
    pub(super) fn position(&self, i: usize) -> usize {
        if i < self.n { i } else { i + self.m }
    }
    /// Lengths of `H_ww`, `[N; R]`, `M` and `E`, the parts of what is gathered.
    #[inline(always)]
    fn parts(&self) -> [usize; 4] {
        let (next, w) = (self.next(), self.reduced());
        [w * w, 2 * next * w, next * next, next * next]
    }
    /// Length of what is gathered for an interval.
    #[inline(always)]
    pub(super) fn gathered(&self) -> usize {
        self.parts().iter().sum()
    }
    /// Where the Hessian entry of two positions in `(x, u, theta, y, x+)` is gathered: lower triangles only.
    pub(super) fn hessian_place(&self, a: usize, b: usize) -> usize {
        let ([square, coupling, ..], w) = (self.parts(), self.reduced());
        let (row, column) = (a.max(b), a.min(b));
        match (row.checked_sub(w), column.checked_sub(w)) {
            (None, _) => row * w + column,
            (Some(row), None) => square + row * w + column,
            (Some(row), Some(column)) => square + coupling + row * self.next() + column,
        }
    }
    /// Where an entry of a defect is gathered.
    pub(super) fn defect_place(&self, row: usize, position: usize) -> usize {
        let ([square, coupling, curvature, _], w) = (self.parts(), self.reduced());
        match position.checked_sub(w) {
            None => square + (self.next() + row) * w + position,
            Some(column) => square + coupling + curvature + row * self.next() + column,
        }
    }
    /// Where the curvature of entry `i` of `(y, x+)` is gathered.
    #[inline(always)]
    pub(super) fn next_diagonal(&self, i: usize) -> usize {
        let [square, coupling, ..] = self.parts();
        square + coupling + i * (self.next() + 1)
    }
}

/// Working memory of one step.
pub(super) struct Block {
    /// `[N 0] + M [T F]`
    costate: Vec<f64>,
    /// `Q_uz`, and `Q_uu` twice.
    side: Vec<f64>,
    uu: Vec<f64>,
    uu_copy: Vec<f64>,
    uu_factor: SymmetricFactor,
    /// `S` and its factors.
    s: Vec<f64>,
    s_factor: SymmetricFactor,
}

impl Block {
    pub(super) fn new(sizes: Sizes) -> Self {
        let (m, next) = (sizes.m, sizes.next());
        let zeros = |length: usize| vec![0.0; length];
        Block {
            costate: zeros(next * sizes.all()),
            side: zeros(m * sizes.kept()),
            uu: zeros(m * m),
            uu_copy: zeros(m * m),
            uu_factor: SymmetricFactor::new(m),
            s: zeros(4 * next * next),
            s_factor: SymmetricFactor::new(2 * next),
        }
    }

    /// Factors what was gathered for interval `k`: `H_ww`, `[N; R]`, `M` and `E`, which are destroyed. `value` comes in as `V_{k+1}` and leaves as `V_k`; `penalties` are
    /// `D`, empty where there are none. Returns how many negative eigenvalues there are beyond one per row, or `None` at
    /// a zero pivot.
    #[inline(always)]
    pub(super) fn factor<const FUSED: bool>(
        &mut self,
        sizes: Sizes,
        gathered: &mut [f64],
        factors: &mut Factors,
        (k, fixed, penalties): (usize, &[bool], &[f64]),
        value: &mut [f64],
    ) -> Option<usize> {
        // Slices of known lengths need no checks of their indices.
        let value = &mut value[..sizes.kept() * sizes.kept()];
        join_next(sizes, gathered, value);
        let removed = if penalties.is_empty() {
            self.remove_next::<FUSED>(sizes, gathered, factors.response_mut(sizes, k))?
        } else {
            self.remove_penalised(sizes, gathered, factors, (k, penalties))?
        };
        let (w, all) = (sizes.reduced(), sizes.all());
        let [q, coupling, ..] = parts(sizes, gathered);
        let (coupling, response) = (View::rows(coupling, w), View::rows(factors.response(sizes, k), all));
        add_lower_product::<FUSED>(coupling.transposed(), response, 2 * sizes.next(), (q, w));
        fix_controls(sizes, fixed, q);
        Some(removed + self.remove_controls::<FUSED>(sizes, &gathered[..w * w], factors, (k, value))?)
    }

    /// `[T F]` and `[L C]`.
    #[inline(always)]
    fn remove_next<const FUSED: bool>(
        &mut self,
        sizes: Sizes,
        gathered: &mut [f64],
        response: &mut [f64],
    ) -> Option<usize> {
        let (n, w, all) = (sizes.next(), sizes.reduced(), sizes.all());
        let [_, coupling, m, e] = parts(sizes, gathered);
        let costate = &mut self.costate[..n * all];
        let (next, multipliers) = response.split_at_mut(n * all);
        for i in 0..n {
            let (rows, values) = (&mut next[i * all..][..all], &coupling[(n + i) * w..][..w]);
            for j in 0..w {
                rows[j] = -values[j];
            }
            rows[w..].fill(0.0);
            rows[w + i] = 1.0;
            costate[i * all..][..w].copy_from_slice(&coupling[i * w..][..w]);
            costate[i * all + w..][..n].fill(0.0);
        }
        let regular = divide::<FUSED>(n, e, next, all);
        add_product::<FUSED>(1.0, View::rows(m, n), View::rows(next, all), n, (costate, all));
        multipliers.fill(0.0);
        let f = View { values: &next[w..], row: all, column: 1 };
        add_product::<FUSED>(-1.0, f.transposed(), View::rows(costate, all), n, (multipliers, all));
        regular.then_some(0)
    }

    /// The same, and `A`, by the factors of `S`.
    fn remove_penalised(
        &mut self,
        sizes: Sizes,
        gathered: &mut [f64],
        factors: &mut Factors,
        (k, penalties): (usize, &[f64]),
    ) -> Option<usize> {
        let (n, w, all) = (sizes.next(), sizes.reduced(), sizes.all());
        let [_, coupling, m, e] = parts(sizes, gathered);
        let s = &mut self.s;
        s.fill(0.0);
        for i in 0..n {
            s[i * 2 * n..][..n].copy_from_slice(&m[i * n..][..n]);
            s[(n + i) * 2 * n..][..n].copy_from_slice(&e[i * n..][..n]);
            s[(n + i) * 2 * n + n + i] = -penalties[i];
        }
        let response = factors.response_mut(sizes, k);
        response.fill(0.0);
        for i in 0..2 * n {
            for j in 0..w {
                response[i * all + j] = -coupling[i * w + j];
            }
        }
        for i in 0..n {
            response[(n + i) * all + w + i] = 1.0;
        }
        let negative = self.s_factor.factor(s)?;
        self.s_factor.solve(response, all);
        // [A; F'] = S^-1 [I; 0]
        let half = &mut s[..2 * n * n];
        half.fill(0.0);
        (0..n).for_each(|i| half[i * n + i] = 1.0);
        self.s_factor.solve(half, n);
        factors.keep_compliance(n, k, &half[..n * n]);
        // A block with too few negative eigenvalues has a wrong sign just as well: count it as one.
        Some(negative.abs_diff(n))
    }

    /// Removes `u_k`; writes `V_k` to `value`.
    #[inline(always)]
    fn remove_controls<const FUSED: bool>(
        &mut self,
        sizes: Sizes,
        q: &[f64],
        factors: &mut Factors,
        (k, value): (usize, &mut [f64]),
    ) -> Option<usize> {
        let Sizes { n, m, .. } = sizes;
        let (w, kept) = (sizes.reduced(), sizes.kept());
        let (side, uu) = (&mut self.side[..m * kept], &mut self.uu[..m * m]);
        for i in 0..kept {
            for j in 0..=i {
                value[i * kept + j] = q[sizes.position(i) * w + sizes.position(j)];
            }
        }
        for i in 0..m {
            for j in 0..kept {
                // Only the lower triangle of Q is filled.
                let (row, column) = if j < n { (n + i, j) } else { (j + m, n + i) };
                side[i * kept + j] = q[row * w + column];
            }
            for j in 0..=i {
                uu[i * m + j] = q[(n + i) * w + n + j];
                uu[j * m + i] = q[(n + i) * w + n + j];
            }
        }
        let negative = self.invert_controls::<FUSED>(m)?;
        let (inverse, gain) = factors.controls_mut(sizes, k);
        inverse.copy_from_slice(&self.uu[..m * m]);
        gain.fill(0.0);
        let side = View::rows(&self.side[..m * kept], kept);
        add_product::<FUSED>(-1.0, View::rows(inverse, m), side, m, (gain, kept));
        add_lower_product::<FUSED>(side.transposed(), View::rows(gain, kept), m, (value, kept));
        for i in 0..kept {
            for j in 0..i {
                value[j * kept + i] = value[i * kept + j];
            }
        }
        Some(negative)
    }

    /// Inverts `Q_uu` and counts its negative eigenvalues. Near a solution it is positive definite.
    #[inline(always)]
    fn invert_controls<const FUSED: bool>(&mut self, m: usize) -> Option<usize> {
        let uu = &mut self.uu[..m * m];
        self.uu_copy.copy_from_slice(uu);
        if invert_positive::<FUSED>(m, uu) { Some(0) } else { self.invert_indefinite(m) }
    }

    #[cold]
    fn invert_indefinite(&mut self, m: usize) -> Option<usize> {
        let negative = self.uu_factor.factor(&self.uu_copy)?;
        self.uu.fill(0.0);
        (0..m).for_each(|i| self.uu[i * m + i] = 1.0);
        self.uu_factor.solve(&mut self.uu, m);
        Some(negative)
    }
}

/// `M`, `N`, and `Theta` added to `H_ww`.
#[inline(always)]
fn join_next(sizes: Sizes, gathered: &mut [f64], value: &[f64]) {
    let Sizes { n, m, inner, q } = sizes;
    let (w, kept, size) = (sizes.reduced(), sizes.kept(), sizes.next());
    let [h, coupling, next, _] = parts(sizes, gathered);
    for i in 0..n {
        let value = &value[i * kept..][..kept];
        let row = inner + i;
        for j in 0..=i {
            next[row * size + inner + j] += value[j];
        }
        for j in 0..q {
            coupling[row * w + n + m + j] += value[n + j];
        }
    }
    for i in 0..size {
        for j in 0..i {
            next[j * size + i] = next[i * size + j];
        }
    }
    for i in 0..q {
        for j in 0..=i {
            h[(n + m + i) * w + n + m + j] += value[(n + i) * kept + n + j];
        }
    }
}

/// `H_ww`, `[N; R]`, `M` and `E`.
#[inline(always)]
fn parts(sizes: Sizes, gathered: &mut [f64]) -> [&mut [f64]; 4] {
    let [square, coupling, next, last] = sizes.parts();
    let (h, rest) = gathered.split_at_mut(square);
    let (coupling, rest) = rest.split_at_mut(coupling);
    let (m, e) = rest.split_at_mut(next);
    [h, coupling, m, &mut e[..last]]
}

/// Takes fixed controls out of the lower triangle of `Q`.
#[inline(always)]
fn fix_controls(sizes: Sizes, fixed: &[bool], q: &mut [f64]) {
    let (n, w) = (sizes.n, sizes.reduced());
    for i in (0..sizes.m).filter(|i| fixed[*i]) {
        for j in 0..w {
            q[(n + i) * w + j] = 0.0;
            q[j * w + n + i] = 0.0;
        }
        q[(n + i) * w + n + i] = 1.0;
    }
}
