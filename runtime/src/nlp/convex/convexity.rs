//! A proof that a quadratic form is convex, block by block.
//!
//! Variables that no entry connects are blocks of their own. A block is positive definite if
//! Cholesky's method succeeds on it after its diagonal was lowered by more than all
//! rounding of that method (S. M. Rump, Verification of positive definiteness, BIT 46 (2006)
//! 433-452). Where that says nothing, elimination in exact arithmetic decides whether it is
//! positive
//! semidefinite: its entries are fractions. What is not proved is not convex.

use crate::nlp::tuning::convexity::{LARGEST, LARGEST_EXACT};
use num_bigint::BigInt;
use std::collections::{BTreeMap, HashSet};

/// Whether the symmetric matrix with the entries `(row, column, value)` of its upper or lower
/// triangle is proved to be positive semidefinite. Entries of one place add up.
pub(super) fn is_proved(entries: impl Iterator<Item = (usize, usize, f64)>, size: usize) -> bool {
    let mut places: BTreeMap<(usize, usize), f64> = BTreeMap::new();
    for (row, column, value) in entries {
        *places.entry((row.max(column), row.min(column))).or_default() += value;
    }
    let mut known = HashSet::new();
    blocks(&places, size).into_iter().all(|block| {
        // Most intervals of a grid have the same block.
        let is_new =
            known.insert(block.values.iter().map(|value| value.to_bits()).collect::<Vec<_>>());
        !is_new || block.is_semidefinite()
    })
}

/// A dense symmetric matrix.
struct Block {
    size: usize,
    /// Row by row.
    values: Vec<f64>,
}

/// The blocks of variables that entries connect, directly or through others.
fn blocks(places: &BTreeMap<(usize, usize), f64>, size: usize) -> Vec<Block> {
    let mut parents: Vec<usize> = (0..size).collect();
    let entries = || places.iter().filter(|(_, value)| **value != 0.0);
    for (&(i, j), _) in entries() {
        let (i, j) = (root(&mut parents, i), root(&mut parents, j));
        parents[i] = j;
    }
    let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut position = vec![0; size];
    for i in 0..size {
        let block = members.entry(root(&mut parents, i)).or_default();
        position[i] = block.len();
        block.push(i);
    }
    let mut blocks: BTreeMap<usize, Block> = BTreeMap::new();
    for (&(i, j), value) in entries() {
        let root = root(&mut parents, i);
        let size = members[&root].len();
        let values = || Block {
            size,
            values: if size <= LARGEST { vec![0.0; size * size] } else { Vec::new() },
        };
        let block = blocks.entry(root).or_insert_with(values);
        for (row, column) in [(position[i], position[j]), (position[j], position[i])] {
            if let Some(entry) = block.values.get_mut(row * size + column) {
                *entry = *value;
            }
        }
    }
    blocks.into_values().collect()
}

fn root(parents: &mut [usize], mut i: usize) -> usize {
    while parents[i] != i {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    i
}

impl Block {
    fn is_semidefinite(&self) -> bool {
        let is_known = !self.values.is_empty() && self.values.iter().all(|value| value.is_finite());
        is_known
            && (self.is_definite() || self.size <= LARGEST_EXACT && self.is_exactly_semidefinite())
    }

    /// Cholesky's method on the block with a diagonal between 1 and 4, lowered by what bounds all
    /// rounding.
    fn is_definite(&self) -> bool {
        let n = self.size;
        let diagonal = |i: usize| self.values[i * n + i];
        if (0..n).any(|i| diagonal(i) <= 0.0) {
            return false;
        }
        // Powers of two, which round nothing.
        let scales: Vec<f64> = (0..n).map(|i| (-0.5 * diagonal(i).log2()).floor().exp2()).collect();
        let mut lower: Vec<f64> =
            (0..n * n).map(|at| self.values[at] * scales[at / n] * scales[at % n]).collect();
        let trace: f64 = (0..n).map(|i| lower[i * n + i]).sum();
        let shift = 4.0 * (n as f64 + 3.0) * f64::EPSILON * trace;
        (0..n).for_each(|i| lower[i * n + i] -= shift);
        has_cholesky(&mut lower, n)
    }

    /// Elimination without fractions (E. H. Bareiss, Mathematics of Computation 22 (1968) 565-578),
    /// with pivots from the diagonal.
    fn is_exactly_semidefinite(&self) -> bool {
        let n = self.size;
        let Some(mut matrix) = integers(&self.values) else { return false };
        let (mut rest, mut before): (Vec<usize>, BigInt) = ((0..n).collect(), BigInt::from(1));
        let zero = BigInt::ZERO;
        while !rest.is_empty() {
            if rest.iter().any(|i| matrix[i * n + i] < zero) {
                return false;
            }
            let Some(at) = rest.iter().position(|i| matrix[i * n + i] > zero) else {
                // A zero on the diagonal of a semidefinite matrix has zeros beside it.
                return rest.iter().all(|i| rest.iter().all(|j| matrix[i * n + j] == zero));
            };
            let k = rest.swap_remove(at);
            let pivot = matrix[k * n + k].clone();
            for &i in &rest {
                for &j in &rest {
                    let eliminated = (&pivot * &matrix[i * n + j]
                        - &matrix[i * n + k] * &matrix[k * n + j])
                        / &before;
                    matrix[i * n + j] = eliminated;
                }
            }
            before = pivot;
        }
        true
    }
}

fn has_cholesky(matrix: &mut [f64], n: usize) -> bool {
    for j in 0..n {
        let mut pivot = matrix[j * n + j];
        for k in 0..j {
            pivot -= matrix[j * n + k] * matrix[j * n + k];
        }
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        let root = pivot.sqrt();
        matrix[j * n + j] = root;
        for i in j + 1..n {
            let mut entry = matrix[i * n + j];
            for k in 0..j {
                entry -= matrix[i * n + k] * matrix[j * n + k];
            }
            matrix[i * n + j] = entry / root;
        }
    }
    true
}

/// The same numbers times a power of two that makes them whole.
fn integers(values: &[f64]) -> Option<Vec<BigInt>> {
    /// Entries of so different size are no quadratic form that anybody wrote.
    const LARGEST_SHIFT: i32 = 600;
    let parts: Vec<(i64, i32)> = values.iter().map(|value| mantissa_and_exponent(*value)).collect();
    let least =
        parts.iter().filter(|(mantissa, _)| *mantissa != 0).map(|it| it.1).min().unwrap_or(0);
    let whole = |(mantissa, exponent): &(i64, i32)| {
        let shift = if *mantissa == 0 { 0 } else { exponent - least };
        (shift <= LARGEST_SHIFT).then(|| BigInt::from(*mantissa) << shift)
    };
    parts.iter().map(whole).collect()
}

/// `value = mantissa * 2^exponent`
fn mantissa_and_exponent(value: f64) -> (i64, i32) {
    let bits = value.to_bits();
    let (biased, fraction) = ((bits >> 52 & 0x7ff) as i32, (bits & ((1 << 52) - 1)) as i64);
    let (mantissa, exponent) =
        if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    (if value < 0.0 { -mantissa } else { mantissa }, exponent)
}

#[cfg(test)]
mod tests {
    use super::is_proved;

    /// Of a matrix given by its lower triangle, row by row.
    fn proved(rows: &[&[f64]]) -> bool {
        let entries = rows.iter().enumerate();
        let entries =
            entries.flat_map(|(i, row)| row.iter().enumerate().map(move |(j, a)| (i, j, *a)));
        is_proved(entries, rows.len())
    }

    #[test]
    fn forms_of_known_signature_are_told_apart() {
        assert!(proved(&[&[2.0], &[-2.0, 2.0]]));
        assert!(proved(&[&[1e-12], &[0.0, 1e12]]));
        assert!(proved(&[&[0.0], &[0.0, 3.0]]));
        // Squares of x + y + z and of x - y.
        assert!(proved(&[&[2.0], &[0.0, 2.0], &[1.0, 1.0, 1.0]]));
        assert!(!proved(&[&[1e14], &[0.0, -1e-14]]));
        assert!(!proved(&[&[0.0], &[1e-300, 1.0]]));
        assert!(!proved(&[&[1.0], &[1.0, 1.0 - f64::EPSILON]]));
        assert!(!proved(&[&[f64::NAN]]));
    }

    /// `1 + cos(pi/(n+1) k)` are the eigenvalues of the matrix with 1 and 1/2 beside it; a little
    /// less on the diagonal and the smallest is negative.
    #[test]
    fn a_long_band_is_decided_to_rounding() {
        let n = 40;
        let smallest = 1.0 - (std::f64::consts::PI / (n as f64 + 1.0)).cos();
        let band = |diagonal: f64| {
            let entry = |i: usize| {
                [(i, i, diagonal), (i, i.saturating_sub(1), if i > 0 { 0.5 } else { 0.0 })]
            };
            is_proved((0..n).flat_map(entry), n)
        };
        assert!(band(1.0 - smallest * (1.0 - 1e-11)));
        assert!(!band(1.0 - smallest * (1.0 + 1e-11)));
    }
}
