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

/// The equations with their springs, factored.
pub(super) struct Equations<'a> {
    factor: &'a mut dyn Factor,
    structure: &'a Triplets,
    jacobian: &'a [f64],
    springs: &'a [f64],
    rows: usize,
    /// Whether they depend on each other: then nothing is known to follow from them.
    are_dependent: bool,
}

impl<'a> Equations<'a> {
    /// Of the rows that are an `equality`; the matrix of the factor has a Hessian with so many
    /// entries.
    pub(super) fn new(
        factor: &'a mut dyn Factor,
        (structure, jacobian): (&'a Triplets, &'a [f64]),
        (springs, equality): (&'a [f64], &[bool]),
        hessian: usize,
    ) -> Self {
        let off = |is_equality: &bool| if *is_equality { 0.0 } else { f64::MAX.sqrt() };
        let d: Vec<f64> = equality.iter().map(off).collect();
        let found = factor.factor(&vec![0.0; hessian], jacobian, springs, &d);
        let are_dependent = found != Inertia::Correct;
        Equations { factor, structure, jacobian, springs, rows: equality.len(), are_dependent }
    }

    /// Whether a row follows from them.
    pub(super) fn imply(&mut self, row: usize) -> bool {
        if self.are_dependent {
            return false;
        }
        let mut force = vec![0.0; self.springs.len() + self.rows];
        let entries = self.structure.entries().zip(self.jacobian).filter(|it| it.0.0 == row);
        entries.for_each(|((_, column), slope)| force[column] += slope);
        let terms = force.iter().zip(self.springs).map(|(slope, spring)| slope * slope / spring);
        let alone: f64 = terms.sum();
        let mut moved = force.clone();
        self.factor.solve(&mut moved);
        let gives: f64 = force.iter().zip(&moved).map(|(slope, by)| slope * by).sum();
        gives <= IMPLIED * alone
    }
}
