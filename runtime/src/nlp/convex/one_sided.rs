//! The constraints of an NLP one side at a time, as the conic solver wants them.
//!
//! ```text
//!     A v + s = b,      s = 0 for equalities, which come first,      s >= 0 for the others
//! ```
//!
//! A row of `A` is a row of the NLP or a single variable, with a minus where the bound is a
//! lower one.

use crate::linalg::Columns;
use crate::nlp::{Multipliers, Nlp};
use crate::problem::Bounds;

/// What a side bounds.
#[derive(Clone, Copy)]
enum Source {
    Row(usize),
    Variable(usize),
}

/// One side of one constraint: `sign * (c - bound) <= 0`, or `= 0` for an equality, whose sign is
/// 0.
#[derive(Clone, Copy)]
struct OneSided {
    source: Source,
    sign: f64,
    bound: f64,
}

impl OneSided {
    fn is_equality(&self) -> bool {
        self.sign == 0.0
    }

    fn factor(&self) -> f64 {
        if self.is_equality() { 1.0 } else { self.sign }
    }
}

/// All sides, equalities first.
pub(super) struct OneSidedConstraints {
    list: Vec<OneSided>,
    pub(super) equalities: usize,
    variables: usize,
    rows: usize,
}

impl OneSidedConstraints {
    pub(super) fn new(nlp: &dyn Nlp) -> Self {
        let rows =
            nlp.constraint_bounds().iter().enumerate().map(|(i, bounds)| (Source::Row(i), *bounds));
        let variables = nlp
            .variable_bounds()
            .iter()
            .enumerate()
            .map(|(i, bounds)| (Source::Variable(i), *bounds));
        let (mut list, mut inequalities) = (Vec::new(), Vec::new());
        for (source, Bounds { lower, upper }) in rows.chain(variables) {
            if lower == upper {
                list.push(OneSided { source, sign: 0.0, bound: lower });
                continue;
            }
            let finite =
                [(1.0, upper), (-1.0, lower)].into_iter().filter(|(_, bound)| bound.is_finite());
            inequalities.extend(finite.map(|(sign, bound)| OneSided { source, sign, bound }));
        }
        let equalities = list.len();
        list.extend(inequalities);
        OneSidedConstraints {
            list,
            equalities,
            variables: nlp.variable_bounds().len(),
            rows: nlp.constraint_bounds().len(),
        }
    }

    /// The entries of `A`.
    fn entries(&self, nlp: &dyn Nlp, jacobian: &[f64]) -> Vec<(usize, usize, f64)> {
        let of_row = by_rows(nlp, jacobian);
        let mut entries = Vec::new();
        for (i, side) in self.list.iter().enumerate() {
            match side.source {
                Source::Variable(j) => entries.push((i, j, side.factor())),
                Source::Row(row) => entries
                    .extend(of_row[row].iter().map(|(j, value)| (i, *j, side.factor() * value))),
            }
        }
        entries
    }

    /// `A`
    pub(super) fn columns(&self, nlp: &dyn Nlp, jacobian: &[f64]) -> Columns {
        Columns::of_entries(&self.entries(nlp, jacobian), self.list.len(), self.variables)
    }

    /// `b`, where rows are so far from zero already.
    pub(super) fn right_side(&self, rows: &[f64]) -> Vec<f64> {
        let already = |source| match source {
            Source::Row(row) => rows[row],
            Source::Variable(_) => 0.0,
        };
        self.list.iter().map(|side| side.factor() * (side.bound - already(side.source))).collect()
    }

    /// The multipliers of the NLP from those of `A v + s = b`.
    pub(super) fn multipliers(&self, z: &[f64]) -> Multipliers {
        let zeros = |length| vec![0.0; length];
        let (rows, lower, upper) = (zeros(self.rows), zeros(self.variables), zeros(self.variables));
        let mut multipliers = Multipliers { constraints: rows, lower, upper };
        for (side, z) in self.list.iter().zip(z) {
            let value = side.factor() * z;
            match side.source {
                Source::Row(row) => multipliers.constraints[row] += value,
                Source::Variable(i) if value < 0.0 => multipliers.lower[i] -= value,
                Source::Variable(i) => multipliers.upper[i] += value,
            }
        }
        multipliers
    }
}

/// The Jacobian row by row: variables and values.
fn by_rows(nlp: &dyn Nlp, jacobian: &[f64]) -> Vec<Vec<(usize, f64)>> {
    let mut rows = vec![Vec::new(); nlp.constraint_bounds().len()];
    for ((row, variable), value) in nlp.jacobian_structure().entries().zip(jacobian) {
        rows[row].push((variable, *value));
    }
    rows
}
