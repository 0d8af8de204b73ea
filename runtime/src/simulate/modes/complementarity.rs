//! Which selectors solve `-1 <= s <= 1`, `r(s) = a - B s`, `r_i > 0 => s_i = 1`, `r_i < 0 => s_i =
//! -1`.
//!
//! With `s = z - 1` and a multiplier `y` of `z <= 2` this is the linear complementarity problem
//! `w = M (z, y) + q`, `M = [B I; -I 0]`, `q = (-B 1 - a, 2)`, solved by Lemke's method (R. W.
//! Cottle, J.-S. Pang, R. E. Stone: The Linear Complementarity Problem, 4.4). If `B` is a P-matrix
//! the solution is unique. With an artificial variable in the rows of `z` alone the method ends on
//! no ray, whatever `B` is: along one neither `z` nor, by complementarity, `y` can grow.

use crate::simulate::tuning::complementarity::{MOST_MINORS, PIVOT, SINGULAR};
use nalgebra::{DMatrix, DVector};

/// Whether all principal minors are positive, as far as that can be told at bearable cost.
pub(crate) fn is_p_matrix(b: &DMatrix<f64>) -> bool {
    let size = b.nrows();
    if !b.iter().all(|value| value.is_finite()) {
        return false;
    }
    // Surfaces may have very different units; a positive factor of a row changes no sign of a
    // minor.
    let b = &row_scaled(b);
    let least = SINGULAR * b.amax();
    if (b + b.transpose() - DMatrix::from_diagonal_element(size, size, least)).cholesky().is_some()
    {
        return true;
    }
    let dominates = |i: usize| {
        let others: f64 = (0..size).filter(|&j| j != i).map(|j| b[(i, j)].abs()).sum();
        b[(i, i)] > others + least
    };
    (0..size).all(dominates) || size <= MOST_MINORS && minors_are_positive(b)
}

/// Rows divided by their largest entries.
fn row_scaled(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let scale = |i: usize| matrix.row(i).amax().max(f64::MIN_POSITIVE);
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] / scale(i))
}

fn minors_are_positive(b: &DMatrix<f64>) -> bool {
    (1_u32..1 << b.nrows()).all(|subset| {
        let rows: Vec<usize> = (0..b.nrows()).filter(|i| subset & (1 << i) != 0).collect();
        b.select_rows(&rows).select_columns(&rows).determinant()
            > SINGULAR * b.amax().powi(rows.len() as i32)
    })
}

/// Selectors for the affine rates `a - B s`; some, if there are several. `None` if rounding leads
/// the method astray.
pub(crate) fn selectors(a: &DVector<f64>, b: &DMatrix<f64>) -> Option<DVector<f64>> {
    let size = a.len();
    let scale = |i: usize| b.row(i).amax().max(a[i].abs()).max(f64::MIN_POSITIVE);
    let a = DVector::from_fn(size, |i, _| a[i] / scale(i));
    let b = &DMatrix::from_fn(size, size, |i, j| b[(i, j)] / scale(i));
    let mut m = DMatrix::zeros(2 * size, 2 * size);
    m.view_mut((0, 0), (size, size)).copy_from(b);
    for i in 0..size {
        m[(i, size + i)] = 1.0;
        m[(size + i, i)] = -1.0;
    }
    let row_sums = b.column_sum();
    let q = DVector::from_fn(2 * size, |i, _| if i < size { -row_sums[i] - a[i] } else { 2.0 });
    let z = lemke(&m, &q)?;
    Some(DVector::from_fn(size, |i, _| (z[i] - 1.0).clamp(-1.0, 1.0)))
}

/// Solves `w = M z + q`, `w, z >= 0`, `w . z = 0`.
fn lemke(m: &DMatrix<f64>, q: &DVector<f64>) -> Option<DVector<f64>> {
    let size = q.len();
    if q.iter().all(|value| *value >= 0.0) {
        return Some(DVector::zeros(size));
    }
    let mut tableau = Tableau::new(m, q);
    let mut entering = 2 * size;
    let mut row = (0..size).min_by(|&i, &j| q[i].total_cmp(&q[j]))?;
    for _ in 0..50 * size {
        let leaving = tableau.pivot(row, entering);
        if leaving == 2 * size {
            return Some(tableau.solution());
        }
        entering = if leaving < size { leaving + size } else { leaving - size };
        row = tableau.ratio_test(entering)?;
    }
    None
}

/// Columns `w`, `z`, the artificial variable, the right side; and which column each row is solved
/// for.
struct Tableau {
    rows: DMatrix<f64>,
    basis: Vec<usize>,
}

impl Tableau {
    fn new(m: &DMatrix<f64>, q: &DVector<f64>) -> Self {
        let size = q.len();
        let entry = |i: usize, j: usize| match j {
            _ if j < size => f64::from(u8::from(i == j)),
            _ if j < 2 * size => -m[(i, j - size)],
            _ if j == 2 * size => f64::from(i >= size / 2) - 1.0,
            _ => q[i],
        };
        Tableau { rows: DMatrix::from_fn(size, 2 * size + 2, entry), basis: (0..size).collect() }
    }

    /// Solves a row for a column; returns what that row was solved for.
    fn pivot(&mut self, row: usize, column: usize) -> usize {
        let scaled = self.rows.row(row) / self.rows[(row, column)];
        for other in 0..self.rows.nrows() {
            let factor = self.rows[(other, column)];
            let mut line = self.rows.row_mut(other);
            line -= &scaled * factor;
        }
        self.rows.row_mut(row).copy_from(&scaled);
        std::mem::replace(&mut self.basis[row], column)
    }

    /// The row that limits a growing column; the artificial variable leaves as soon as it may.
    fn ratio_test(&self, column: usize) -> Option<usize> {
        let last = self.rows.ncols() - 1;
        let limits = (0..self.rows.nrows()).filter(|&i| self.rows[(i, column)] > PIVOT);
        let ratio = |i: usize| self.rows[(i, last)] / self.rows[(i, column)];
        let least = limits.clone().map(ratio).fold(f64::INFINITY, f64::min);
        let ties = limits.filter(|&i| ratio(i) <= least + PIVOT * (1.0 + least.abs()));
        ties.max_by_key(|&i| self.basis[i] == last - 1)
    }

    fn solution(&self) -> DVector<f64> {
        let size = self.basis.len();
        let mut z = DVector::zeros(size);
        for (row, &column) in self.basis.iter().enumerate() {
            if (size..2 * size).contains(&column) {
                z[column - size] = self.rows[(row, self.rows.ncols() - 1)];
            }
        }
        z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solved(a: &[f64], b: &[f64]) -> Vec<f64> {
        let size = a.len();
        let b = DMatrix::from_row_slice(size, size, b);
        assert!(is_p_matrix(&b));
        selectors(&DVector::from_column_slice(a), &b)
            .expect("a P-matrix has a solution")
            .as_slice()
            .to_vec()
    }

    #[test]
    fn two_surfaces_slide_where_their_linear_system_says() {
        // 2 s1 + s2/2 = 3/10, -s1/2 + 2 s2 = 2/5 has the solution (8/85, 19/85).
        let s = solved(&[0.3, 0.4], &[2.0, 0.5, -0.5, 2.0]);
        assert!((s[0] - 8.0 / 85.0).abs() < 1e-15 && (s[1] - 19.0 / 85.0).abs() < 1e-15, "{s:?}");
    }

    #[test]
    fn the_units_of_the_surfaces_do_not_matter() {
        let s = solved(&[0.3e-9, 0.4e9], &[2e-9, 0.5e-9, -0.5e9, 2e9]);
        assert!((s[0] - 8.0 / 85.0).abs() < 1e-15 && (s[1] - 19.0 / 85.0).abs() < 1e-15, "{s:?}");
    }

    #[test]
    fn a_rate_that_no_selector_can_stop_crosses() {
        assert_eq!(solved(&[3.0], &[2.0]), [1.0]);
        assert_eq!(solved(&[-3.0], &[2.0]), [-1.0]);
    }

    #[test]
    fn solutions_satisfy_the_conditions_for_matrices_that_are_p_but_not_definite() {
        let b = [1.0, -3.0, 0.0, 1.0];
        for a in [[0.0, 0.0], [2.0, 0.5], [-5.0, 0.5], [0.3, -4.0]] {
            let s = solved(&a, &b);
            for i in 0..2 {
                let rate = a[i] - b[2 * i] * s[0] - b[2 * i + 1] * s[1];
                let holds = if s[i] == 1.0 {
                    rate >= -1e-12
                } else if s[i] == -1.0 {
                    rate <= 1e-12
                } else {
                    rate.abs() < 1e-12
                };
                assert!(holds, "a = {a:?}, s = {s:?}, rate {rate}");
            }
        }
    }

    #[test]
    fn repelling_surfaces_are_no_p_matrices() {
        assert!(!is_p_matrix(&DMatrix::from_element(1, 1, -1.0)));
        assert!(!is_p_matrix(&DMatrix::from_row_slice(2, 2, &[1.0, 3.0, 3.0, 1.0])));
    }

    #[test]
    fn there_are_selectors_whatever_the_matrix_is() {
        let a = DVector::from_column_slice(&[5.0, -5.0]);
        let repelling = DMatrix::from_row_slice(2, 2, &[-1.0, 0.5, -0.5, -1.0]);
        assert_eq!(selectors(&a, &repelling).expect("selectors").as_slice(), [1.0, -1.0]);
        let none = selectors(&a, &DMatrix::zeros(2, 2)).expect("selectors");
        assert_eq!(none.as_slice(), [1.0, -1.0]);
    }

    #[test]
    fn surfaces_of_which_one_follows_from_the_others_are_no_p_matrix() {
        assert!(!is_p_matrix(&DMatrix::from_row_slice(
            3,
            3,
            &[1.0, 0.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 2.0]
        )));
    }
}
