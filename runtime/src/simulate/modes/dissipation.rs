//! Whether the motion is unique though the selectors are not: more surfaces than the state has room
//! for, such as the friction of two bodies on the ground and on each other, all at rest.
//!
//! With `psi' = r - B s`, forces of maximal dissipation have `B = S C`: `S = N M^-1 N'` is
//! symmetric and positive semidefinite, `C` diagonal and positive. Then `-B s` is minus the
//! subdifferential of a convex function, and the solution is unique (Brezis, *Operateurs maximaux
//! monotones*, 1973, theorem 3.4), whichever selectors it has.

use crate::simulate::tuning::modes::ROUNDING;
use nalgebra::DMatrix;

/// Whether `B` is of this kind, and each selector acts on its surface: what it acts on later, as in
/// `x' = v`, `v' in -Sgn(x)`, is no friction.
pub(super) fn is_maximal(b: &DMatrix<f64>) -> bool {
    let Some(c) = columns(b).filter(|_| b.diagonal().min() > ROUNDING * b.amax()) else {
        return false;
    };
    let mut s = b.clone();
    s.column_iter_mut().zip(&c).for_each(|(mut column, c)| column /= *c);
    let size = s.amax();
    let is_symmetric = (&s - s.transpose()).amax() <= ROUNDING * size;
    let least = |s: DMatrix<f64>| s.symmetric_eigenvalues().min();
    size.is_finite() && is_symmetric && least(s) >= -ROUNDING * size
}

/// `C`, such that `B` divided by it is symmetric: `c_j / c_i = B_ij / B_ji`, from row to row.
fn columns(b: &DMatrix<f64>) -> Option<Vec<f64>> {
    let size = b.nrows();
    let mut c = vec![f64::NAN; size];
    for first in 0..size {
        if c[first].is_nan() {
            c[first] = 1.0;
        }
        // Each pass reaches the next ones that act on those that are known.
        for _ in 0..size {
            for (i, j) in (0..size).flat_map(|i| (0..size).map(move |j| (i, j))) {
                if !c[i].is_nan() && c[j].is_nan() && b[(j, i)] != 0.0 {
                    c[j] = c[i] * b[(i, j)] / b[(j, i)];
                }
            }
        }
    }
    c.iter().all(|it| *it > 0.0 && it.is_finite()).then_some(c)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two bodies with friction on the ground, of 1 and 0.2, and on each other, of 0.5.
    fn bodies() -> DMatrix<f64> {
        DMatrix::from_row_slice(3, 3, &[1.0, 0.5, 0.0, 1.0, 1.0, -0.2, 0.0, -0.5, 0.2])
    }

    #[test]
    fn friction_of_bodies_on_each_other_is_maximal() {
        assert!(is_maximal(&bodies()));
    }

    #[test]
    fn what_acts_later_is_not() {
        assert!(!is_maximal(&DMatrix::zeros(1, 1)));
        let mut late = bodies();
        (late[(2, 2)], late[(2, 1)], late[(1, 2)]) = (0.0, 0.0, 0.0);
        assert!(!is_maximal(&late));
    }

    #[test]
    fn what_pushes_is_not() {
        assert!(!is_maximal(&-bodies()));
        let mut one_sided = bodies();
        one_sided[(0, 1)] = 2.0;
        assert!(!is_maximal(&one_sided));
    }
}
