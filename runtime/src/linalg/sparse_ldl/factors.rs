//! What the fronts leave: columns of `L` and blocks of `D`, front by front.

use super::front::Front;

/// `L` and `D`.
#[derive(Debug, Default)]
pub(super) struct Factors {
    fronts: Vec<FrontStorage>,
    rows: Vec<u32>,
    values: Vec<f64>,
    blocks: Vec<u8>,
    /// The part of a right side that a front concerns.
    part: Vec<f64>,
}

/// Where a front is kept, and how many of its rows are eliminated.
#[derive(Clone, Copy, Debug)]
struct FrontStorage {
    row: usize,
    value: usize,
    block: usize,
    size: usize,
    pivots: usize,
}

/// A front that is kept, with what a right side has in its rows.
struct Kept<'a> {
    values: &'a [f64],
    blocks: &'a [u8],
    part: &'a mut [f64],
}

impl Factors {
    pub(super) fn clear(&mut self) {
        self.fronts.clear();
        self.rows.clear();
        self.values.clear();
        self.blocks.clear();
    }

    /// Keeps what is eliminated of the front.
    pub(super) fn keep(&mut self, front: &Front) {
        let (size, pivots) = (front.size(), front.blocks.len());
        let (row, value, block) = (self.rows.len(), self.values.len(), self.blocks.len());
        self.fronts.push(FrontStorage { row, value, block, size, pivots });
        self.rows.extend(&front.rows);
        self.values.extend(&front.values[..pivots * size]);
        self.blocks.extend(&front.blocks);
    }

    /// Replaces `b` by the solution of `L D L' x = b`.
    pub(super) fn solve(&mut self, b: &mut [f64]) {
        for at in 0..self.fronts.len() {
            self.visit(at, b, |kept| kept.forward());
        }
        for at in (0..self.fronts.len()).rev() {
            self.visit(at, b, |kept| kept.backward());
        }
    }

    fn visit(&mut self, at: usize, b: &mut [f64], action: impl Fn(&mut Kept<'_>)) {
        let FrontStorage { row, value, block, size, pivots } = self.fronts[at];
        let rows = &self.rows[row..row + size];
        self.part.clear();
        self.part.extend(rows.iter().map(|row| b[*row as usize]));
        action(&mut Kept {
            values: &self.values[value..value + pivots * size],
            blocks: &self.blocks[block..block + pivots],
            part: &mut self.part,
        });
        rows.iter().zip(&self.part).for_each(|(row, x)| b[*row as usize] = *x);
    }
}

impl Kept<'_> {
    fn column(&self, k: usize) -> &[f64] {
        &self.values[k * self.part.len()..(k + 1) * self.part.len()]
    }

    /// `D^-1 L^-1`
    fn forward(&mut self) {
        for k in 0..self.blocks.len() {
            let column = &self.values[k * self.part.len()..(k + 1) * self.part.len()];
            let first = k + (self.blocks[k] as usize).max(1);
            let x = self.part[k];
            self.part[first..].iter_mut().zip(&column[first..]).for_each(|(y, l)| *y -= l * x);
            match self.blocks[k] {
                1 => self.part[k] = x / column[k],
                0 => self.solve_block(k - 1),
                _ => {}
            }
        }
    }

    fn solve_block(&mut self, k: usize) {
        let (a, b, c) = (self.column(k)[k], self.column(k)[k + 1], self.column(k + 1)[k + 1]);
        let (p, q) = (self.part[k], self.part[k + 1]);
        let determinant = a * c - b * b;
        self.part[k] = (c * p - b * q) / determinant;
        self.part[k + 1] = (a * q - b * p) / determinant;
    }

    /// `L'^-1`
    fn backward(&mut self) {
        for k in (0..self.blocks.len()).rev() {
            let first = k + (self.blocks[k] as usize).max(1);
            let products = self.column(k)[first..].iter().zip(&self.part[first..]);
            let sum: f64 = products.map(|(l, x)| l * x).sum();
            self.part[k] -= sum;
        }
    }
}
