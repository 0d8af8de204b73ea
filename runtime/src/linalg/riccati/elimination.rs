//! Products and elimination for four intervals at a time.

use super::kernels::View;
use crate::linalg::dense::lanes::Lanes;

/// Row `i` of `Y += A B`: `y` is that row, `inner` the number of columns of `A`. `B` lies row by
/// row.
#[inline(always)]
pub(super) fn add_row_product<const FUSED: bool>(
    (a, i): (View<Lanes>, usize),
    b: View<Lanes>,
    inner: usize,
    y: &mut [Lanes],
) {
    let mut start = 0;
    while start + 8 <= y.len() {
        add_row_block::<FUSED, 8>((a, i), b, inner, (y, start));
        start += 8;
    }
    while start + 4 <= y.len() {
        add_row_block::<FUSED, 4>((a, i), b, inner, (y, start));
        start += 4;
    }
    while start < y.len() {
        add_row_block::<FUSED, 1>((a, i), b, inner, (y, start));
        start += 1;
    }
}

/// The same for `WIDTH` columns of the row, which stay in registers.
///
/// Hardly any variable enters all equations, and an entry that is zero in all intervals of one
/// batch is so in the next: it is skipped.
#[inline(always)]
fn add_row_block<const FUSED: bool, const WIDTH: usize>(
    (a, i): (View<Lanes>, usize),
    b: View<Lanes>,
    inner: usize,
    (y, start): (&mut [Lanes], usize),
) {
    let y = &mut y[start..start + WIDTH];
    let mut sum = [Lanes::ZERO; WIDTH];
    sum.copy_from_slice(y);
    for l in 0..inner {
        let x = a.values[i * a.row + l * a.column];
        if x.is_nothing() {
            continue;
        }
        for (sum, value) in sum.iter_mut().zip(&b.values[l * b.row + start..][..WIDTH]) {
            *sum = Lanes::multiply_add::<FUSED>(x, *value, *sum);
        }
    }
    y.copy_from_slice(&sum);
}

/// Replaces the rows of `x` by those of `E^-1 X`, by elimination with pivots that are chosen in
/// each interval; `e` is destroyed. `false` if `E` is singular in one of them.
#[inline(always)]
pub(super) fn divide<const FUSED: bool>(
    n: usize,
    e: &mut [Lanes],
    (x, columns): (&mut [Lanes], usize),
) -> bool {
    for k in 0..n {
        bring_up_pivots(n, k, e, (x, columns));
        let pivot = e[k * n + k];
        // As it is for a variable that depends on itself by its rate only through others.
        if !pivot.are_one() {
            let inverse = pivot.inverse();
            if !(pivot.are_finite() && inverse.are_finite()) {
                return false;
            }
            scale(&mut e[k * n..][..n], inverse);
            scale(&mut x[k * columns..][..columns], inverse);
        }
        for i in (0..n).filter(|i| *i != k) {
            let factor = e[i * n + k].scaled(-1.0);
            if !factor.is_nothing() {
                add_row::<FUSED>(e, n, (i, k), factor);
                add_row::<FUSED>(x, columns, (i, k), factor);
            }
        }
    }
    true
}

#[inline(always)]
fn scale(values: &mut [Lanes], by: Lanes) {
    for value in values {
        *value = value.times(by);
    }
}

/// Adds a multiple of row `k` to row `i`.
#[inline(always)]
fn add_row<const FUSED: bool>(
    matrix: &mut [Lanes],
    length: usize,
    (i, k): (usize, usize),
    factor: Lanes,
) {
    for j in 0..length {
        matrix[i * length + j] =
            Lanes::multiply_add::<FUSED>(factor, matrix[k * length + j], matrix[i * length + j]);
    }
}

/// Exchanges row `k` with rows that have a larger entry in column `k`, in the intervals where they
/// have: hardly anywhere, as steps are short.
#[inline(always)]
fn bring_up_pivots(n: usize, k: usize, e: &mut [Lanes], (x, columns): (&mut [Lanes], usize)) {
    for i in k + 1..n {
        if e[i * n + k].exceeds(e[k * n + k]) {
            exchange_rows(n, (i, k), e, (x, columns));
        }
    }
}

#[cold]
fn exchange_rows(
    n: usize,
    (i, k): (usize, usize),
    e: &mut [Lanes],
    (x, columns): (&mut [Lanes], usize),
) {
    for l in 0..Lanes::COUNT {
        let size = |row: usize| e[row * n + k].0[l].abs();
        if size(i) > size(k) {
            exchange_in_lane(e, n, (i, k), l);
            exchange_in_lane(x, columns, (i, k), l);
        }
    }
}

fn exchange_in_lane(matrix: &mut [Lanes], length: usize, (i, k): (usize, usize), l: usize) {
    for j in 0..length {
        let (upper, lower) = (matrix[k * length + j].0[l], matrix[i * length + j].0[l]);
        matrix[k * length + j].0[l] = lower;
        matrix[i * length + j].0[l] = upper;
    }
}
