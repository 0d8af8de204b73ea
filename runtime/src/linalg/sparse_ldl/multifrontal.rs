//! `L D L'` of a sparse symmetric indefinite matrix, front by front, with pivots of one and two
//! rows.
//!
//! I. S. Duff and J. K. Reid, "The multifrontal solution of indefinite sparse symmetric linear
//! equations", ACM Transactions on Mathematical Software 9 (1983) 302-325. Rows are eliminated
//! along a tree ([`tree`]). Each node adds up its entries of the matrix and what its children
//! leave, in a small dense matrix, its front, and eliminates its own rows ([`super::front`]). A row
//! that has no good pivot there is left to the parent. So the factors are accurate without any
//! change of the matrix, and the signs of `D` are its inertia. Where so many rows are left that the
//! fronts fill up, worse pivots have to do.

use super::balance::Balance;
use super::factors::Factors;
use super::front::{Front, Singular};
use super::pairs::Pairs;
use super::tree::{self, Node};
use crate::linalg::structure::columns::Columns;

/// The threshold of pivots at first.
const THRESHOLD: f64 = 1e-4;
/// What it becomes where fronts fill up, for what it was.
const LOWER: f64 = 1e-2;
/// A matrix whose fronts fill up with pivots as small as this is as good as singular.
const LEAST: f64 = 1e-9;
/// So many times what a factorisation takes without late rows are too many multiplications.
const TOO_MANY: f64 = 4.0;

/// A matrix of one pattern, and its factors.
pub(crate) struct Multifrontal {
    pattern: Columns,
    nodes: Vec<Node>,
    /// Whether the nodes were made for the sizes of a matrix, too.
    is_paired: bool,
    balance: Balance,
    pub(super) front: Front,
    left: Stack,
    factors: Factors,
    /// Where each row is in the front.
    position: Vec<u32>,
}

/// Why there are no factors.
#[derive(Debug)]
enum Stop {
    Singular,
    /// Late rows make the fronts too large.
    Full,
}

impl From<Singular> for Stop {
    fn from(_: Singular) -> Self {
        Stop::Singular
    }
}

/// What nodes left to their parents: symmetric matrices, by columns of their lower triangles.
#[derive(Debug, Default)]
struct Stack {
    sizes: Vec<Left>,
    rows: Vec<u32>,
    values: Vec<f64>,
}

/// The size of such a matrix, and how many of its rows, the first, should have been eliminated.
#[derive(Clone, Copy, Debug)]
struct Left {
    size: usize,
    late: usize,
}

impl Multifrontal {
    /// Analyses a pattern, the upper triangle of a symmetric matrix.
    pub(crate) fn new(pattern: Columns) -> Self {
        Multifrontal {
            nodes: tree::nodes(&pattern, &Pairs::none(pattern.rows)),
            is_paired: false,
            balance: Balance::new(pattern.rows),
            front: Front::new(THRESHOLD),
            left: Stack::default(),
            factors: Factors::default(),
            position: vec![0; pattern.rows],
            pattern,
        }
    }

    /// Analyses the pattern once more, with the sizes of the first matrix of it.
    fn pair(&mut self, values: &[f64]) {
        let balanced = |row, column, value: usize| self.balance.scaled(row, column, values[value]);
        self.nodes = tree::nodes(&self.pattern, &Pairs::of(&self.pattern, balanced));
        self.is_paired = true;
    }

    /// How many multiplications a factorisation takes, about.
    pub(crate) fn multiplications(&self) -> f64 {
        self.nodes.iter().map(Node::multiplications).sum()
    }

    /// Factors the matrix with these values of its pattern; the number of negative eigenvalues, or
    /// `None` if it is singular.
    pub(crate) fn factor(&mut self, values: &[f64]) -> Option<usize> {
        self.balance.update(&self.pattern, values);
        if !self.is_paired {
            self.pair(values);
        }
        let before = self.front.threshold;
        while self.front.threshold > LEAST {
            match self.eliminate(values) {
                Ok(negative) => return Some(negative),
                Err(Stop::Singular) => break,
                Err(Stop::Full) => self.front.threshold *= LOWER,
            }
        }
        self.front.threshold = before;
        None
    }

    /// Eliminates all rows; the number of negative eigenvalues.
    fn eliminate(&mut self, values: &[f64]) -> Result<usize, Stop> {
        self.factors.clear();
        self.left.clear();
        let most = TOO_MANY * self.multiplications();
        let (mut negative, mut done) = (0, 0.0);
        for at in 0..self.nodes.len() {
            let ready = self.assemble(at, values);
            done += tree::multiplications(ready, self.front.size());
            if done > most {
                return Err(Stop::Full);
            }
            self.front.eliminate(ready)?;
            let late = ready - self.front.blocks.len();
            if late > 0 && self.nodes[at].rest.is_empty() {
                return Err(Stop::Singular);
            }
            negative += self.front.negative;
            self.factors.keep(&self.front);
            self.left.push(&self.front, late);
        }
        Ok(negative)
    }

    /// Replaces `b` by the solution.
    pub(crate) fn solve(&mut self, b: &mut [f64]) {
        self.balance.scale(b);
        self.factors.solve(b);
        self.balance.scale(b);
    }

    /// Makes the front of a node; the number of its rows that are ready to be eliminated.
    fn assemble(&mut self, at: usize, values: &[f64]) -> usize {
        let Multifrontal { nodes, balance, front, left, position, .. } = self;
        let node = &nodes[at];
        front.rows.clear();
        front.rows.extend(&node.own);
        left.append_late(node.children, &mut front.rows);
        let ready = front.rows.len();
        front.rows.extend(&node.rest);
        front.clear();
        front.rows.iter().enumerate().for_each(|(at, row)| position[*row as usize] = at as u32);
        for entry in &node.entries {
            let (row, column) = (entry.row as usize, entry.column as usize);
            let value = balance.scaled(row, column, values[entry.value as usize]);
            front.add(position[row] as usize, position[column] as usize, value);
        }
        (0..node.children).for_each(|_| left.pop_into(front, position));
        ready
    }
}

impl Stack {
    fn clear(&mut self) {
        self.sizes.clear();
        self.rows.clear();
        self.values.clear();
    }

    /// The rows that the last `count` nodes should have eliminated.
    fn append_late(&self, count: usize, rows: &mut Vec<u32>) {
        let mut end = self.rows.len();
        for Left { size, late } in self.sizes.iter().rev().take(count) {
            rows.extend(&self.rows[end - size..end - size + late]);
            end -= size;
        }
    }

    fn push(&mut self, front: &Front, late: usize) {
        let (size, pivots) = (front.size(), front.blocks.len());
        self.rows.extend(&front.rows[pivots..]);
        for column in pivots..size {
            self.values.extend(&front.values[column * size + column..(column + 1) * size]);
        }
        self.sizes.push(Left { size: size - pivots, late });
    }

    /// Adds the last matrix to the front.
    fn pop_into(&mut self, front: &mut Front, position: &[u32]) {
        let Some(Left { size, .. }) = self.sizes.pop() else { return };
        let first = self.rows.len() - size;
        self.rows[first..].iter_mut().for_each(|row| *row = position[*row as usize]);
        let (places, mut at) = (&self.rows[first..], self.values.len() - size * (size + 1) / 2);
        let start = at;
        for (j, column) in places.iter().enumerate() {
            for row in &places[j..] {
                front.add(*row as usize, *column as usize, self.values[at]);
                at += 1;
            }
        }
        self.values.truncate(start);
        self.rows.truncate(first);
    }
}
