//! Solutions and inertia of matrices that need pivots, against dense eigenvalues.

use super::multifrontal::Multifrontal;
use super::pairs::Pairs;
use crate::linalg::structure::columns::Columns;
use crate::random::Random;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// A random symmetric matrix with about `fill` entries in each row; every entry of the diagonal is
/// in the pattern, if only as a zero.
fn sparse(size: usize, fill: usize, has_diagonal: bool, random: &mut Random) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(size, size);
    for i in 0..size {
        matrix[(i, i)] = if has_diagonal { random.next() } else { 0.0 };
        for _ in 0..fill {
            let j = random.below(size);
            if i != j {
                matrix[(i, j)] = random.next();
                matrix[(j, i)] = matrix[(i, j)];
            }
        }
    }
    matrix
}

/// `[H J'; J 0]`
fn saddle(hessian: &DMatrix<f64>, jacobian: &DMatrix<f64>) -> DMatrix<f64> {
    let (n, rows) = (hessian.nrows(), jacobian.nrows());
    let mut matrix = DMatrix::zeros(n + rows, n + rows);
    matrix.view_mut((0, 0), (n, n)).copy_from(hessian);
    matrix.view_mut((n, 0), (rows, n)).copy_from(jacobian);
    matrix.view_mut((0, n), (n, rows)).copy_from(&jacobian.transpose());
    matrix
}

fn jacobian(rows: usize, columns: usize, random: &mut Random) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(rows, columns);
    for i in 0..rows {
        matrix[(i, i)] = 1.0;
        (0..3).for_each(|_| matrix[(i, random.below(columns))] += random.next());
    }
    matrix
}

fn upper(matrix: &DMatrix<f64>) -> Columns {
    let places = (0..matrix.ncols()).flat_map(|j| (0..=j).map(move |i| (i, j)));
    let entries = places.map(|(i, j)| (i, j, matrix[(i, j)]));
    let entries: Vec<_> = entries.filter(|(i, j, value)| i == j || *value != 0.0).collect();
    Columns::of_entries(&entries, matrix.nrows(), matrix.ncols())
}

fn factor(matrix: &DMatrix<f64>) -> (Multifrontal, Option<usize>) {
    let columns = upper(matrix);
    let values = columns.values.clone();
    let mut factors = Multifrontal::new(columns);
    let negative = factors.factor(&values);
    (factors, negative)
}

/// The law: the backward error is rounding, after refinement in each row, and the inertia is that
/// of the eigenvalues. `scaled` has the same inertia, and eigenvalues that can be told from 0.
fn check(what: &str, matrix: &DMatrix<f64>, scaled: &DMatrix<f64>) -> bool {
    let eigenvalues = SymmetricEigen::new(scaled.clone()).eigenvalues;
    if eigenvalues.iter().any(|value| value.abs() <= 1e-9 * eigenvalues.amax()) {
        return false;
    }
    let (mut factors, negative) = factor(matrix);
    let expected = eigenvalues.iter().filter(|value| **value < 0.0).count();
    assert_eq!(negative, Some(expected), "{what}: inertia");
    let right = DVector::from_fn(matrix.nrows(), |i, _| 1.0 + (i % 7) as f64);
    let mut x = DVector::zeros(matrix.nrows());
    for _ in 0..3 {
        let mut correction = (&right - matrix * &x).as_slice().to_vec();
        factors.solve(&mut correction);
        x += DVector::from_vec(correction);
    }
    let residual = matrix * &x - &right;
    let size = matrix.abs() * x.abs() + right.abs();
    let worst = residual.iter().zip(&size).fold(0.0, |worst: f64, (r, s)| worst.max(r.abs() / s));
    assert!(worst < 1e-10, "{what}: backward error {worst}");
    true
}

#[test]
fn indefinite_matrices_are_solved_and_their_inertia_is_that_of_the_eigenvalues() {
    let (mut random, mut checked) = (Random(3), 0);
    for case in 0..300 {
        let size = 1 + case % 60;
        let matrix = sparse(size, 1 + case % 4, case % 3 != 0, &mut random);
        checked += usize::from(check(&format!("case {case}"), &matrix, &matrix));
    }
    assert!(checked > 200, "{checked}");
}

/// Rows without a diagonal, as equalities are, among variables without curvature.
#[test]
fn zero_diagonals_need_no_shift() {
    let (mut random, mut checked) = (Random(5), 0);
    for case in 0..200 {
        let (n, rows) = (2 + case % 40, 1 + case % 20);
        let mut hessian = DMatrix::zeros(n, n);
        (0..n).filter(|i| i % 2 == case % 2).for_each(|i| hessian[(i, i)] = random.next());
        let matrix = saddle(&hessian, &jacobian(rows.min(n), n, &mut random));
        checked += usize::from(check(&format!("case {case}"), &matrix, &matrix));
    }
    assert!(checked > 50, "{checked}");
}

/// Rows and columns in units that differ by up to twelve orders.
#[test]
fn badly_scaled_matrices_keep_their_inertia() {
    let (mut random, mut checked) = (Random(9), 0);
    for case in 0..200 {
        let n = 5 + case % 30;
        let hessian = sparse(n, 2, true, &mut random);
        let scaled = saddle(&hessian, &jacobian(n / 2, n, &mut random));
        let units = DVector::from_fn(scaled.nrows(), |_, _| 10f64.powf(6.0 * random.next()));
        let units = DMatrix::from_diagonal(&units);
        let matrix = &units * &scaled * &units;
        checked += usize::from(check(&format!("case {case}"), &matrix, &scaled));
    }
    assert!(checked > 150, "{checked}");
}

/// A chain as optimal control problems have it: a pivot of every row lies in another.
#[test]
fn rows_that_wait_for_a_pivot_are_eliminated_further_up() {
    let size = 400;
    let mut matrix = DMatrix::zeros(size, size);
    for i in 0..size - 1 {
        matrix[(i, i + 1)] = 1.0;
        matrix[(i + 1, i)] = 1.0;
    }
    let (_, negative) = factor(&matrix);
    assert_eq!(negative, Some(size / 2));
}

/// Of whole numbers, so that nothing is rounded.
#[test]
fn the_same_row_twice_is_singular() {
    let mut random = Random(13);
    for case in 0..100 {
        let n = 4 + case % 30;
        let mut jacobian = jacobian(2, n, &mut random).map(|value| (4.0 * value).round());
        let twice = jacobian.row(0) * 2.0;
        jacobian.row_mut(1).copy_from(&twice);
        let matrix = saddle(&DMatrix::identity(n, n), &jacobian);
        assert_eq!(factor(&matrix).1, None, "case {case}");
    }
}

/// Whether rows depend on each other is then hidden by rounding; shifted, they do not.
#[test]
fn dependent_rows_that_are_shifted_are_regular() {
    let mut random = Random(15);
    for case in 0..100 {
        let (n, rows) = (10 + case % 30, 4 + case % 5);
        let mut jacobian = jacobian(rows, n, &mut random);
        let combined = jacobian.row(0) * 0.7 - jacobian.row(1) * 1.3;
        jacobian.row_mut(rows - 1).copy_from(&combined);
        let mut matrix = saddle(&DMatrix::identity(n, n), &jacobian);
        (n..n + rows).for_each(|i| matrix[(i, i)] = -1e-8);
        assert_eq!(factor(&matrix).1, Some(rows), "case {case}");
    }
}

#[test]
fn what_is_no_number_and_what_is_empty_is_singular() {
    assert_eq!(factor(&DMatrix::zeros(3, 3)).1, None);
    let mut matrix = DMatrix::identity(3, 3);
    matrix[(1, 1)] = f64::NAN;
    assert_eq!(factor(&matrix).1, None);
    assert_eq!(factor(&DMatrix::zeros(0, 0)).1, Some(0));
}

/// The same analysis serves every set of values.
#[test]
fn a_second_factorisation_forgets_the_first() {
    let mut random = Random(17);
    let first = sparse(30, 3, true, &mut random);
    let (mut factors, found) = factor(&first);
    let columns = upper(&first);
    let opposite: Vec<f64> = columns.values.iter().map(|value| -value).collect();
    assert_eq!(factors.factor(&opposite), found.map(|negative| 30 - negative));
    assert_eq!(factors.factor(&columns.values), found);
}

/// `x_{k+1} = x_k + u_k`: nothing but the controls has a curvature.
#[test]
fn every_row_of_a_chain_has_a_variable_for_its_partner() {
    let steps = 20;
    let variables = 2 * steps + 1;
    let hessian = DMatrix::from_fn(variables, variables, |i, j| f64::from(i == j && i > steps));
    let jacobian = DMatrix::from_fn(steps, variables, |k, j| match j {
        _ if j == k + 1 => 1.0,
        _ if j == k || j == steps + 1 + k => -1.0,
        _ => 0.0,
    });
    let columns = upper(&saddle(&hessian, &jacobian));
    let pairs = Pairs::of(&columns, |_, _, value| columns.values[value]);
    for row in variables..variables + steps {
        assert!(pairs.partner(row) < variables, "row {row}");
        assert_eq!(pairs.partner(pairs.partner(row)), row);
    }
}

/// The optimality conditions of `x_{k+1} = A x_k + B u_k` with a given end, in which nothing but
/// the controls has a curvature.
fn controlled(steps: usize, random: &mut Random) -> DMatrix<f64> {
    let (states, controls) = (5, 2);
    let stage = states + controls;
    let variables = steps * stage + states;
    let mut curvature = DMatrix::zeros(variables, variables);
    let mut rates = DMatrix::zeros((steps + 1) * states, variables);
    for k in 0..steps {
        (k * stage + states..(k + 1) * stage).for_each(|j| curvature[(j, j)] = 1.0);
        for i in 0..states {
            let row = k * states + i;
            (0..states).for_each(|j| rates[(row, k * stage + j)] = 0.1 * random.next());
            (states..stage).for_each(|j| rates[(row, k * stage + j)] = random.next());
            rates[(row, k * stage + i)] += 1.0;
            rates[(row, (k + 1) * stage + i)] = -1.0;
        }
    }
    (0..states).for_each(|i| rates[(steps * states + i, variables - states + i)] = 1.0);
    saddle(&curvature, &rates)
}

/// No pivot passes a threshold above 1, so rows wait until the fronts are full.
#[test]
fn full_fronts_lower_the_threshold_and_the_solution_is_accurate() {
    let matrix = controlled(60, &mut Random(19));
    let columns = upper(&matrix);
    let values = columns.values.clone();
    let mut factors = Multifrontal::new(columns);
    factors.front.threshold = 1e3;
    assert_eq!(factors.factor(&values), Some(305), "as many as there are equations");
    let lowered = factors.front.threshold;
    assert!((1e-6..1.0).contains(&lowered), "{lowered}");
    let exact = DVector::from_fn(matrix.nrows(), |i, _| 1.0 + (i % 7) as f64);
    let mut x = (&matrix * &exact).as_slice().to_vec();
    factors.solve(&mut x);
    let error = (DVector::from_vec(x) - exact).amax();
    assert!(error < 1e-6, "{error}");
    assert_eq!(factors.factor(&values), Some(305));
    assert_eq!(factors.front.threshold, lowered, "a threshold that served stays");
}
