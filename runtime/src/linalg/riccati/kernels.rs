//! Products of small matrices, written so that constant sizes unroll and that four numbers share a register.
//!
//! `FUSED` says that the machine multiplies and adds in one instruction; without one `mul_add` would be a call.

/// `a b + c`
#[inline(always)]
pub(super) fn multiply_add<const FUSED: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

/// A matrix inside a slice: entry `(i, j)` is `values[i * row + j * column]`.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) values: &'a [f64],
    pub(super) row: usize,
    pub(super) column: usize,
}

impl<'a> View<'a> {
    /// Rows of this length, one after the other.
    #[inline(always)]
    pub(super) fn rows(values: &'a [f64], length: usize) -> Self {
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
    (a, i): (View, usize),
    b: View,
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
    (a, i): (View, usize),
    b: View,
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
    a: View,
    b: View,
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
    a: View,
    b: View,
    inner: usize,
    (y, length): (&mut [f64], usize),
) {
    for i in 0..length {
        let end = ((i / 8 + 1) * 8).min(length);
        add_row_product::<FUSED>(1.0, (a, i), b, inner, &mut y[i * length..][..end]);
    }
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

/// Replaces the rows of `x` by those of `E^-1 X`, by `L U = P E` in place of `e`. `false` if `E` is singular.
#[inline(always)]
pub(super) fn divide<const FUSED: bool>(n: usize, e: &mut [f64], x: &mut [f64], columns: usize) -> bool {
    for k in 0..n {
        let (mut pivot, mut largest) = (k, e[k * n + k].abs());
        for i in k + 1..n {
            if e[i * n + k].abs() > largest {
                (pivot, largest) = (i, e[i * n + k].abs());
            }
        }
        if largest == 0.0 || !largest.is_finite() {
            return false;
        }
        if pivot != k {
            swap_rows(e, n, k, pivot);
            swap_rows(x, columns, k, pivot);
        }
        eliminate_below::<FUSED>(n, e, k);
    }
    for i in 0..n {
        let (above, row) = x.split_at_mut(i * columns);
        let above = View::rows(above, columns);
        add_row_product::<FUSED>(-1.0, (View::rows(e, n), i), above, i, &mut row[..columns]);
    }
    for i in (0..n).rev() {
        let (row, below) = x[i * columns..].split_at_mut(columns);
        let (above, inner) = (View::rows(&e[i * n + i + 1..], n), n - i - 1);
        add_row_product::<FUSED>(-1.0, (above, 0), View::rows(below, columns), inner, row);
        let inverse = 1.0 / e[i * n + i];
        row.iter_mut().for_each(|value| *value *= inverse);
    }
    true
}

/// Column `k` of `L`, and what it takes from the rows below.
#[inline(always)]
fn eliminate_below<const FUSED: bool>(n: usize, e: &mut [f64], k: usize) {
    let inverse = 1.0 / e[k * n + k];
    for i in k + 1..n {
        let factor = e[i * n + k] * inverse;
        e[i * n + k] = factor;
        // Where the scheme is explicit, always.
        if factor == 0.0 {
            continue;
        }
        for j in k + 1..n {
            e[i * n + j] = multiply_add::<FUSED>(-factor, e[k * n + j], e[i * n + j]);
        }
    }
}

#[inline(always)]
fn swap_rows(matrix: &mut [f64], length: usize, first: usize, second: usize) {
    for j in 0..length {
        matrix.swap(first * length + j, second * length + j);
    }
}

/// Inverts the symmetric `a` in place; `false`, and `a` is destroyed, unless it is safely positive definite.
#[inline(always)]
pub(super) fn invert_positive<const FUSED: bool>(n: usize, a: &mut [f64]) -> bool {
    for k in 0..n {
        let pivot = a[k * n + k];
        // Also true for what is not a number.
        if !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        let inverse = 1.0 / pivot;
        a[k * n + k] = 1.0;
        a[k * n..][..n].iter_mut().for_each(|value| *value *= inverse);
        for i in (0..n).filter(|i| *i != k) {
            let factor = std::mem::take(&mut a[i * n + k]);
            for j in 0..n {
                a[i * n + j] = multiply_add::<FUSED>(-factor, a[k * n + j], a[i * n + j]);
            }
        }
    }
    true
}
