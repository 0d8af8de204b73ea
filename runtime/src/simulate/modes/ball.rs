//! The mixed complementarity problem with balls: `r(s) = a - B s`, on an interval as in
//! [`complementarity`](super::complementarity), and for each ball
//!
//! ```text
//! |s| <= 1,   r = lambda s,   lambda >= 0,   lambda (1 - |s|) = 0
//! ```
//!
//! For a given lambda the selectors of the ball are free in a linear system with `B + lambda I`. If
//! `B` is positive definite in some metric, `|s|` falls with lambda: one root for each ball, and
//! the solution is the only one.

use super::complementarity::{is_p_matrix, selectors};
use crate::simulate::field::direction::length;
use crate::simulate::location::bisect;
use crate::simulate::system::Ball;
use crate::simulate::tuning::ball::{MOST_SWEEPS, SETTLED, SINGULAR};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Where the balls stand among some surfaces.
pub(crate) fn blocks(balls: &[Ball], surfaces: &[usize]) -> Vec<Range<usize>> {
    let place = |ball: &Ball| {
        let first = surfaces.iter().position(|&surface| surface == ball.surfaces.start)?;
        Some(first..first + ball.surfaces.len())
    };
    balls.iter().filter_map(place).collect()
}

/// Whether the problem is known to have exactly one solution, whatever `a` is.
pub(crate) fn is_unique(b: &DMatrix<f64>, balls: &[Range<usize>]) -> bool {
    if balls.is_empty() {
        return is_p_matrix(b);
    }
    let alone = (0..b.nrows()).filter(|i| balls.iter().all(|ball| !ball.contains(i)));
    let units: Vec<Range<usize>> = balls.iter().cloned().chain(alone.map(|i| i..i + 1)).collect();
    b.iter().all(|value| value.is_finite())
        && coupled(b, &units).iter().all(|group| {
            let rows: Vec<usize> = group.iter().flat_map(|&unit| units[unit].clone()).collect();
            let part = b.select_rows(&rows).select_columns(&rows);
            let sizes: Vec<usize> = group.iter().map(|&unit| units[unit].len()).collect();
            is_positive_definite(&part, &sizes)
                || sizes.iter().all(|&size| size == 1) && is_p_matrix(&part)
        })
}

/// The largest entry of a block.
fn norm(b: &DMatrix<f64>, rows: &Range<usize>, columns: &Range<usize>) -> f64 {
    b.view((rows.start, columns.start), (rows.len(), columns.len())).amax()
}

/// The units that act on each other, directly or through others. One group after the other can be
/// solved.
fn coupled(b: &DMatrix<f64>, units: &[Range<usize>]) -> Vec<Vec<usize>> {
    let size = units.len();
    let mut acts =
        DMatrix::from_fn(size, size, |i, j| i == j || norm(b, &units[i], &units[j]) > 0.0);
    for through in 0..size {
        for (i, j) in (0..size).flat_map(|i| (0..size).map(move |j| (i, j))) {
            acts[(i, j)] |= acts[(i, through)] && acts[(through, j)];
        }
    }
    let group =
        |i: usize| -> Vec<usize> { (0..size).filter(|&j| acts[(i, j)] && acts[(j, i)]).collect() };
    (0..size)
        .map(|i| (i, group(i)))
        .filter(|(i, group)| group[0] == *i)
        .map(|(_, group)| group)
        .collect()
}

/// Whether `D B` has a positive definite symmetric part for positive factors `D`, one for each
/// unit: those that come nearest to making `D B` symmetric, or those that make its diagonal 1.
fn is_positive_definite(b: &DMatrix<f64>, sizes: &[usize]) -> bool {
    let firsts: Vec<usize> = (0..sizes.len()).map(|unit| sizes[..unit].iter().sum()).collect();
    let units: Vec<Range<usize>> =
        firsts.iter().zip(sizes).map(|(&first, size)| first..first + size).collect();
    let own = |unit: &Range<usize>| 1.0 / norm(b, unit, unit);
    [symmetric_weights(b, &units), units.iter().map(own).collect()]
        .iter()
        .any(|weights| is_definite_with(b, &units, weights))
}

fn is_definite_with(b: &DMatrix<f64>, units: &[Range<usize>], weights: &[f64]) -> bool {
    let mut weighted = b.clone();
    for (unit, weight) in units.iter().zip(weights) {
        weighted.rows_mut(unit.start, unit.len()).scale_mut(*weight);
    }
    let symmetric = &weighted + weighted.transpose();
    let scale = symmetric.diagonal().map(|value| 1.0 / value.max(0.0).sqrt());
    if !scale.iter().all(|value| value.is_finite()) {
        return false;
    }
    let scaled =
        DMatrix::from_fn(b.nrows(), b.nrows(), |i, j| symmetric[(i, j)] * scale[i] * scale[j]);
    (scaled - DMatrix::from_diagonal_element(b.nrows(), b.nrows(), SINGULAR)).cholesky().is_some()
}

fn symmetric_weights(b: &DMatrix<f64>, units: &[Range<usize>]) -> Vec<f64> {
    let mut weights: Vec<Option<f64>> = vec![None; units.len()];
    weights[0] = Some(1.0);
    for _ in 1..units.len() {
        for (i, j) in (0..units.len()).flat_map(|i| (0..units.len()).map(move |j| (i, j))) {
            let (to, back) = (norm(b, &units[i], &units[j]), norm(b, &units[j], &units[i]));
            if let (Some(weight), None) = (weights[i], weights[j])
                && to * back > 0.0
            {
                weights[j] = Some(weight * to / back);
            }
        }
    }
    weights.into_iter().map(|weight| weight.unwrap_or(1.0)).collect()
}

/// The selectors that solve the problem; `None` where they are not found.
pub(crate) fn solution(
    a: &DVector<f64>,
    b: &DMatrix<f64>,
    balls: &[Range<usize>],
) -> Option<DVector<f64>> {
    if balls.is_empty() {
        return selectors(a, b);
    }
    let mut lambda = vec![0.0; balls.len()];
    let largest = length(a.as_slice()) + b.norm() * (a.len() as f64).sqrt();
    for _ in 0..MOST_SWEEPS {
        let before = lambda.clone();
        for ball in 0..balls.len() {
            lambda[ball] = multiplier(a, b, balls, &lambda, ball, largest)?;
        }
        let change = lambda.iter().zip(&before).map(|(now, before)| (now - before).abs());
        if balls.len() == 1 || change.fold(0.0, f64::max) <= SETTLED * largest {
            return given(a, b, balls, &lambda).map(|s| clamped(s, balls));
        }
    }
    None
}

/// The lambda of one ball for those of the others.
fn multiplier(
    a: &DVector<f64>,
    b: &DMatrix<f64>,
    balls: &[Range<usize>],
    lambda: &[f64],
    ball: usize,
    largest: f64,
) -> Option<f64> {
    let mut lambda = lambda.to_vec();
    // `1/|s|` is almost linear in lambda.
    let mut excess = |value: f64| {
        lambda[ball] = value;
        given(a, b, balls, &lambda)
            .map_or(f64::NAN, |s| 1.0 - 1.0 / length(&s.as_slice()[balls[ball].clone()]))
    };
    let (at_low, at_high) = (excess(0.0), excess(largest));
    if at_low <= 0.0 {
        return Some(0.0);
    }
    (at_high <= 0.0).then(|| bisect(&mut excess, [0.0, at_low], [largest, at_high]))
}

/// The selectors for given lambdas: those of the balls are eliminated, the others remain in their
/// intervals.
fn given(
    a: &DVector<f64>,
    b: &DMatrix<f64>,
    balls: &[Range<usize>],
    lambda: &[f64],
) -> Option<DVector<f64>> {
    let mut shifted = b.clone();
    let inside: Vec<usize> = balls.iter().flat_map(|ball| ball.clone()).collect();
    let outside: Vec<usize> = (0..a.len()).filter(|i| !inside.contains(i)).collect();
    for (ball, lambda) in balls.iter().zip(lambda) {
        ball.clone().for_each(|i| shifted[(i, i)] += lambda);
    }
    let part =
        |rows: &[usize], columns: &[usize]| shifted.select_rows(rows).select_columns(columns);
    let own = part(&inside, &inside).lu();
    let (from_a, from_outside) =
        (own.solve(&a.select_rows(&inside))?, own.solve(&part(&inside, &outside))?);
    let back = part(&outside, &inside);
    let s_outside = match outside.is_empty() {
        true => DVector::zeros(0),
        false => selectors(
            &(a.select_rows(&outside) - &back * &from_a),
            &(part(&outside, &outside) - &back * &from_outside),
        )?,
    };
    let s_inside = from_a - from_outside * &s_outside;
    let mut s = DVector::zeros(a.len());
    inside.iter().zip(s_inside.iter()).for_each(|(&i, value)| s[i] = *value);
    outside.iter().zip(s_outside.iter()).for_each(|(&i, value)| s[i] = *value);
    Some(s)
}

fn clamped(mut s: DVector<f64>, balls: &[Range<usize>]) -> DVector<f64> {
    for ball in balls {
        let size = length(&s.as_slice()[ball.clone()]);
        if size > 1.0 {
            s.rows_mut(ball.start, ball.len()).unscale_mut(size);
        }
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solved(a: &[f64], b: &[f64], balls: &[Range<usize>]) -> Vec<f64> {
        let b = DMatrix::from_row_slice(a.len(), a.len(), b);
        assert!(is_unique(&b, balls));
        solution(&DVector::from_column_slice(a), &b, balls)
            .expect("there is one")
            .as_slice()
            .to_vec()
    }

    #[test]
    fn a_small_force_is_balanced_and_a_large_one_gives_its_direction() {
        let disc = 0..2;
        let small = solved(&[0.3, 0.4], &[2.0, 0.0, 0.0, 2.0], std::slice::from_ref(&disc));
        let large = solved(&[3.0, 4.0], &[2.0, 0.0, 0.0, 2.0], std::slice::from_ref(&disc));
        assert!((small[0] - 0.15).abs() < 1e-15 && (small[1] - 0.2).abs() < 1e-15, "{small:?}");
        assert!((large[0] - 0.6).abs() < 1e-15 && (large[1] - 0.8).abs() < 1e-15, "{large:?}");
    }

    /// Every random problem of a positive definite matrix: the residual of `r = lambda s` and of
    /// the interval.
    #[test]
    fn solutions_satisfy_the_conditions() {
        let b = [2.0, 0.3, 0.5, -0.3, 1.5, -0.2, 0.1, 0.4, 1.0];
        let disc = 0..2;
        for k in 0..50 {
            let a = [3.0 * f64::from(k).sin(), 2.0 * f64::from(k).cos(), f64::from(k % 7) - 3.0];
            let s = solved(&a, &b, std::slice::from_ref(&disc));
            let r: Vec<f64> =
                (0..3).map(|i| a[i] - (0..3).map(|j| b[3 * i + j] * s[j]).sum::<f64>()).collect();
            let (size, along) = (length(&s[..2]), r[0] * s[0] + r[1] * s[1]);
            let across = (r[0] - along * s[0]).hypot(r[1] - along * s[1]);
            let is_inside = size < 1.0 - 1e-12 && length(&r[..2]) < 1e-12;
            assert!(
                is_inside || (size - 1.0).abs() < 1e-14 && along > -1e-12 && across < 1e-12,
                "{a:?}"
            );
            let fits = (s[2].abs() < 1.0 && r[2].abs() < 1e-12) || r[2] * s[2] >= -1e-12;
            assert!(fits, "{a:?}: {s:?} {r:?}");
        }
    }

    /// Two discs on each other, the upper one light: `B` is far from symmetric, the kinetic energy
    /// makes it so.
    #[test]
    fn weights_of_the_kinetic_energy_are_found() {
        let b = DMatrix::from_row_slice(2, 2, &[30.0, -0.1, -30.0, 0.2]);
        assert!(is_unique(&b, &[0..1, 1..2]));
        let disc = 0..2;
        let disc = std::slice::from_ref(&disc);
        assert!(!is_unique(&DMatrix::from_row_slice(2, 2, &[1.0, 3.0, 3.0, 1.0]), disc));
        assert!(!is_unique(&-DMatrix::identity(2, 2), disc));
    }
}
