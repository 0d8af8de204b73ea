//! Inequalities that the equations say already: where no variable can move them, they forbid no
//! direction.
//!
//! With springs `S` on all variables, held to the equations `A`, a row `j` gives way by
//!
//! ```text
//!     j K^-1 j',     K = [ S  A'; A  0 ]
//! ```
//!
//! for each unit of force along it, and by `j S^-1 j'` without equations. The first is 0 of a row
//! that follows from them.

use super::tuning::covariance::IMPLIED;
use crate::linalg::{Factor, Inertia, Triplets};

/// Whether each of these rows follows from the equations; none where these depend on each other.
pub(super) fn implied(
    factor: &mut dyn Factor,
    (structure, jacobian): (&Triplets, &[f64]),
    (springs, equality): (&[f64], &[bool]),
    hessian: usize,
    rows: &[usize],
) -> Vec<bool> {
    let off = |is_equality: &bool| if *is_equality { 0.0 } else { f64::MAX.sqrt() };
    let d: Vec<f64> = equality.iter().map(off).collect();
    if factor.factor(&vec![0.0; hessian], jacobian, springs, &d) != Inertia::Correct {
        return vec![false; rows.len()];
    }
    let is_implied = |row: &usize| {
        let mut force = vec![0.0; springs.len() + equality.len()];
        let entries = structure.entries().zip(jacobian).filter(|it| it.0.0 == *row);
        entries.for_each(|((_, column), slope)| force[column] += slope);
        let terms = force.iter().zip(springs).map(|(slope, spring)| slope * slope / spring);
        let alone: f64 = terms.sum();
        let mut moved = force.clone();
        factor.solve(&mut moved);
        let gives: f64 = force.iter().zip(&moved).map(|(slope, by)| slope * by).sum();
        gives <= IMPLIED * alone
    };
    rows.iter().map(is_implied).collect()
}
