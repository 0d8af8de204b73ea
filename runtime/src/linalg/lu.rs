//! LU factors with partial pivoting of one small dense matrix, stored row by row.

/// `P A = L U` of an `n x n` matrix.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lu {
    n: usize,
    factors: Vec<f64>,
    pivots: Vec<usize>,
}

impl Lu {
    pub(crate) fn new(n: usize) -> Self {
        Lu { n, factors: vec![0.0; n * n], pivots: vec![0; n] }
    }

    /// Factors `matrix`; `false` if it is singular.
    pub(crate) fn factor(&mut self, matrix: &[f64]) -> bool {
        let n = self.n;
        self.factors.copy_from_slice(matrix);
        for k in 0..n {
            let pivot = (k..n).fold(k, |best, i| if self.at(i, k).abs() > self.at(best, k).abs() { i } else { best });
            self.pivots[k] = pivot;
            if self.at(pivot, k) == 0.0 || !self.at(pivot, k).is_finite() {
                return false;
            }
            self.swap_rows(k, pivot);
            self.eliminate(k);
        }
        true
    }

    fn at(&self, i: usize, j: usize) -> f64 {
        self.factors[i * self.n + j]
    }

    fn swap_rows(&mut self, a: usize, b: usize) {
        if a != b {
            for j in 0..self.n {
                self.factors.swap(a * self.n + j, b * self.n + j);
            }
        }
    }

    fn eliminate(&mut self, k: usize) {
        let n = self.n;
        let (upper, lower) = self.factors.split_at_mut((k + 1) * n);
        let pivot_row = &upper[k * n..];
        let inverse = 1.0 / pivot_row[k];
        for row in lower.chunks_exact_mut(n) {
            let factor = row[k] * inverse;
            if factor != 0.0 {
                for j in k + 1..n {
                    row[j] -= factor * pivot_row[j];
                }
            }
            row[k] = factor;
        }
    }

    /// Replaces the `n x columns` matrix `b` (row by row) by `A^-1 b`.
    pub(crate) fn solve(&self, b: &mut [f64], columns: usize) {
        let n = self.n;
        for k in 0..n {
            let pivot = self.pivots[k];
            if pivot != k {
                for j in 0..columns {
                    b.swap(k * columns + j, pivot * columns + j);
                }
            }
        }
        for i in 0..n {
            self.subtract_rows(b, columns, i, 0..i);
        }
        for i in (0..n).rev() {
            self.subtract_rows(b, columns, i, i + 1..n);
            let inverse = 1.0 / self.at(i, i);
            b[i * columns..(i + 1) * columns].iter_mut().for_each(|value| *value *= inverse);
        }
    }

    fn subtract_rows(&self, b: &mut [f64], columns: usize, i: usize, others: std::ops::Range<usize>) {
        for k in others {
            let factor = self.at(i, k);
            if factor != 0.0 {
                for j in 0..columns {
                    b[i * columns + j] -= factor * b[k * columns + j];
                }
            }
        }
    }

    /// Replaces `b` by `A^-T b`.
    pub(crate) fn solve_transposed(&self, b: &mut [f64]) {
        let n = self.n;
        for i in 0..n {
            let sum: f64 = (0..i).map(|k| self.at(k, i) * b[k]).sum();
            b[i] = (b[i] - sum) / self.at(i, i);
        }
        for i in (0..n).rev() {
            let sum: f64 = (i + 1..n).map(|k| self.at(k, i) * b[k]).sum();
            b[i] -= sum;
        }
        for k in (0..n).rev() {
            b.swap(k, self.pivots[k]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_system_that_needs_pivoting_and_its_transpose() {
        // [0 2; 3 4] x = (2, 10)  =>  x = (2, 1);  transposed: [0 3; 2 4] x = (3, 8) => x = (2, 1)
        let mut lu = Lu::new(2);
        assert!(lu.factor(&[0.0, 2.0, 3.0, 4.0]));
        let mut b = [2.0, 10.0];
        lu.solve(&mut b, 1);
        assert_eq!(b, [2.0, 1.0]);
        let mut b = [3.0, 8.0];
        lu.solve_transposed(&mut b);
        assert_eq!(b, [2.0, 1.0]);
        assert!(!lu.factor(&[1.0, 2.0, 2.0, 4.0]));
    }
}
