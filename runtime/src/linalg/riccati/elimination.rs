//! Products and elimination for four intervals at a time.

use super::kernels::View;
use crate::linalg::lanes::Lanes;

/// Row `i` of `Y += sign A B`: `y` is that row, `inner` the number of columns of `A`. `B` lies row by row.
///
/// Hardly any variable enters all equations, and an entry that is zero in all intervals of one batch is so in the next: it is skipped.
#[inline(always)]
pub(super) fn add_row_product<const FUSED: bool>(
    sign: f64,
    (a, i): (View<Lanes>, usize),
    b: View<Lanes>,
    inner: usize,
    y: &mut [Lanes],
) {
    for l in 0..inner {
        let x = a.values[i * a.row + l * a.column];
        if x.is_nothing() {
            continue;
        }
        let x = x.scaled(sign);
        for (sum, value) in y.iter_mut().zip(&b.values[l * b.row..]) {
            *sum = Lanes::multiply_add::<FUSED>(x, *value, *sum);
        }
    }
}

/// Replaces the rows of `x` by those of `E^-1 X`, by elimination with pivots that are chosen in each interval; `e` is destroyed. `false` if `E` is
/// singular in one of them.
#[inline(always)]
pub(super) fn divide<const FUSED: bool>(
    n: usize,
    e: &mut [Lanes],
    (x, columns): (&mut [Lanes], usize),
) -> bool {
    for k in 0..n {
        bring_up_pivots(n, k, e, (x, columns));
        let pivot = e[k * n + k];
        let inverse = pivot.inverse();
        if !(pivot.are_finite() && inverse.are_finite()) {
            return false;
        }
        scale_row(e, n, k, inverse);
        scale_row(x, columns, k, inverse);
        for i in 0..n {
            let factor = e[i * n + k].scaled(-1.0);
            if i != k && !factor.is_nothing() {
                add_row::<FUSED>(e, n, (i, k), factor);
                add_row::<FUSED>(x, columns, (i, k), factor);
            }
        }
    }
    true
}

#[inline(always)]
fn scale_row(matrix: &mut [Lanes], length: usize, i: usize, by: Lanes) {
    for value in &mut matrix[i * length..][..length] {
        *value = value.times(by);
    }
}

/// Adds a multiple of row `k` to row `i`.
#[inline(always)]
fn add_row<const FUSED: bool>(matrix: &mut [Lanes], length: usize, (i, k): (usize, usize), factor: Lanes) {
    for j in 0..length {
        matrix[i * length + j] =
            Lanes::multiply_add::<FUSED>(factor, matrix[k * length + j], matrix[i * length + j]);
    }
}

/// Exchanges row `k` with the one that has the largest entry in column `k`, in each interval where it is not that one: hardly anywhere, as steps are short.
#[inline(always)]
fn bring_up_pivots(n: usize, k: usize, e: &mut [Lanes], (x, columns): (&mut [Lanes], usize)) {
    let pivot = e[k * n + k].size();
    let mut excess = Lanes::ZERO;
    for i in k + 1..n {
        let size = e[i * n + k].size();
        excess = Lanes::from(|l| if size.0[l] > pivot.0[l] { 1.0 } else { excess.0[l] });
    }
    if !excess.is_nothing() {
        for l in 0..Lanes::COUNT {
            exchange_in_lane(n, (k, l), e, (x, columns));
        }
    }
}

#[cold]
fn exchange_in_lane(n: usize, (k, l): (usize, usize), e: &mut [Lanes], (x, columns): (&mut [Lanes], usize)) {
    let size = |i: usize| e[i * n + k].0[l].abs();
    let pivot = (k + 1..n).fold(k, |pivot, i| if size(i) > size(pivot) { i } else { pivot });
    for (matrix, length) in [(e, n), (x, columns)] {
        for j in 0..length {
            let (upper, lower) = (matrix[k * length + j].0[l], matrix[pivot * length + j].0[l]);
            matrix[k * length + j].0[l] = lower;
            matrix[pivot * length + j].0[l] = upper;
        }
    }
}
