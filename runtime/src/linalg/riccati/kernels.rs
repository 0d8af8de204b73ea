//! Products of small matrices stored row by row, written so that constant sizes unroll.

/// `a . b`
#[inline(always)]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// `target += factor * source`
#[inline(always)]
pub(super) fn add_scaled(target: &mut [f64], source: &[f64], factor: f64) {
    for (t, s) in target.iter_mut().zip(source) {
        *t += factor * s;
    }
}

/// `H += factor * row' row`, skipping the zeros of a sparse row.
pub(super) fn add_outer_product(hessian: &mut [f64], row: &[f64], factor: f64) {
    let width = row.len();
    for (i, value) in row.iter().enumerate().filter(|(_, value)| **value != 0.0) {
        add_scaled(&mut hessian[i * width..][..width], row, factor * value);
    }
}

/// `Y += factor * M T` with `M` of size `n x n` and `T` of size `n x w`.
#[inline(always)]
pub(super) fn add_product(factor: f64, m: &[f64], t: &[f64], y: &mut [f64], n: usize, w: usize) {
    for i in 0..n {
        let row = &mut y[i * w..i * w + w];
        for l in 0..n {
            add_scaled(row, &t[l * w..l * w + w], factor * m[i * n + l]);
        }
    }
}

/// `Q += A' B` with matrices of `rows x w`.
#[inline(always)]
pub(super) fn add_transposed_product(a: &[f64], b: &[f64], q: &mut [f64], rows: usize, w: usize) {
    for i in 0..w {
        let row = &mut q[i * w..i * w + w];
        for l in 0..rows {
            add_scaled(row, &b[l * w..l * w + w], a[l * w + i]);
        }
    }
}

/// Lower triangle of `Q += A' B + B' A` with matrices of `rows x w`.
#[inline(always)]
pub(super) fn add_symmetric_product(a: &[f64], b: &[f64], q: &mut [f64], rows: usize, w: usize) {
    for i in 0..w {
        let row = &mut q[i * w..i * w + i + 1];
        for l in 0..rows {
            let (x, y) = (a[l * w + i], b[l * w + i]);
            for (j, entry) in row.iter_mut().enumerate() {
                *entry += x * b[l * w + j] + y * a[l * w + j];
            }
        }
    }
}
