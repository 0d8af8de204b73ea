//! One step of the recursion.
//!
//! With `z = (x, theta)`, `w = (z, u)`, defects `R w + E x+ - D lambda = b`, next value function
//! `V+ = (P, Lambda, Theta)` and `pull`, the gradient by `x+` that a right side brings, the next
//! state and the multipliers are removed together (inner variables with them: `x+` stands for `(y,
//! x+)` here, of which `V+` sees only the second part):
//!
//! ```text
//!     N = H_{+w} + [0 Lambda' 0]       M = H_{++} + P
//!     T = -E^-1 R       F = E^-1       c = F b       p = pull + M c
//!
//!     x+ = T w + c       lambda = -F' (M x+ + N w + pull)       gradient by w:  g_w + T' p + N' c
//!
//!     Q = H_ww + Theta + N' T + T' (N + M T)
//!     gain = -Q_uu^-1 Q_uz,     V = Q_zz + Q_zu gain       z = (x, theta)
//! ```
//!
//! All of `Q` but `W' V+ W`, where `(x+, theta) = W w`, is there before `V+` is known:
//! [`super::condense`]. Rows with a penalty give way: [`super::compliance`].

use super::compliance::Compliance;
use super::factors::Factors;
use super::kernels::{Product, Signed, View, add_product, invert_positive, lower_end};
use super::sizes::Sizes;
use super::value::Value;
use crate::linalg::dense::symmetric::SymmetricFactor;

/// `V W`, where `W = [T; 0 I 0]`.
struct Pushed<'a> {
    sizes: Sizes,
    value: &'a Value,
    t: &'a [f64],
    units: &'a [f64],
}

impl Product for Pushed<'_> {
    #[inline(always)]
    fn inner(&self) -> usize {
        self.sizes.kept()
    }
    #[inline(always)]
    fn left(&self, i: usize, l: usize) -> f64 {
        self.value.at(self.sizes, i, l)
    }
    #[inline(always)]
    fn right(&self, l: usize) -> &[f64] {
        match l.checked_sub(self.sizes.n) {
            None => &self.t[l * self.sizes.all()..],
            Some(l) => &self.units[l * self.sizes.reduced()..],
        }
    }
}

/// Working memory of one step.
pub(super) struct Block {
    /// `[0 I 0]` and `V W`
    units: Vec<f64>,
    pushed: Vec<f64>,
    /// `Q_uu^-1` and `-Q_uu^-1 Q_uw`
    inverse: Vec<f64>,
    gain: Vec<f64>,
    uu_factor: SymmetricFactor,
    compliance: Compliance,
}

impl Block {
    pub(super) fn new(sizes: Sizes) -> Self {
        let (m, w) = (sizes.m, sizes.reduced());
        let zeros = |length: usize| vec![0.0; length];
        let mut units = zeros(sizes.q * w);
        (0..sizes.q).for_each(|i| units[i * w + sizes.n + i] = 1.0);
        Block {
            units,
            pushed: zeros(sizes.kept() * w),
            gain: zeros(m * w),
            inverse: zeros(m * m),
            uu_factor: SymmetricFactor::new(m),
            compliance: Compliance::new(sizes),
        }
    }

    /// Factors interval `k`, of which `q` and the response are there without `V+`. `value` comes in
    /// as `V+` and leaves as `V`; `penalties` are `D`, empty where there are none. Returns how many
    /// negative eigenvalues there are beyond one per row, or `None` at a zero pivot.
    #[inline(always)]
    pub(super) fn factor<const FUSED: bool>(
        &mut self,
        sizes: Sizes,
        q: &mut [f64],
        factors: &mut Factors,
        (k, fixed, penalties): (usize, &[bool], &[f64]),
        value: &mut Value,
    ) -> Option<usize> {
        // Slices of known lengths need no checks of their indices.
        let q = &mut q[..sizes.reduced() * sizes.reduced()];
        let removed = if penalties.is_empty() {
            self.add_next::<FUSED>(sizes, factors.response(sizes, k), value, q);
            join_next(sizes, factors.response_mut(sizes, k), value);
            0
        } else {
            join_next(sizes, factors.response_mut(sizes, k), value);
            add_theta(sizes, value, q);
            self.compliance.give_way(sizes, q, factors, (k, penalties))?
        };
        fix_controls(sizes, fixed, q);
        Some(removed + self.remove_controls::<FUSED>(sizes, q, factors, (k, value))?)
    }

    /// `Q += W' V W`: the lower triangle, and all of `Q_uu`.
    #[inline(always)]
    fn add_next<const FUSED: bool>(
        &mut self,
        sizes: Sizes,
        response: &[f64],
        value: &Value,
        q: &mut [f64],
    ) {
        let (n, w, kept, all) = (sizes.n, sizes.reduced(), sizes.kept(), sizes.all());
        let (t, units) = (&response[sizes.inner * all..][..n * all], &self.units[..sizes.q * w]);
        let pushed = &mut self.pushed[..kept * w];
        pushed.fill(0.0);
        add_product::<FUSED, false>(&Pushed { sizes, value, t, units }, 0..kept, (&mut *pushed, w));
        let a = View::rows(t, all).transposed();
        let product = Signed { sign: 1.0, a, b: View::rows(&*pushed, w), inner: n };
        // All waits for the controls.
        add_product::<FUSED, false>(&product, kept..w, (&mut *q, w));
        add_product::<FUSED, true>(&product, 0..kept, (&mut *q, w));
        for i in n..kept {
            for (sum, value) in q[i * w..][..lower_end(i, w)].iter_mut().zip(&pushed[i * w..]) {
                *sum += value;
            }
        }
    }

    /// Removes `u_k`; writes `V_k` to `value`.
    #[inline(always)]
    fn remove_controls<const FUSED: bool>(
        &mut self,
        sizes: Sizes,
        q: &[f64],
        factors: &mut Factors,
        (k, value): (usize, &mut Value),
    ) -> Option<usize> {
        let (m, w, kept) = (sizes.m, sizes.reduced(), sizes.kept());
        let side = &q[kept * w..][..m * w];
        let negative = self.invert_controls::<FUSED>(sizes, side)?;
        let (inverse, gain) = factors.controls_mut(sizes, k);
        inverse.copy_from_slice(&self.inverse[..m * m]);
        let wide = &mut self.gain[..m * w];
        wide.fill(0.0);
        let side = View::rows(side, w);
        let product = Signed { sign: -1.0, a: View::rows(&self.inverse, m), b: side, inner: m };
        add_product::<FUSED, false>(&product, 0..m, (&mut *wide, w));
        value.rows[..kept * w].copy_from_slice(&q[..kept * w]);
        let product =
            Signed { sign: 1.0, a: side.transposed(), b: View::rows(&*wide, w), inner: m };
        add_product::<FUSED, true>(&product, 0..kept, (&mut value.rows[..kept * w], w));
        for j in 0..m {
            gain[j * kept..][..kept].copy_from_slice(&wide[j * w..][..kept]);
        }
        Some(negative)
    }

    /// Inverts `Q_uu`, which is in `side`, and counts its negative eigenvalues. Near a solution it
    /// is positive definite.
    #[inline(always)]
    fn invert_controls<const FUSED: bool>(&mut self, sizes: Sizes, side: &[f64]) -> Option<usize> {
        let (m, w, kept) = (sizes.m, sizes.reduced(), sizes.kept());
        let inverse = &mut self.inverse[..m * m];
        for i in 0..m {
            inverse[i * m..][..m].copy_from_slice(&side[i * w + kept..][..m]);
        }
        if invert_positive::<FUSED>(m, inverse) {
            Some(0)
        } else {
            self.invert_indefinite(m, &side[kept..])
        }
    }

    /// The same for the first `m` columns of `m` rows.
    #[cold]
    fn invert_indefinite(&mut self, m: usize, rows: &[f64]) -> Option<usize> {
        let length = self.gain.len() / m;
        for i in 0..m {
            self.inverse[i * m..][..m].copy_from_slice(&rows[i * length..][..m]);
        }
        let negative = self.uu_factor.factor(&self.inverse)?;
        self.inverse.fill(0.0);
        (0..m).for_each(|i| self.inverse[i * m + i] = 1.0);
        self.uu_factor.solve(&mut self.inverse, m);
        Some(negative)
    }
}

/// `Q += Theta`
fn add_theta(sizes: Sizes, value: &Value, q: &mut [f64]) {
    for i in sizes.n..sizes.kept() {
        for j in sizes.n..=i {
            q[i * sizes.reduced() + j] += value.at(sizes, i, j);
        }
    }
}

/// `M` and `N` with what `V+` adds to them.
#[inline(always)]
fn join_next(sizes: Sizes, response: &mut [f64], value: &Value) {
    let Sizes { n, inner, .. } = sizes;
    let (w, all) = (sizes.reduced(), sizes.all());
    for i in 0..n {
        let row = &mut response[(sizes.next() + inner + i) * all..][..all];
        for j in n..sizes.kept() {
            row[j] += value.at(sizes, i, j);
        }
        for j in 0..n {
            row[w + inner + j] += value.at(sizes, i, j);
        }
    }
}

/// Takes fixed controls out of the lower triangle of `Q`.
#[inline(always)]
fn fix_controls(sizes: Sizes, fixed: &[bool], q: &mut [f64]) {
    let (kept, w) = (sizes.kept(), sizes.reduced());
    for i in (0..sizes.m).filter(|i| fixed[*i]).map(|i| kept + i) {
        for j in 0..w {
            q[i * w + j] = 0.0;
            q[j * w + i] = 0.0;
        }
        q[i * w + i] = 1.0;
    }
}
