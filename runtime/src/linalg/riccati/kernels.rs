//! Products of small matrices, written so that constant sizes unroll and that neighbouring numbers
//! share a register.
//!
//! `FUSED` says that the machine multiplies and adds in one instruction; without one `mul_add`
//! would be a call.

use crate::linalg::dense::lanes::multiply_add;
use std::ops::Range;

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

/// A product of two matrices, of which the right one is read row by row.
pub(super) trait Product {
    /// Columns of the left matrix.
    fn inner(&self) -> usize;
    /// Entry `(i, l)` of the left matrix.
    fn left(&self, i: usize, l: usize) -> f64;
    /// Row `l` of the right matrix.
    fn right(&self, l: usize) -> &[f64];
}

/// `sign A B`, where `A` has `inner` columns and `B` lies row by row.
#[derive(Clone, Copy)]
pub(super) struct Signed<'a> {
    pub(super) sign: f64,
    pub(super) a: View<'a, f64>,
    pub(super) b: View<'a, f64>,
    pub(super) inner: usize,
}

impl Product for Signed<'_> {
    #[inline(always)]
    fn inner(&self) -> usize {
        self.inner
    }
    #[inline(always)]
    fn left(&self, i: usize, l: usize) -> f64 {
        self.sign * self.a.values[i * self.a.row + l * self.a.column]
    }
    #[inline(always)]
    fn right(&self, l: usize) -> &[f64] {
        &self.b.values[l * self.b.row..]
    }
}

/// Row `i` of `Y += sign A B`: `y` is that row, `inner` the number of columns of `A`. `B` lies row
/// by row.
#[inline(always)]
pub(super) fn add_row_product<const FUSED: bool>(
    sign: f64,
    (a, i): (View<f64>, usize),
    b: View<f64>,
    inner: usize,
    y: &mut [f64],
) {
    let a = View { values: &a.values[i * a.row..], ..a };
    let end = y.len();
    add_rows::<FUSED, 1>(&Signed { sign, a, b, inner }, (0, end), (y, end));
}

/// Adds these rows of a product to `Y`, whose rows have this length; of a `LOWER` triangle at least
/// what is not above the diagonal.
#[inline(always)]
pub(super) fn add_product<const FUSED: bool, const LOWER: bool>(
    product: &impl Product,
    rows: Range<usize>,
    (y, length): (&mut [f64], usize),
) {
    let mut i = rows.start;
    while i + 4 <= rows.end {
        add_rows::<FUSED, 4>(product, (i, row_end::<LOWER>(i + 3, length)), (y, length));
        i += 4;
    }
    while i + 2 <= rows.end {
        add_rows::<FUSED, 2>(product, (i, row_end::<LOWER>(i + 1, length)), (y, length));
        i += 2;
    }
    while i < rows.end {
        add_rows::<FUSED, 1>(product, (i, row_end::<LOWER>(i, length)), (y, length));
        i += 1;
    }
}

#[inline(always)]
fn row_end<const LOWER: bool>(i: usize, length: usize) -> usize {
    if LOWER { lower_end(i, length) } else { length }
}

/// The same for `ROWS` rows up to this column.
#[inline(always)]
fn add_rows<const FUSED: bool, const ROWS: usize>(
    product: &impl Product,
    (first, end): (usize, usize),
    (y, length): (&mut [f64], usize),
) {
    let mut start = 0;
    while start + 8 <= end {
        add_block::<FUSED, ROWS, 8>(product, (first, start), (y, length));
        start += 8;
    }
    while start + 4 <= end {
        add_block::<FUSED, ROWS, 4>(product, (first, start), (y, length));
        start += 4;
    }
    while start < end {
        add_block::<FUSED, ROWS, 1>(product, (first, start), (y, length));
        start += 1;
    }
}

/// The same for a block, whose sums stay in registers: what a row of the right matrix has is read
/// once for all rows of the block.
#[inline(always)]
fn add_block<const FUSED: bool, const ROWS: usize, const WIDTH: usize>(
    product: &impl Product,
    (first, start): (usize, usize),
    (y, length): (&mut [f64], usize),
) {
    let mut sums = [[0.0; WIDTH]; ROWS];
    for r in 0..ROWS {
        sums[r].copy_from_slice(&y[(first + r) * length + start..][..WIDTH]);
    }
    for l in 0..product.inner() {
        let row = &product.right(l)[start..][..WIDTH];
        for r in 0..ROWS {
            let x = product.left(first + r, l);
            for j in 0..WIDTH {
                sums[r][j] = multiply_add::<FUSED>(x, row[j], sums[r][j]);
            }
        }
    }
    for r in 0..ROWS {
        y[(first + r) * length + start..][..WIDTH].copy_from_slice(&sums[r]);
    }
}

/// Columns that are taken together in a lower triangle.
const STEP: usize = 8;

/// Where row `i` of the lower triangle ends, so that its numbers share registers. Short rows are
/// taken whole: loops of equal length unroll.
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

/// Inverts the symmetric `a` in place; `false`, and `a` is destroyed, unless it is safely positive
/// definite.
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
