//! Polynomials over [0, 1] by their Bernstein coefficients: a polynomial stays between the least
//! and the greatest of them. R. T. Farouki: The Bernstein polynomial basis: a centennial
//! retrospective, CAGD 29 (2012) 379-419.
//!
//! A polynomial that is constant is exactly so: a control at its bound stays there, and a rate that
//! it makes 0 is no noise.

/// The coefficients of the polynomial with these values at some nodes, which differ.
pub(crate) fn through(nodes: &[f64], values: &[f64]) -> Vec<f64> {
    let mut sum = vec![values[0]; nodes.len()];
    for (j, value) in values.iter().enumerate().skip(1) {
        let one = lagrange(nodes, j);
        sum.iter_mut().zip(one).for_each(|(sum, c)| *sum += (value - values[0]) * c);
    }
    sum
}

/// Of the polynomial that is 1 at node `j` and 0 at the others, factor by factor.
fn lagrange(nodes: &[f64], j: usize) -> Vec<f64> {
    let others = nodes.iter().enumerate().filter(|(l, _)| *l != j);
    others.fold(vec![1.0], |product, (_, root)| {
        let ends = [0.0, 1.0].map(|end| (end - root) / (nodes[j] - root));
        let degree = product.len();
        let term = |c: Option<&f64>, part: usize| c.map_or(0.0, |c| c * part as f64);
        let coefficient = |i: usize| {
            let before = i.checked_sub(1).and_then(|before| product.get(before));
            let (low, high) = (term(product.get(i), degree - i), term(before, i));
            (ends[0] * low + ends[1] * high) / degree as f64
        };
        (0..=degree).map(coefficient).collect()
    })
}

/// The derivative.
pub(crate) fn slopes(coefficients: &[f64]) -> Vec<f64> {
    let degree = coefficients.len() - 1;
    coefficients.windows(2).map(|pair| degree as f64 * (pair[1] - pair[0])).collect()
}

/// The value at a point.
pub(crate) fn value(coefficients: &[f64], at: f64) -> f64 {
    let (degree, rest) = (coefficients.len() - 1, 1.0 - at);
    let (mut sum, mut power, mut binomial) = (0.0, 1.0, 1.0);
    for (i, c) in coefficients.iter().enumerate().skip(1) {
        power *= at;
        binomial *= (degree + 1 - i) as f64 / i as f64;
        sum = sum * rest + power * binomial * (c - coefficients[0]);
    }
    coefficients[0] + sum
}

/// The coefficients over a part of [0, 1], by de Casteljau's algorithm.
pub(crate) fn restrict(coefficients: &mut [f64], [from, to]: [f64; 2]) {
    let degree = coefficients.len() - 1;
    for turn in (1..=degree).filter(|_| to < 1.0) {
        for k in (turn..=degree).rev() {
            let before = coefficients[k - 1];
            coefficients[k] = before + to * (coefficients[k] - before);
        }
    }
    let from = if to > 0.0 { from / to } else { 0.0 };
    for turn in (1..=degree).filter(|_| from > 0.0) {
        for k in 0..=degree - turn {
            coefficients[k] += from * (coefficients[k + 1] - coefficients[k]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `x^3 = (0, 0, 0, 1)`; over [1/2, 1] its coefficients are the products of three of the ends.
    #[test]
    fn a_part_of_a_polynomial_has_the_blossoms_of_its_ends() {
        let mut cube = [0.0, 0.0, 0.0, 1.0];
        restrict(&mut cube, [0.5, 1.0]);
        assert_eq!(cube, [0.125, 0.25, 0.5, 1.0]);
        restrict(&mut cube, [0.0, 0.5]);
        assert_eq!(cube, [0.125, 0.1875, 0.28125, 0.421875]);
    }

    #[test]
    fn a_constant_is_reproduced_exactly() {
        let mut constant = through(&[0.07, 0.33, 0.67, 0.93], &[0.3; 4]);
        assert!((0..=100).all(|k| value(&constant, 0.01 * f64::from(k)) == 0.3));
        restrict(&mut constant, [0.1, 0.7]);
        assert_eq!(constant, [0.3; 4]);
    }

    /// `x^2 - x + 1`, whose coefficients are `1, 1/2, 1`.
    #[test]
    fn values_at_nodes_make_a_polynomial() {
        let square = through(&[0.25, 0.5, 1.0], &[0.8125, 0.75, 1.0]);
        assert!(square.iter().zip([1.0, 0.5, 1.0]).all(|(a, b)| (a - b).abs() < 1e-15));
        assert!((value(&square, 0.3) - 0.79).abs() < 1e-15);
        assert!((value(&slopes(&square), 0.3) + 0.4).abs() < 1e-15);
    }
}
