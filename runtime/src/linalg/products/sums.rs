//! Sums over the values of a matrix, each a list of terms that is the same for all intervals of a
//! chain.

use super::sight::{BATCH, NOTHING, Numbers, Sight};
use crate::linalg::dense::lanes::multiply_add;
use crate::linalg::structure::triplets::{Family, Triplets};
use std::ops::Range;

/// Sums over the values of one matrix that belong to one chain.
pub(super) struct Sums {
    terms: Vec<Term>,
    /// Behind the last term of each sum.
    ends: Vec<u32>,
}

/// Entries of a matrix, each family with its place among the values.
pub(super) struct Entries(Vec<(Family, usize)>);

/// `values[source + k]` times a number that interval `k` sees.
#[derive(Clone, Copy)]
struct Term {
    source: u32,
    seen: u32,
}

impl Entries {
    pub(super) fn new(matrix: &Triplets) -> Self {
        let mut source = 0;
        let with_place = |family: &Family| {
            source += family.count;
            (*family, source - family.count)
        };
        Entries(matrix.families.iter().map(with_place).collect())
    }

    /// Takes out those that belong to the intervals of a chain; `places` are what they connect
    /// there.
    pub(super) fn sums(
        &mut self,
        sight: &Sight,
        places: impl Fn(&Family) -> Option<[usize; 2]>,
    ) -> Sums {
        // Each with its sum; as many as there may be.
        let mut terms: Vec<(usize, Term)> = Vec::with_capacity(2 * self.0.len());
        self.0.retain(|(family, source)| {
            let is_whole = family.count == sight.chain.stages.intervals;
            let Some([a, b]) = places(family).filter(|_| is_whole) else { return true };
            let term = |seen: usize| Term { source: *source as u32, seen: seen as u32 };
            terms.push((a, term(b)));
            if a != b {
                terms.push((b, term(a)));
            }
            false
        });
        // Those of a sum stay in their order.
        terms.sort_by_key(|(sum, _)| *sum);
        let end = |sum: usize| terms.partition_point(|it| it.0 <= sum) as u32;
        let ends = (0..sight.len()).map(end).collect();
        Sums { ends, terms: terms.into_iter().map(|(_, term)| term).collect() }
    }

    /// Calls `action(value, row, column)` for every entry that is left.
    pub(super) fn each(&self, values: &[f64], mut action: impl FnMut(f64, usize, usize)) {
        for (family, source) in &self.0 {
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

impl Sums {
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
}

#[inline(always)]
fn add_products<const FUSED: bool>(a: &Numbers, b: &Numbers, sum: &mut Numbers) {
    for l in 0..BATCH {
        sum[l] = multiply_add::<FUSED>(a[l], b[l], sum[l]);
    }
}
