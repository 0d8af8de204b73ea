//! Eigenvalues of small symmetric matrices.

/// Rounds of rotations; a few are enough.
const MOST_ROUNDS: usize = 60;
/// Beside their diagonals smaller entries are none: they would mix what has equal eigenvalues.
const ROUNDING: f64 = 1e4 * f64::EPSILON;

/// Eigenvalues and, as columns, eigenvectors of a symmetric matrix, by Jacobi's rotations.
pub(crate) fn eigen(mut a: Vec<Vec<f64>>) -> (Vec<f64>, Vec<Vec<f64>>) {
    let n = a.len();
    let mut v: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| f64::from(i == j)).collect()).collect();
    for _ in 0..MOST_ROUNDS {
        let pairs = (0..n).flat_map(|p| (p + 1..n).map(move |q| (p, q)));
        let is_open =
            |&(p, q): &(usize, usize)| a[p][q].abs() > ROUNDING * (a[p][p] * a[q][q]).abs().sqrt();
        let open: Vec<(usize, usize)> = pairs.filter(is_open).collect();
        if open.is_empty() {
            break;
        }
        open.into_iter().for_each(|(p, q)| rotate(&mut a, &mut v, p, q));
    }
    ((0..n).map(|i| a[i][i]).collect(), v)
}

/// Makes the entry of a pair 0.
fn rotate(a: &mut [Vec<f64>], v: &mut [Vec<f64>], p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let sign = if theta < 0.0 { -1.0 } else { 1.0 };
    let t = sign / (theta.abs() + theta.hypot(1.0));
    let c = t.hypot(1.0).recip();
    let turn = |x: &mut f64, y: &mut f64| (*x, *y) = (c * *x - t * c * *y, t * c * *x + c * *y);
    for row in a.iter_mut().chain(v.iter_mut()) {
        let (before, after) = row.split_at_mut(q);
        turn(&mut before[p], &mut after[0]);
    }
    let (before, after) = a.split_at_mut(q);
    before[p].iter_mut().zip(&mut after[0]).for_each(|(x, y)| turn(x, y));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvalues_of_a_matrix_that_is_known() {
        // Eigenvalues 1, 3 and 6: the columns of an orthogonal matrix, weighed and added up.
        let columns = [[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]];
        let values = [1.0, 3.0, 6.0];
        let entry = |i: usize, j: usize| -> f64 {
            (0..3).map(|k| values[k] * columns[k][i] * columns[k][j] / 9.0).sum()
        };
        let matrix = (0..3).map(|i| (0..3).map(|j| entry(i, j)).collect()).collect();
        let (mut found, vectors) = eigen(matrix);
        for k in 0..3 {
            let length: f64 = vectors.iter().map(|row| row[k] * row[k]).sum();
            assert!((length - 1.0).abs() < 1e-12, "{length}");
        }
        found.sort_by(f64::total_cmp);
        for (found, value) in found.iter().zip(values) {
            assert!((found - value).abs() < 1e-12, "{found} {value}");
        }
    }
}
