//! Nodes of Gauss and Radau, and the weights of any rule over given points, from their definitions
//! alone.

use nalgebra::{DMatrix, DVector};

/// The roots of the shifted Legendre polynomial `P_s`.
pub fn gauss(s: usize) -> Vec<f64> {
    roots(|c| legendre(s, 2.0 * c - 1.0))
}

/// The roots of `P_s - P_{s-1}`, shifted; the last is 1.
pub fn radau(s: usize) -> Vec<f64> {
    let difference = |c: f64| legendre(s, 2.0 * c - 1.0) - legendre(s - 1, 2.0 * c - 1.0);
    roots(difference).into_iter().chain([1.0]).collect()
}

/// By Bonnet's recursion.
fn legendre(s: usize, x: f64) -> f64 {
    let step = |(before, now): (f64, f64), i: usize| {
        (now, ((2 * i + 1) as f64 * x * now - i as f64 * before) / (i + 1) as f64)
    };
    (0..s).fold((0.0, 1.0), step).1
}

/// Inside of (0, 1), by bisection between changes of sign.
fn roots(function: impl Fn(f64) -> f64) -> Vec<f64> {
    const CELLS: usize = 1001;
    let edge = |i: usize| i as f64 / CELLS as f64;
    let cells = (0..CELLS).map(|i| (edge(i), edge(i + 1).min(1.0 - 1e-9)));
    let root = |(mut low, mut high): (f64, f64)| {
        (function(low) * function(high) < 0.0).then(|| {
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if function(low) * function(middle) <= 0.0 { high = middle } else { low = middle }
            }
            0.5 * (low + high)
        })
    };
    cells.filter_map(root).collect()
}

/// What a linear functional, which has the value `moment(q)` on `t^q`, is on the polynomial through
/// values at the points.
pub fn weights(points: &[f64], moment: impl Fn(i32) -> f64) -> Vec<f64> {
    let size = points.len();
    let powers = DMatrix::from_fn(size, size, |q, j| points[j].powi(q as i32));
    let moments = DVector::from_fn(size, |q, _| moment(q as i32));
    powers.lu().solve(&moments).expect("points that differ").as_slice().to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_points_of_gauss_and_radau_are_known() {
        let q = 3f64.sqrt() / 6.0;
        assert!((gauss(2)[0] - 0.5 + q).abs() < 1e-15 && (gauss(2)[1] - 0.5 - q).abs() < 1e-15);
        assert!((radau(2)[0] - 1.0 / 3.0).abs() < 1e-15 && radau(2).len() == 2);
        let b = weights(&radau(2), |q| 1.0 / f64::from(q + 1));
        assert!((b[0] - 0.75).abs() < 1e-15 && (b[1] - 0.25).abs() < 1e-15);
    }
}
