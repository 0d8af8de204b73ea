//! LU factors with partial pivoting of one small dense matrix, stored row by row.

/// `P A = L U` of an `n x n` matrix.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lu {
    factors: Vec<f64>,
    pivots: Vec<usize>,
}

impl Lu {
    pub(crate) fn new(n: usize) -> Self {
        Lu { factors: vec![0.0; n * n], pivots: vec![0; n] }
    }

    /// Factors `matrix`; `false` if it is singular. `n` must be the size: a caller that knows it as
    /// a constant gets unrolled loops.
    #[inline(always)]
    pub(crate) fn factor(&mut self, n: usize, matrix: &[f64]) -> bool {
        self.factors[..n * n].copy_from_slice(&matrix[..n * n]);
        for k in 0..n {
            let size = |i: usize| self.factors[i * n + k].abs();
            let pivot = (k..n).fold(k, |best, i| if size(i) > size(best) { i } else { best });
            self.pivots[k] = pivot;
            if size(pivot) == 0.0 || !size(pivot).is_finite() {
                return false;
            }
            swap_rows(&mut self.factors, n, k, pivot);
            self.eliminate(n, k);
        }
        true
    }

    #[inline(always)]
    fn eliminate(&mut self, n: usize, k: usize) {
        let (upper, lower) = self.factors.split_at_mut((k + 1) * n);
        let pivot_row = &upper[k * n..];
        let inverse = 1.0 / pivot_row[k];
        for row in lower.chunks_exact_mut(n) {
            let factor = row[k] * inverse;
            for j in k + 1..n {
                row[j] -= factor * pivot_row[j];
            }
            row[k] = factor;
        }
    }

    /// Replaces the `n x columns` matrix `b` (row by row) by `A^-1 b`.
    #[inline(always)]
    pub(crate) fn solve(&self, n: usize, b: &mut [f64], columns: usize) {
        let factors = &self.factors[..n * n];
        for k in 0..n {
            swap_rows(b, columns, k, self.pivots[k]);
        }
        for i in 0..n {
            for k in 0..i {
                subtract_row(b, columns, i, k, factors[i * n + k]);
            }
        }
        for i in (0..n).rev() {
            for k in i + 1..n {
                subtract_row(b, columns, i, k, factors[i * n + k]);
            }
            let inverse = 1.0 / factors[i * n + i];
            b[i * columns..i * columns + columns].iter_mut().for_each(|value| *value *= inverse);
        }
    }
}

/// Swaps two rows of `b`.
#[inline(always)]
pub(super) fn swap_rows(b: &mut [f64], columns: usize, first: usize, second: usize) {
    if first != second {
        for j in 0..columns {
            b.swap(first * columns + j, second * columns + j);
        }
    }
}

/// `row i of b -= factor * row k of b`, `i != k`.
#[inline(always)]
fn subtract_row(b: &mut [f64], columns: usize, i: usize, k: usize, factor: f64) {
    let (low, high) = (i.min(k), i.max(k));
    let (before, after) = b.split_at_mut(high * columns);
    let (first, second) =
        (&mut before[low * columns..low * columns + columns], &mut after[..columns]);
    let (target, source) = if i < k { (first, second) } else { (second, first) };
    for (t, s) in target.iter_mut().zip(source) {
        *t -= factor * *s;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_system_that_needs_pivoting() {
        // [0 2; 3 4] x = (2, 10)  =>  x = (2, 1)
        let mut lu = Lu::new(2);
        assert!(lu.factor(2, &[0.0, 2.0, 3.0, 4.0]));
        let mut b = [2.0, 10.0];
        lu.solve(2, &mut b, 1);
        assert_eq!(b, [2.0, 1.0]);
        assert!(!lu.factor(2, &[1.0, 2.0, 2.0, 4.0]));
    }
}
