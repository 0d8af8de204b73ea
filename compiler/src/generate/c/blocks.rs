//! The blocks of a Jacobian or a Hessian, one for each two of outputs and inputs, as CasADi wants
//! them: column by column.

use super::{Argument, Exported, Part};

/// A sparse matrix, each of whose entries is one of the entries that a kernel computes.
#[derive(Default)]
pub(super) struct Block {
    rows: usize,
    columns: usize,
    /// Column, row, which entry; sorted.
    entries: Vec<(usize, usize, usize)>,
}

impl Block {
    fn new(rows: usize, columns: usize, mut entries: Vec<(usize, usize, usize)>) -> Self {
        entries.sort_unstable();
        Block { rows, columns, entries }
    }

    /// A matrix of zeros.
    pub fn empty(rows: usize, columns: usize) -> Self {
        Block { rows, columns, entries: Vec::new() }
    }

    /// A full column.
    pub fn column(rows: usize) -> Self {
        Block::new(rows, 1, (0..rows).map(|row| (0, row, row)).collect())
    }

    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }
    pub fn len(&self) -> usize {
        self.entries.len()
    }
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Rows, columns, where each column begins, the row of each entry.
    pub fn compressed(&self) -> Vec<usize> {
        let begins = (0..=self.columns).map(|it| self.entries.partition_point(|e| e.0 < it));
        let rows = self.entries.iter().map(|it| it.1);
        [self.rows, self.columns].into_iter().chain(begins).chain(rows).collect()
    }

    /// Which entries of the kernel, in this order.
    pub fn which(&self) -> Vec<usize> {
        self.entries.iter().map(|it| it.2).collect()
    }

    /// Rows and columns of the entries.
    pub fn places(&self) -> [Vec<usize>; 2] {
        [self.entries.iter().map(|it| it.1).collect(), self.entries.iter().map(|it| it.0).collect()]
    }

    pub fn transposed(&self) -> Block {
        let entries = self.entries.iter().map(|&(column, row, which)| (row, column, which));
        Block::new(self.columns, self.rows, entries.collect())
    }
}

/// The derivative of an output by an input.
pub(super) fn jacobian(function: &Exported, part: &Part, by: &Argument) -> Block {
    let all = function.jacobian().entries.iter().enumerate();
    let place = |(which, &(row, column)): (usize, &(u32, u32))| {
        let row = row as usize;
        let column = by.place(column as usize)?;
        part.rows.contains(&row).then(|| (column, row - part.rows.start, which))
    };
    Block::new(part.rows.len(), by.size(), all.filter_map(place).collect())
}

/// The second derivative by two inputs, of which the kernel has the lower triangle.
pub(super) fn hessian(function: &Exported, first: &Argument, second: &Argument) -> Block {
    let mut entries = Vec::new();
    for (which, &(row, column)) in function.hessian().entries.iter().enumerate() {
        let (row, column) = (row as usize, column as usize);
        let mut enter = |row: usize, column: usize| {
            if let (Some(row), Some(column)) = (first.place(row), second.place(column)) {
                entries.push((column, row, which));
            }
        };
        enter(row, column);
        if row != column {
            enter(column, row);
        }
    }
    Block::new(first.size(), second.size(), entries)
}
