//! One step of the recursion.
//!
//! With `w = (x, u, theta)`, defects `R w + E x+ - D lambda = b`, next value function `V+ = (P, Lambda, Theta)` and
//! `pull`, the gradient by `x+` that a right side brings, the next state and the multipliers are removed together
//! (inner variables with them: `x+` stands for `(y, x+)` here, of which `V+` sees only the second part):
//!
//! ```text
//!     N = H_{+w} + [0 0 Lambda']       M = H_{++} + P       c = F b       p = pull + M c       T = -E^-1 R       F = E^-1
//!
//!     x+ = T w + c       lambda = -F' (M x+ + N w + pull)       gradient by w:  g_w + T' p + N' c
//!
//!     Q = H_ww + Theta + N' T + T' (N + M T)
//!     gain = -Q_uu^-1 Q_uz,     V = Q_zz + Q_zu gain       z = (x, theta)
//! ```
//!
//! All of `Q` but `W' V+ W`, where `(x+, theta) = W w`, is there before `V+` is known: [`super::condense`].
//!
//! Rows with a penalty `D` (in restoration) let `x+` give way, each as much as it likes, so that they are not divided by `E` beforehand:
//!
//! ```text
//!     [ M  E' ] [ T F A ]   [ -N 0 I ]        [ x+     ]   [ T F ] [ w ]   [ A  ]
//!     [ E  -D ] [ L C . ] = [ -R I 0 ]        [ lambda ] = [ L C ] [ b ] - [ F' ] pull        Q = H_ww + Theta + [N; R]' [T; L]
//! ```

use super::factors::Factors;
use super::kernels::{View, add_lower_product, add_product, add_row_product, invert_positive, lower_end};
use super::sizes::Sizes;
use crate::linalg::SymmetricFactor;

/// Working memory of one step.
pub(super) struct Block {
    /// `[0 0 I]` and `V W`
    units: Vec<f64>,
    pushed: Vec<f64>,
    /// `Q_uw`, `Q_uu^-1` and their product.
    side: Vec<f64>,
    inverse: Vec<f64>,
    gain: Vec<f64>,
    uu_factor: SymmetricFactor,
    compliance: Compliance,
}

/// Working memory where rows are penalised.
struct Compliance {
    /// `[M E'; E -D]`
    s: Vec<f64>,
    s_factor: SymmetricFactor,
    /// `[-N 0 I; -R I 0]`, then `[T F A; L C .]`
    sides: Vec<f64>,
}

impl Block {
    pub(super) fn new(sizes: Sizes) -> Self {
        let (m, w, next) = (sizes.m, sizes.reduced(), sizes.next());
        let zeros = |length: usize| vec![0.0; length];
        let mut units = zeros(sizes.q * w);
        (0..sizes.q).for_each(|i| units[i * w + sizes.n + m + i] = 1.0);
        Block {
            units,
            pushed: zeros(sizes.kept() * w),
            side: zeros(m * w),
            gain: zeros(m * w),
            inverse: zeros(m * m),
            uu_factor: SymmetricFactor::new(m),
            compliance: Compliance {
                s: zeros(4 * next * next),
                s_factor: SymmetricFactor::new(2 * next),
                sides: zeros(2 * next * (w + 2 * next)),
            },
        }
    }

    /// Factors interval `k`, of which `q` and the response are there without `V+`. `value` comes in as `V+` and leaves as `V`; `penalties` are
    /// `D`, empty where there are none. Returns how many negative eigenvalues there are beyond one per row, or `None` at
    /// a zero pivot.
    #[inline(always)]
    pub(super) fn factor<const FUSED: bool>(
        &mut self,
        sizes: Sizes,
        q: &mut [f64],
        factors: &mut Factors,
        (k, fixed, penalties): (usize, &[bool], &[f64]),
        value: &mut [f64],
    ) -> Option<usize> {
        // Slices of known lengths need no checks of their indices.
        let value = &mut value[..sizes.kept() * sizes.kept()];
        let q = &mut q[..sizes.reduced() * sizes.reduced()];
        join_next(sizes, factors.response_mut(sizes, k), value);
        let removed = if penalties.is_empty() {
            self.add_next::<FUSED>(sizes, factors.response(sizes, k), value, q);
            0
        } else {
            add_theta(sizes, value, q);
            self.compliance.give_way(sizes, q, factors, (k, penalties))?
        };
        fix_controls(sizes, fixed, q);
        Some(removed + self.remove_controls::<FUSED>(sizes, q, factors, (k, value))?)
    }

    /// `Q += W' V W`: the lower triangle, and the rows of the controls in full.
    #[inline(always)]
    fn add_next<const FUSED: bool>(&mut self, sizes: Sizes, response: &[f64], value: &[f64], q: &mut [f64]) {
        let Sizes { n, m, inner, .. } = sizes;
        let (w, kept, all) = (sizes.reduced(), sizes.kept(), sizes.all());
        let (t, units) = (View::rows(&response[inner * all..], all), View::rows(&self.units, w));
        let pushed = &mut self.pushed[..kept * w];
        pushed.fill(0.0);
        let (v_x, v_theta) = (View::rows(value, kept), View::rows(&value[n..], kept));
        add_product::<FUSED>(1.0, v_x, t, n, (pushed, w));
        add_product::<FUSED>(1.0, v_theta, units, sizes.q, (pushed, w));
        for i in 0..w {
            let end = if (n..n + m).contains(&i) { w } else { lower_end(i, w) };
            let row = &mut q[i * w..][..end];
            add_row_product::<FUSED>(1.0, (t.transposed(), i), View::rows(pushed, w), n, row);
            if let Some(theta) = i.checked_sub(n + m) {
                for (sum, value) in row.iter_mut().zip(&pushed[(n + theta) * w..]) {
                    *sum += value;
                }
            }
        }
    }

    /// Removes `u_k`; writes `V_k` to `value`.
    #[inline(always)]
    fn remove_controls<const FUSED: bool>(
        &mut self,
        sizes: Sizes,
        q: &mut [f64],
        factors: &mut Factors,
        (k, value): (usize, &mut [f64]),
    ) -> Option<usize> {
        let Sizes { n, m, .. } = sizes;
        let (w, kept) = (sizes.reduced(), sizes.kept());
        self.side[..m * w].copy_from_slice(&q[n * w..][..m * w]);
        let negative = self.invert_controls::<FUSED>(sizes)?;
        let (inverse, gain) = factors.controls_mut(sizes, k);
        inverse.copy_from_slice(&self.inverse[..m * m]);
        let (side, wide) = (View::rows(&self.side[..m * w], w), &mut self.gain[..m * w]);
        wide.fill(0.0);
        add_product::<FUSED>(-1.0, View::rows(&self.inverse, m), side, m, (wide, w));
        add_lower_product::<FUSED>(side.transposed(), View::rows(wide, w), m, (q, w));
        for i in 0..kept {
            for j in 0..m {
                gain[j * kept + i] = wide[j * w + sizes.position(i)];
            }
            for j in 0..kept {
                value[i * kept + j] = q[sizes.position(i.max(j)) * w + sizes.position(i.min(j))];
            }
        }
        Some(negative)
    }

    /// Inverts `Q_uu` and counts its negative eigenvalues. Near a solution it is positive definite.
    #[inline(always)]
    fn invert_controls<const FUSED: bool>(&mut self, sizes: Sizes) -> Option<usize> {
        let Sizes { n, m, .. } = sizes;
        let (w, inverse) = (sizes.reduced(), &mut self.inverse[..m * m]);
        for i in 0..m {
            inverse[i * m..][..m].copy_from_slice(&self.side[i * w + n..][..m]);
        }
        if invert_positive::<FUSED>(m, inverse) { Some(0) } else { self.invert_indefinite(sizes) }
    }

    #[cold]
    fn invert_indefinite(&mut self, sizes: Sizes) -> Option<usize> {
        let Sizes { n, m, .. } = sizes;
        for i in 0..m {
            self.inverse[i * m..][..m].copy_from_slice(&self.side[i * sizes.reduced() + n..][..m]);
        }
        let negative = self.uu_factor.factor(&self.inverse)?;
        self.inverse.fill(0.0);
        (0..m).for_each(|i| self.inverse[i * m + i] = 1.0);
        self.uu_factor.solve(&mut self.inverse, m);
        Some(negative)
    }
}

impl Compliance {
    /// Completes `Q`, and replaces `[-R E; N M]` by the response.
    fn give_way(
        &mut self,
        sizes: Sizes,
        q: &mut [f64],
        factors: &mut Factors,
        (k, penalties): (usize, &[f64]),
    ) -> Option<usize> {
        let (next, w, all) = (sizes.next(), sizes.reduced(), sizes.all());
        let width = all + next;
        let response = factors.response_mut(sizes, k);
        self.fill(sizes, response, penalties);
        let negative = self.s_factor.factor(&self.s)?;
        self.s_factor.solve(&mut self.sides, width);
        let (minus_r, n) = response.split_at(next * all);
        let (steps, multipliers) = self.sides.split_at(next * width);
        let transposed = |values| View::rows(values, all).transposed();
        add_product::<false>(1.0, transposed(n), View::rows(steps, width), next, (q, w));
        add_product::<false>(-1.0, transposed(minus_r), View::rows(multipliers, width), next, (q, w));
        for (row, side) in response.chunks_exact_mut(all).zip(self.sides.chunks_exact(width)) {
            row.copy_from_slice(&side[..all]);
        }
        factors.keep_compliance(next, k, steps.chunks_exact(width).map(|row| &row[all..]));
        // A block with too few negative eigenvalues has a wrong sign just as well: count it as one.
        Some(negative.abs_diff(next))
    }

    fn fill(&mut self, sizes: Sizes, response: &[f64], penalties: &[f64]) {
        let (n, w, all) = (sizes.next(), sizes.reduced(), sizes.all());
        let (defects, curvature) = response.split_at(n * all);
        self.s.fill(0.0);
        self.sides.fill(0.0);
        let (above, below) = self.sides.split_at_mut(n * (all + n));
        for i in 0..n {
            let (defect, curvature) = (&defects[i * all..][..all], &curvature[i * all..][..all]);
            self.s[i * 2 * n..][..n].copy_from_slice(&curvature[w..]);
            self.s[(n + i) * 2 * n..][..n].copy_from_slice(&defect[w..]);
            self.s[(n + i) * 2 * n + n + i] = -penalties[i];
            let (above, below) = (&mut above[i * (all + n)..], &mut below[i * (all + n)..]);
            above[..w].iter_mut().zip(curvature).for_each(|(side, n)| *side = -n);
            above[all + i] = 1.0;
            below[..w].copy_from_slice(&defect[..w]);
            below[w + i] = 1.0;
        }
    }
}

/// `Q += Theta`
fn add_theta(sizes: Sizes, value: &[f64], q: &mut [f64]) {
    let Sizes { n, m, .. } = sizes;
    for i in 0..sizes.q {
        for j in 0..sizes.q {
            q[(n + m + i) * sizes.reduced() + n + m + j] += value[(n + i) * sizes.kept() + n + j];
        }
    }
}

/// `M` and `N` with what `V+` adds to them.
#[inline(always)]
fn join_next(sizes: Sizes, response: &mut [f64], value: &[f64]) {
    let Sizes { n, m, inner, q } = sizes;
    let (w, kept, all) = (sizes.reduced(), sizes.kept(), sizes.all());
    for i in 0..n {
        let row = &mut response[(sizes.next() + inner + i) * all..][..all];
        let value = &value[i * kept..][..kept];
        for j in 0..q {
            row[n + m + j] += value[n + j];
        }
        for j in 0..n {
            row[w + inner + j] += value[j];
        }
    }
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
