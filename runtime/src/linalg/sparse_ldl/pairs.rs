//! Rows that are to be eliminated together, because one of them is no pivot by itself.
//!
//! A row of a constraint has hardly anything on its diagonal, and an order that looks at the
//! pattern alone eliminates it before the variables that it needs: it is left to its parent, and
//! fronts grow. So each such row is given a partner that it depends on, and both become one row of
//! the graph that is ordered: I. S. Duff and S. Pralet, "Strategies for scaling and pivoting for
//! sparse symmetric indefinite problems", SIAM J. Matrix Anal. Appl. 27 (2005) 313-340, section 4.
//! The pairs are a plan: which pivots are taken is decided by numbers, in each factorisation.

use crate::linalg::structure::columns::Columns;

/// A diagonal below this part of the largest entry beside it is no pivot to plan with.
const WEAK: f64 = 0.1;
/// Entries of at least this part of the largest are as good as it.
const ALIKE: f64 = 0.1;

/// The partner of each row; a row without one is its own.
#[derive(Debug)]
pub(super) struct Pairs {
    partner: Vec<u32>,
}

/// What a row has beside its diagonal, and its diagonal; sizes only.
#[derive(Clone, Default)]
struct Row {
    others: Vec<(usize, f64)>,
    diagonal: f64,
}

impl Row {
    fn largest(&self) -> f64 {
        self.others.iter().fold(0.0, |most, (_, size)| most.max(*size))
    }
}

impl Pairs {
    /// Every row is its own partner.
    pub(super) fn none(rows: usize) -> Self {
        Pairs { partner: (0..rows as u32).collect() }
    }

    /// Gives the weak rows of a balanced matrix partners, those with the fewest to choose from
    /// first.
    pub(super) fn of(pattern: &Columns, balanced: impl Fn(usize, usize, usize) -> f64) -> Self {
        let rows = rows(pattern, balanced);
        let is_weak = |row: &usize| rows[*row].diagonal < WEAK * rows[*row].largest();
        let mut weak: Vec<usize> = (0..rows.len()).filter(is_weak).collect();
        weak.sort_by_key(|row| rows[*row].others.len());
        let mut pairs = Pairs::none(rows.len());
        for row in weak {
            if let Some(partner) = pairs.best_partner(&rows, row) {
                pairs.partner[row] = partner as u32;
                pairs.partner[partner] = row as u32;
            }
        }
        pairs
    }

    pub(super) fn partner(&self, row: usize) -> usize {
        self.partner[row] as usize
    }

    fn is_alone(&self, row: usize) -> bool {
        self.partner(row) == row
    }

    /// Of the free rows on which a free row depends about most, the one that causes least fill.
    fn best_partner(&self, rows: &[Row], row: usize) -> Option<usize> {
        let free = || rows[row].others.iter().filter(|(other, _)| self.is_alone(*other));
        let largest = free().fold(0.0_f64, |most, (_, size)| most.max(*size));
        let good = free().filter(|(_, size)| *size > 0.0 && *size >= ALIKE * largest);
        let best = good.min_by_key(|(other, _)| rows[*other].others.len());
        best.filter(|_| self.is_alone(row)).map(|(other, _)| *other)
    }

    /// The members of each row of the graph in which pairs are one row.
    pub(super) fn members(&self) -> Vec<Vec<usize>> {
        let firsts = (0..self.partner.len()).filter(|row| *row <= self.partner(*row));
        let members = firsts.map(|row| match self.partner(row) {
            partner if partner == row => vec![row],
            partner => vec![row, partner],
        });
        members.collect()
    }
}

fn rows(pattern: &Columns, balanced: impl Fn(usize, usize, usize) -> f64) -> Vec<Row> {
    let mut rows = vec![Row::default(); pattern.rows];
    for (row, column, value) in pattern.places() {
        let size = balanced(row, column, value).abs();
        if row == column {
            rows[row].diagonal = size;
        } else {
            rows[row].others.push((column, size));
            rows[column].others.push((row, size));
        }
    }
    rows
}
