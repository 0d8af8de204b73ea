//! Rows with a penalty `D` (in restoration), with the names of [`super::interval`].
//!
//! They let `x+` give way, each as much as it likes, so that they are not divided by `E`
//! beforehand:
//!
//! ```text
//!     [ M  E' ] [ T F A ]   [ -N 0 I ]        [ x+     ]   [ T F ] [ w ]   [ A  ]
//!     [ E  -D ] [ L C . ] = [ -R I 0 ]        [ lambda ] = [ L C ] [ b ] - [ F' ] pull
//!
//!     Q = H_ww + Theta + [N; R]' [T; L]
//! ```

use super::factors::Factors;
use super::kernels::{Signed, View, add_product, add_row_product, dot};
use super::sizes::Sizes;
use crate::linalg::dense::symmetric::SymmetricFactor;

/// Working memory where rows are penalised.
pub(super) struct Compliance {
    /// `[M E'; E -D]`
    s: Vec<f64>,
    s_factor: SymmetricFactor,
    /// `[-N 0 I; -R I 0]`, then `[T F A; L C .]`
    sides: Vec<f64>,
}

impl Compliance {
    pub(super) fn new(sizes: Sizes) -> Self {
        let next = sizes.next();
        Compliance {
            s: vec![0.0; 4 * next * next],
            s_factor: SymmetricFactor::new(2 * next),
            sides: vec![0.0; 2 * next * (sizes.reduced() + 2 * next)],
        }
    }

    /// Completes `Q`, and replaces `[-R E; N M]` by the response.
    pub(super) fn give_way(
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
        for (sign, left, right) in [(1.0, n, steps), (-1.0, minus_r, multipliers)] {
            let (a, b) = (View::rows(left, all).transposed(), View::rows(right, width));
            add_product::<false, false>(&Signed { sign, a, b, inner: next }, 0..w, (&mut *q, w));
        }
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

/// `x+` in a solve, from `w`, `b` and `pull`.
pub(super) fn give_way(
    factors: &Factors,
    sizes: Sizes,
    k: usize,
    (known, step): (&mut [f64], &mut [f64]),
    (pull, b): (&[f64], &[f64]),
) {
    let (all, next) = (sizes.all(), sizes.next());
    known[sizes.reduced()..].copy_from_slice(b);
    let (response, compliance) = (factors.response(sizes, k), factors.compliance(next, k));
    for i in 0..next {
        step[i] = dot::<false>(&response[i * all..][..all], known)
            - dot::<false>(&compliance[i * next..][..next], pull);
    }
}

/// Multipliers in a solve, in the place of `b`.
pub(super) fn push_back_where_given_way(
    factors: &Factors,
    sizes: Sizes,
    k: usize,
    known: &[f64],
    (pull, b): (&[f64], &mut [f64]),
) {
    let (w, all, next) = (sizes.reduced(), sizes.all(), sizes.next());
    let (steps, multipliers) = factors.response(sizes, k).split_at(next * all);
    for i in 0..next {
        b[i] = dot::<false>(&multipliers[i * all..][..all], known);
    }
    add_row_product::<false>(-1.0, (View::rows(pull, 0), 0), View::rows(&steps[w..], all), next, b);
}
