//! Which value of which function goes where in the sparse matrices of the NLP.

use crate::linalg::{Family, Triplets};
use std::collections::BTreeMap;

/// A quantity that repeats along the chain: its first position and its step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Repeated {
    pub(super) first: usize,
    pub(super) step: usize,
}

/// Where values of a matrix are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Destination {
    /// The first value of the family.
    pub(super) first: usize,
    /// Whether nothing was put there before, so that what comes first replaces what an earlier
    /// evaluation left. What is evaluated has to come in the order in which it was placed.
    pub(super) is_new: bool,
}

impl Destination {
    /// Where something is already.
    pub(super) fn taken(first: usize) -> Self {
        Destination { first, is_new: false }
    }
}

/// `target values += coefficient * column of the function`, or `=` where the target is new.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contribution {
    /// Column of the function's table.
    pub(super) column: usize,
    pub(super) coefficient: f64,
    pub(super) target: Destination,
}

/// Families under construction; the same place is never listed twice.
#[derive(Default)]
pub(super) struct Builder {
    structure: Triplets,
    places: BTreeMap<(Repeated, Repeated, usize), usize>,
    values: usize,
}

impl Builder {
    /// The family at this place, made if needed.
    pub(super) fn place(&mut self, row: Repeated, column: Repeated, count: usize) -> Destination {
        let mut is_new = false;
        let first = *self.places.entry((row, column, count)).or_insert_with(|| {
            is_new = true;
            let (row_step, column_step) = if count == 1 { (0, 0) } else { (row.step, column.step) };
            let family =
                Family { row: row.first, column: column.first, row_step, column_step, count };
            self.structure.families.push(family);
            self.values += count;
            self.values - count
        });
        Destination { first, is_new }
    }

    /// The same in the lower triangle of a symmetric matrix.
    pub(super) fn symmetric_place(
        &mut self,
        a: Repeated,
        b: Repeated,
        count: usize,
    ) -> Destination {
        if a.first >= b.first { self.place(a, b, count) } else { self.place(b, a, count) }
    }

    pub(super) fn finish(self) -> Triplets {
        self.structure
    }
}
