//! Collocation: on each interval the states are polynomials that satisfy the differential equation
//! at the nodes `c_j`.
//!
//! With the Lagrange polynomials `l_j` over `0, c_1 ... c_s`, the states `X_j` at the nodes, `X_0 =
//! x_k`, and `h = 1/N`:
//!
//! ```text
//!     sum_j l_j'(c_i) X_j - h F(tau_k + c_i h, X_i, u_k) = 0        i = 1 ... s
//!     x_{k+1} - sum_j l_j(1) X_j = 0                    where the last node is not the end
//! ```
//!
//! That is the implicit Runge-Kutta scheme of these nodes, written with derivatives of the
//! polynomial instead of its integrals: each row sees one evaluation of the right side only.
//! Integrals take the weights of the nodes, so that they have the order of the scheme: `2s - 1` for
//! Radau IIA, `2s` for Gauss.

use crate::lagrange::coefficients;

/// The weights of the nodes: the integrals of their Lagrange polynomials over the interval.
pub(crate) fn weights(nodes: &[f64]) -> Vec<f64> {
    let integral = |polynomial: Vec<f64>| {
        polynomial.iter().enumerate().map(|(power, c)| c / (power + 1) as f64).sum()
    };
    (0..nodes.len()).map(|j| integral(coefficients(nodes, j))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lagrange::{slopes, values};
    use crate::problem::{MOST_STAGES, Scheme};

    fn schemes() -> impl Iterator<Item = (Scheme, usize)> {
        (1..=MOST_STAGES).flat_map(|s| [(Scheme::Radau(s), 2 * s - 1), (Scheme::Gauss(s), 2 * s)])
    }

    /// Row `i` of the Runge-Kutta matrix: the integrals of the Lagrange polynomials up to `c_i`.
    fn matrix(nodes: &[f64]) -> Vec<Vec<f64>> {
        let integral = |polynomial: Vec<f64>, end: f64| -> f64 {
            let terms = polynomial.iter().enumerate();
            terms.map(|(power, c)| c * end.powi(power as i32 + 1) / (power + 1) as f64).sum()
        };
        nodes
            .iter()
            .map(|c| (0..nodes.len()).map(|j| integral(coefficients(nodes, j), *c)).collect())
            .collect()
    }

    fn assert_near(a: f64, b: f64, what: &str) {
        assert!((a - b).abs() < 2e-14, "{what}: {a} and {b}");
    }

    /// Butcher 1964: `B(p)`, `C(s)`, `D(p - s)` make a scheme of order `p`.
    #[test]
    fn the_order_conditions_hold() {
        for (scheme, order) in schemes() {
            let c = scheme.nodes();
            let (s, b, a) = (c.len(), weights(c), matrix(c));
            let moment = |q: usize| (0..s).map(|i| b[i] * c[i].powi(q as i32 - 1)).sum::<f64>();
            (1..=order).for_each(|q| {
                assert_near(moment(q), 1.0 / q as f64, &format!("B({q}) of {scheme:?}"))
            });
            assert!(
                (moment(order + 1) - 1.0 / (order + 1) as f64).abs() > 1e-7,
                "{scheme:?}: no more than B"
            );
            for q in 1..=s {
                for i in 0..s {
                    let sum = (0..s).map(|j| a[i][j] * c[j].powi(q as i32 - 1)).sum();
                    assert_near(
                        sum,
                        c[i].powi(q as i32) / q as f64,
                        &format!("C({q}) of {scheme:?}"),
                    );
                }
            }
            for q in 1..=order - s {
                for j in 0..s {
                    let sum = (0..s).map(|i| b[i] * c[i].powi(q as i32 - 1) * a[i][j]).sum();
                    assert_near(
                        sum,
                        b[j] * (1.0 - c[j].powi(q as i32)) / q as f64,
                        &format!("D({q}) of {scheme:?}"),
                    );
                }
            }
        }
    }

    /// Hairer & Wanner, Solving ODEs II, tables IV.5.5 and IV.5.6 (Radau IIA of order 5, Gauss of
    /// order 4).
    #[test]
    fn the_matrices_are_those_of_the_literature() {
        let r = 6.0f64.sqrt();
        let radau = [
            [(88.0 - 7.0 * r) / 360.0, (296.0 - 169.0 * r) / 1800.0, (-2.0 + 3.0 * r) / 225.0],
            [(296.0 + 169.0 * r) / 1800.0, (88.0 + 7.0 * r) / 360.0, (-2.0 - 3.0 * r) / 225.0],
            [(16.0 - r) / 36.0, (16.0 + r) / 36.0, 1.0 / 9.0],
        ];
        let q = 3.0f64.sqrt() / 6.0;
        let gauss = [[0.25, 0.25 - q], [0.25 + q, 0.25]];
        let found = matrix(Scheme::Radau(3).nodes());
        (0..9).for_each(|at| assert_near(found[at / 3][at % 3], radau[at / 3][at % 3], "Radau"));
        let found = matrix(Scheme::Gauss(2).nodes());
        (0..4).for_each(|at| assert_near(found[at / 2][at % 2], gauss[at / 2][at % 2], "Gauss"));
    }

    /// Slopes over `0, c` are the inverse of the Runge-Kutta matrix, and what the end gets is `1 +
    /// b A^-1 (X - x)`.
    #[test]
    fn derivatives_of_the_polynomial_are_the_same_scheme() {
        for (scheme, _) in schemes() {
            let c = scheme.nodes();
            let (s, b, a) = (c.len(), weights(c), matrix(c));
            let points: Vec<f64> = [0.0].into_iter().chain(c.iter().copied()).collect();
            let slopes: Vec<Vec<f64>> = c.iter().map(|time| slopes(&points, *time)).collect();
            for i in 0..s {
                assert!(slopes[i].iter().sum::<f64>().abs() < 1e-12, "constants have no slope");
                for j in 0..s {
                    let product: f64 = (0..s).map(|l| a[i][l] * slopes[l][j + 1]).sum();
                    assert!(
                        (product - f64::from(u8::from(i == j))).abs() < 1e-12,
                        "A D = I of {scheme:?}"
                    );
                }
            }
            let end = values(&points, 1.0);
            for j in 0..s {
                let expected: f64 = (0..s).map(|l| b[l] * slopes[l][j + 1]).sum();
                assert!((end[j + 1] - expected).abs() < 1e-12, "the end of {scheme:?}");
            }
        }
    }

    /// `R(z) = 1 + z b' (I - z A)^-1 1`: on the imaginary axis `|R| = 1` for Gauss and at most 1
    /// for Radau, which forgets what is infinitely fast: `R(-inf) = l_0(1)` is 0 for Radau, and 1
    /// or -1 for Gauss.
    #[test]
    fn radau_is_l_stable_and_gauss_keeps_the_size() {
        for (scheme, _) in schemes() {
            let c = scheme.nodes();
            let is_radau = matches!(scheme, Scheme::Radau(_));
            let points: Vec<f64> = [0.0].into_iter().chain(c.iter().copied()).collect();
            let limit = values(&points, 1.0)[0].abs();
            assert_near(limit, if is_radau { 0.0 } else { 1.0 }, &format!("R(-inf) of {scheme:?}"));
            for y in [0.1, 1.0, 3.0, 10.0, 100.0] {
                let size = amplification(c, y);
                assert!(size < 1.0 + 1e-12, "{scheme:?} at {y} i: {size}");
                assert!(is_radau || size > 1.0 - 1e-12, "{scheme:?} at {y} i: {size}");
            }
        }
    }

    /// `|R(i y)|`, from `x' = i y x` as a real system of twice the size.
    fn amplification(c: &[f64], y: f64) -> f64 {
        let (s, a, b) = (c.len(), matrix(c), weights(c));
        let mut system = nalgebra::DMatrix::<f64>::identity(2 * s, 2 * s);
        let mut right = nalgebra::DVector::<f64>::zeros(2 * s);
        for i in 0..s {
            (0..s).for_each(|j| system[(i, s + j)] += y * a[i][j]);
            (0..s).for_each(|j| system[(s + i, j)] -= y * a[i][j]);
            right[i] = 1.0;
        }
        let x = system.lu().solve(&right).expect("regular");
        let real = 1.0 - (0..s).map(|j| y * b[j] * x[s + j]).sum::<f64>();
        let imaginary = (0..s).map(|j| y * b[j] * x[j]).sum::<f64>();
        real.hypot(imaginary)
    }
}
