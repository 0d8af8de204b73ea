//! The Lagrange polynomials over some points: polynomial `j` is 1 at point `j` and 0 at the others.

/// The Lagrange polynomials over `points` at a time: exactly 0 and 1 at the points themselves.
pub fn values(points: &[f64], time: f64) -> Vec<f64> {
    let value = |j: usize| {
        let others = points.iter().enumerate().filter(|(l, _)| *l != j);
        others.map(|(_, other)| (time - other) / (points[j] - other)).product()
    };
    (0..points.len()).map(value).collect()
}

/// What the polynomial through `column` at its points is where these are the Lagrange polynomials:
/// of equal numbers exactly the same, so that what is at a bound stays there.
pub fn combined(weights: &[f64], column: impl Iterator<Item = f64> + Clone) -> f64 {
    let first = column.clone().next().unwrap_or(0.0);
    weights.iter().zip(column).fold(first, |sum, (w, value)| sum + w * (value - first))
}

/// The derivatives of the Lagrange polynomials over `points` at a time.
pub fn slopes(points: &[f64], time: f64) -> Vec<f64> {
    derivatives(points, time, 1)
}

/// Their derivatives of this order; [`values`] is more exact for 0.
pub fn derivatives(points: &[f64], time: f64, order: usize) -> Vec<f64> {
    let factor = |power: usize| (0..order).map(|i| (power - i) as f64).product::<f64>();
    let derivative = |polynomial: Vec<f64>| {
        let terms = polynomial.iter().enumerate().skip(order).rev();
        terms.fold(0.0, |sum, (power, c)| sum * time + factor(power) * c)
    };
    (0..points.len()).map(|j| derivative(coefficients(points, j))).collect()
}

/// The coefficients of the polynomial that is 1 at `points[j]` and 0 at the others, constant term
/// first.
pub fn coefficients(points: &[f64], j: usize) -> Vec<f64> {
    let others = points.iter().enumerate().filter(|(l, _)| *l != j);
    others.fold(vec![1.0], |polynomial, (_, root)| {
        let scale = 1.0 / (points[j] - root);
        let mut product = vec![0.0; polynomial.len() + 1];
        for (power, c) in polynomial.iter().enumerate() {
            product[power + 1] += scale * c;
            product[power] -= scale * root * c;
        }
        product
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_is_reproduced_exactly() {
        let points = [0.1, 0.3, 0.7, 0.9];
        let value = |k: usize| combined(&values(&points, 0.01 * k as f64), [0.3; 4].into_iter());
        assert!((0..100).all(|k| value(k) == 0.3));
    }

    #[test]
    fn a_polynomial_is_reproduced_with_its_slope() {
        let points = [0.5, 1.0, 2.0];
        let sum = |weights: Vec<f64>| -> f64 {
            weights.iter().zip(points).map(|(w, t)| w * (t * t - t)).sum()
        };
        assert!((sum(values(&points, 1.5)) - 0.75).abs() < 1e-15);
        assert!((sum(slopes(&points, 1.5)) - 2.0).abs() < 1e-14);
        assert!((sum(derivatives(&points, 1.5, 2)) - 2.0).abs() < 1e-14);
    }
}
