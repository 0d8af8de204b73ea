//! `P A P' = L D L'` of one small dense symmetric indefinite matrix, with its inertia.
//!
//! Bunch-Kaufman pivoting (Golub & Van Loan, 4th ed., algorithm 4.4.4): `D` has blocks of size 1
//! and 2, so that no matrix is refused but a singular one, and the signs of `D` are the inertia.

use super::lu::swap_rows;

/// Factors of an `n x n` symmetric matrix.
#[derive(Clone, Debug, Default)]
pub(crate) struct SymmetricFactor {
    n: usize,
    /// Lower triangle: `L` below the blocks of `D`.
    factors: Vec<f64>,
    /// Row exchanged with step `k`'s pivot row; for a 2x2 block, with its second row.
    exchanges: Vec<usize>,
    /// Size of the block that begins at `k`; 0 in the second row of a block.
    blocks: Vec<u8>,
}

/// Bunch & Kaufman's constant, (1 + sqrt 17) / 8: equal growth for both kinds of blocks.
const ALPHA: f64 = 0.640_388_203_202_208;

impl SymmetricFactor {
    pub(crate) fn new(n: usize) -> Self {
        SymmetricFactor { n, factors: vec![0.0; n * n], exchanges: vec![0; n], blocks: vec![0; n] }
    }

    /// Factors the symmetric `matrix` (only its lower triangle is read). Returns the number of
    /// negative eigenvalues, or `None` if the matrix is singular to working precision.
    pub(crate) fn factor(&mut self, matrix: &[f64]) -> Option<usize> {
        let n = self.n;
        self.factors.copy_from_slice(matrix);
        let scale = matrix.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let tiny = f64::EPSILON * f64::EPSILON * scale.max(f64::MIN_POSITIVE);
        let (mut k, mut negative) = (0, 0);
        while k < n {
            let size = self.choose_pivot(k);
            negative += self.pivot_block(k, size, tiny)?;
            k += size;
        }
        Some(negative)
    }

    fn at(&self, i: usize, j: usize) -> f64 {
        self.factors[i * self.n + j]
    }

    /// Decides on the block at `k` and brings its rows into place.
    fn choose_pivot(&mut self, k: usize) -> usize {
        self.exchanges[k] = k;
        let (r, lambda) = self.largest_below(k, k);
        if lambda == 0.0 || self.at(k, k).abs() >= ALPHA * lambda {
            return 1;
        }
        let sigma = self.largest_off_diagonal(r, k);
        if self.at(k, k).abs() * sigma >= ALPHA * lambda * lambda {
            return 1;
        }
        if self.at(r, r).abs() >= ALPHA * sigma {
            self.exchange(k, k, r);
            self.exchanges[k] = r;
            return 1;
        }
        self.exchange(k, k + 1, r);
        self.exchanges[k + 1] = r;
        2
    }

    fn largest_below(&self, column: usize, k: usize) -> (usize, f64) {
        (k + 1..self.n)
            .map(|i| (i, self.at(i, column).abs()))
            .fold((k, 0.0), |a, b| if b.1 > a.1 { b } else { a })
    }

    /// Largest entry of row/column `r` of the trailing matrix that begins at `k`, without its
    /// diagonal.
    fn largest_off_diagonal(&self, r: usize, k: usize) -> f64 {
        let left = (k..r).map(|j| self.at(r, j).abs());
        let below = (r + 1..self.n).map(|i| self.at(i, r).abs());
        left.chain(below).fold(0.0, f64::max)
    }

    /// Exchanges rows and columns `a < b` of the trailing matrix that begins at `k`. The columns of
    /// `L` before it stay as they are: the solves exchange as they go.
    fn exchange(&mut self, k: usize, a: usize, b: usize) {
        if a == b {
            return;
        }
        let n = self.n;
        for j in k..a {
            self.factors.swap(a * n + j, b * n + j);
        }
        self.factors.swap(a * n + a, b * n + b);
        for i in a + 1..b {
            self.factors.swap(i * n + a, b * n + i);
        }
        for i in b + 1..n {
            self.factors.swap(i * n + a, i * n + b);
        }
    }

    /// Eliminates the block at `k`; returns its number of negative eigenvalues.
    fn pivot_block(&mut self, k: usize, size: usize, tiny: f64) -> Option<usize> {
        self.blocks[k] = size as u8;
        if size == 1 { self.pivot_one(k, tiny) } else { self.pivot_two(k, tiny) }
    }

    fn pivot_one(&mut self, k: usize, tiny: f64) -> Option<usize> {
        let n = self.n;
        let pivot = self.at(k, k);
        if pivot.is_nan() || pivot.abs() <= tiny {
            return None;
        }
        for i in k + 1..n {
            let factor = self.at(i, k) / pivot;
            for j in k + 1..=i {
                self.factors[i * n + j] -= factor * self.at(j, k);
            }
        }
        for i in k + 1..n {
            self.factors[i * n + k] /= pivot;
        }
        Some(usize::from(pivot < 0.0))
    }

    fn pivot_two(&mut self, k: usize, tiny: f64) -> Option<usize> {
        let n = self.n;
        self.blocks[k + 1] = 0;
        let (a, b, c) = (self.at(k, k), self.at(k + 1, k), self.at(k + 1, k + 1));
        let determinant = a * c - b * b;
        if determinant.is_nan() || determinant.abs() <= tiny * tiny {
            return None;
        }
        for i in k + 2..n {
            let (p, q) = (self.at(i, k), self.at(i, k + 1));
            let (l1, l2) = ((c * p - b * q) / determinant, (a * q - b * p) / determinant);
            for j in k + 2..=i {
                // Rows above i already hold their L, so their products with D are recomputed from
                // it.
                let (s, t) = if j == i { (p, q) } else { self.times_block(j, k, a, b, c) };
                self.factors[i * n + j] -= l1 * s + l2 * t;
            }
            self.factors[i * n + k] = l1;
            self.factors[i * n + k + 1] = l2;
        }
        Some(if determinant < 0.0 {
            1
        } else if a < 0.0 {
            2
        } else {
            0
        })
    }

    fn times_block(&self, row: usize, k: usize, a: f64, b: f64, c: f64) -> (f64, f64) {
        let (l1, l2) = (self.at(row, k), self.at(row, k + 1));
        (a * l1 + b * l2, b * l1 + c * l2)
    }

    /// Replaces the `n x columns` matrix `b` (row by row) by `A^-1 b`.
    pub(crate) fn solve(&self, b: &mut [f64], columns: usize) {
        self.forward(b, columns);
        self.diagonal(b, columns);
        self.backward(b, columns);
    }

    fn forward(&self, b: &mut [f64], columns: usize) {
        let mut k = 0;
        while k < self.n {
            let size = self.blocks[k] as usize;
            let exchanged = k + size - 1;
            swap_rows(b, columns, exchanged, self.exchanges[exchanged]);
            for i in k + size..self.n {
                for p in k..k + size {
                    add_row(b, columns, i, p, -self.at(i, p));
                }
            }
            k += size;
        }
    }

    fn diagonal(&self, b: &mut [f64], columns: usize) {
        let mut k = 0;
        while k < self.n {
            let size = self.blocks[k] as usize;
            for j in 0..columns {
                if size == 1 {
                    b[k * columns + j] /= self.at(k, k);
                } else {
                    let (a, o, c) = (self.at(k, k), self.at(k + 1, k), self.at(k + 1, k + 1));
                    let (p, q) = (b[k * columns + j], b[(k + 1) * columns + j]);
                    let determinant = a * c - o * o;
                    b[k * columns + j] = (c * p - o * q) / determinant;
                    b[(k + 1) * columns + j] = (a * q - o * p) / determinant;
                }
            }
            k += size;
        }
    }

    fn backward(&self, b: &mut [f64], columns: usize) {
        let mut end = self.n;
        while end > 0 {
            let size = if self.blocks[end - 1] == 0 { 2 } else { 1 };
            let k = end - size;
            for p in k..end {
                for i in end..self.n {
                    add_row(b, columns, p, i, -self.at(i, p));
                }
            }
            swap_rows(b, columns, end - 1, self.exchanges[end - 1]);
            end = k;
        }
    }
}

fn add_row(b: &mut [f64], columns: usize, target: usize, source: usize, factor: f64) {
    if factor != 0.0 {
        for j in 0..columns {
            b[target * columns + j] += factor * b[source * columns + j];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use nalgebra::{DMatrix, DVector, SymmetricEigen};

    /// Random symmetric matrices with zero diagonals, small pivots and every size up to 12.
    fn matrices() -> impl Iterator<Item = DMatrix<f64>> {
        let mut random = Random(1);
        (0..600).map(move |case| {
            let n = 1 + case % 12;
            let mut a = DMatrix::from_fn(n, n, |_, _| 0.5 * random.next());
            if case % 3 == 0 {
                a.fill_diagonal(0.0);
            }
            if case % 7 == 0 {
                a *= 1e-9;
            }
            &a + a.transpose()
        })
    }

    #[test]
    fn solutions_satisfy_their_system_and_inertia_is_that_of_the_eigenvalues() {
        for a in matrices() {
            let n = a.nrows();
            let eigenvalues = SymmetricEigen::new(a.clone()).eigenvalues;
            if eigenvalues.iter().any(|value| value.abs() <= 1e-6 * eigenvalues.amax()) {
                continue;
            }
            let mut factor = SymmetricFactor::new(n);
            let negative = factor.factor(a.transpose().as_slice()).expect("not singular");
            assert_eq!(negative, eigenvalues.iter().filter(|value| **value < 0.0).count());
            let right = DVector::from_fn(n, |i, _| 1.0 + i as f64);
            let mut x = right.as_slice().to_vec();
            factor.solve(&mut x, 1);
            let residual = &a * DVector::from_vec(x.clone()) - &right;
            let size = a.amax() * DVector::from_vec(x).amax() + right.amax();
            assert!(residual.amax() < 1e-12 * size, "residual {} for {a}", residual.amax());
        }
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        assert_eq!(SymmetricFactor::new(2).factor(&[0.0, 0.0, 0.0, 0.0]), None);
        assert_eq!(SymmetricFactor::new(2).factor(&[f64::NAN, 0.0, 0.0, 1.0]), None);
    }
}
