//! Sums over the values of a matrix, each a list of terms that is the same for all intervals.

use super::sight::{BATCH, NOTHING, Numbers, Sight};
use crate::linalg::dense::lanes::multiply_add;
use crate::linalg::structure::triplets::{Family, Triplets};
use std::ops::Range;

/// Sums over the values of one matrix.
#[derive(Default)]
pub(super) struct Sums {
    terms: Vec<Term>,
    /// Behind the last term of each sum.
    ends: Vec<u32>,
    /// Entries that belong to no interval, each with its place among the values.
    others: Vec<(Family, usize)>,
}

/// `values[source + k]` times a number that interval `k` sees.
#[derive(Clone, Copy)]
struct Term {
    source: u32,
    seen: u32,
}

impl Sums {
    pub(super) fn new(
        sight: Sight,
        matrix: &Triplets,
        places: impl Fn(&Family) -> Option<[usize; 2]>,
    ) -> Self {
        let (mut sums, mut source) = (Sums::default(), 0);
        // Each with its sum; as many as there may be.
        let mut terms: Vec<(usize, Term)> = Vec::with_capacity(2 * matrix.families.len());
        for family in &matrix.families {
            match places(family).filter(|_| family.count == sight.stages.intervals) {
                Some([a, b]) => {
                    terms.push((a, Term { source, seen: b as u32 }));
                    if a != b {
                        terms.push((b, Term { source, seen: a as u32 }));
                    }
                }
                None => sums.others.push((*family, source as usize)),
            }
            source += family.count as u32;
        }
        // Those of a sum stay in their order.
        terms.sort_by_key(|(sum, _)| *sum);
        let end = |sum: usize| terms.partition_point(|it| it.0 <= sum) as u32;
        sums.ends = (0..sight.len()).map(end).collect();
        sums.terms = terms.into_iter().map(|(_, term)| term).collect();
        sums
    }

    /// Adds the terms of the values of a batch of intervals to the first sums.
    #[inline(always)]
    pub(super) fn add<const FUSED: bool>(
        &self,
        batch: &Range<usize>,
        values: &[f64],
        seen: &[Numbers],
        found: &mut [Numbers],
    ) {
        let mut first = 0;
        for (found, end) in found.iter_mut().zip(&self.ends) {
            let mut sum = *found;
            for term in &self.terms[first..*end as usize] {
                let (start, seen) = (term.source as usize + batch.start, &seen[term.seen as usize]);
                match values[start..].first_chunk::<BATCH>() {
                    // Beyond the last interval of a chain they belong to others, and nobody is
                    // told of their sums.
                    Some(values) => add_products::<FUSED>(values, seen, &mut sum),
                    None => {
                        let mut last = NOTHING;
                        last[..batch.len()].copy_from_slice(&values[start..][..batch.len()]);
                        add_products::<FUSED>(&last, seen, &mut sum);
                    }
                }
            }
            (*found, first) = (sum, *end as usize);
        }
    }

    /// Calls `action(value, row, column)` for every entry that belongs to no interval.
    pub(super) fn each_other(&self, values: &[f64], mut action: impl FnMut(f64, usize, usize)) {
        for (family, source) in &self.others {
            for (k, value) in values[*source..][..family.count].iter().enumerate() {
                action(
                    *value,
                    family.row + k * family.row_step,
                    family.column + k * family.column_step,
                );
            }
        }
    }
}

#[inline(always)]
fn add_products<const FUSED: bool>(a: &Numbers, b: &Numbers, sum: &mut Numbers) {
    for l in 0..BATCH {
        sum[l] = multiply_add::<FUSED>(a[l], b[l], sum[l]);
    }
}
