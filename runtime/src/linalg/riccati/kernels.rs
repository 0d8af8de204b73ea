//! Products of small matrices, written so that constant sizes unroll and that neighbouring numbers share a register.
//!
//! `FUSED` says that the machine multiplies and adds in one instruction; without one `mul_add` would be a call.

use crate::linalg::lanes::multiply_add;

/// A matrix inside a slice: entry `(i, j)` is `values[i * row + j * column]`.
#[derive(Clone, Copy)]
pub(super) struct View<'a, T> {
    pub(super) values: &'a [T],
    pub(super) row: usize,
    pub(super) column: usize,
}

impl<'a, T> View<'a, T> {
    /// Rows of this length, one after the other.
    #[inline(always)]
    pub(super) fn rows(values: &'a [T], length: usize) -> Self {
        View { values, row: length, column: 1 }
    }

    /// The same matrix with rows and columns exchanged.
    #[inline(always)]
    pub(super) fn transposed(self) -> Self {
        View { row: self.column, column: self.row, ..self }
    }
}

/// Row `i` of `Y += sign A B`: `y` is that row, `inner` the number of columns of `A`. `B` lies row by row.
#[inline(always)]
pub(super) fn add_row_product<const FUSED: bool>(
    sign: f64,
    (a, i): (View<f64>, usize),
    b: View<f64>,
    inner: usize,
    y: &mut [f64],
) {
    let mut start = 0;
    while start + 12 <= y.len() {
        add_row_block::<FUSED, 12>(sign, (a, i), b, inner, (y, start));
        start += 12;
    }
    while start + 8 <= y.len() {
        add_row_block::<FUSED, 8>(sign, (a, i), b, inner, (y, start));
        start += 8;
    }
    while start + 4 <= y.len() {
        add_row_block::<FUSED, 4>(sign, (a, i), b, inner, (y, start));
        start += 4;
    }
    while start < y.len() {
        add_row_block::<FUSED, 1>(sign, (a, i), b, inner, (y, start));
        start += 1;
    }
}

/// The same for `WIDTH` columns of the row, which stay in registers.
#[inline(always)]
fn add_row_block<const FUSED: bool, const WIDTH: usize>(
    sign: f64,
    (a, i): (View<f64>, usize),
    b: View<f64>,
    inner: usize,
    (y, start): (&mut [f64], usize),
) {
    let y = &mut y[start..start + WIDTH];
    let mut sum = [0.0; WIDTH];
    sum.copy_from_slice(y);
    for l in 0..inner {
        let x = sign * a.values[i * a.row + l * a.column];
        let row = &b.values[l * b.row + start..][..WIDTH];
        for (sum, value) in sum.iter_mut().zip(row) {
            *sum = multiply_add::<FUSED>(x, *value, *sum);
        }
    }
    y.copy_from_slice(&sum);
}

/// `Y += sign A B` where `A` has `inner` columns and the rows of `Y` have this length.
#[inline(always)]
pub(super) fn add_product<const FUSED: bool>(
    sign: f64,
    a: View<f64>,
    b: View<f64>,
    inner: usize,
    (y, length): (&mut [f64], usize),
) {
    for i in 0..y.len() / length {
        add_row_product::<FUSED>(sign, (a, i), b, inner, &mut y[i * length..][..length]);
    }
}

/// The lower triangle of the square `Y += A B`, of `length` rows; some entries above the diagonal change, too.
#[inline(always)]
pub(super) fn add_lower_product<const FUSED: bool>(
    a: View<f64>,
    b: View<f64>,
    inner: usize,
    (y, length): (&mut [f64], usize),
) {
    for i in 0..length {
        add_row_product::<FUSED>(1.0, (a, i), b, inner, &mut y[i * length..][..lower_end(i, length)]);
    }
}

/// Columns that are taken together in a lower triangle.
const STEP: usize = 8;

/// Where row `i` of the lower triangle ends, so that its numbers share registers. Short rows are taken whole: loops of equal length unroll.
#[inline(always)]
pub(super) fn lower_end(i: usize, length: usize) -> usize {
    if length <= STEP { length } else { (i / STEP * STEP + STEP).min(length) }
}

/// `a . b`
#[inline(always)]
pub(super) fn dot<const FUSED: bool>(a: &[f64], b: &[f64]) -> f64 {
    let mut sum = [0.0; 4];
    let mut start = 0;
    while start + 4 <= a.len() {
        let (a, b) = (&a[start..][..4], &b[start..][..4]);
        for p in 0..4 {
            sum[p] = multiply_add::<FUSED>(a[p], b[p], sum[p]);
        }
        start += 4;
    }
    let mut total = (sum[0] + sum[2]) + (sum[1] + sum[3]);
    for i in start..a.len() {
        total = multiply_add::<FUSED>(a[i], b[i], total);
    }
    total
}

/// Inverts the symmetric `a` in place; `false`, and `a` is destroyed, unless it is safely positive definite.
#[inline(always)]
pub(super) fn invert_positive<const FUSED: bool>(n: usize, a: &mut [f64]) -> bool {
    if n == 2 {
        return invert_positive_pair::<FUSED>(a);
    }
    for k in 0..n {
        let pivot = a[k * n + k];
        // Also true for what is not a number.
        if !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        let inverse = 1.0 / pivot;
        a[k * n + k] = 1.0;
        for value in &mut a[k * n..][..n] {
            *value *= inverse;
        }
        for i in (0..n).filter(|i| *i != k) {
            let factor = std::mem::take(&mut a[i * n + k]);
            for j in 0..n {
                a[i * n + j] = multiply_add::<FUSED>(-factor, a[k * n + j], a[i * n + j]);
            }
        }
    }
    true
}

/// The same for two rows, with one division.
#[inline(always)]
fn invert_positive_pair<const FUSED: bool>(a: &mut [f64]) -> bool {
    let (first, mixed, second) = (a[0], a[2], a[3]);
    let determinant = multiply_add::<FUSED>(first, second, -mixed * mixed);
    if !(first > 0.0 && determinant > 0.0 && determinant.is_finite()) {
        return false;
    }
    let inverse = 1.0 / determinant;
    a.copy_from_slice(&[second * inverse, -mixed * inverse, -mixed * inverse, first * inverse]);
    true
}
