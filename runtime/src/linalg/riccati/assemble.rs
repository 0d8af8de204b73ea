//! From the families of the sparse matrices to the dense blocks of one interval.
//!
//! Local positions of an interval are those of `(x_k, u_k, theta, y_k, x_{k+1})`.

use super::interval::Sizes;
use crate::linalg::{Family, Stages, Triplets};

/// Where one value of an interval goes: `target += values[source + k]`.
#[derive(Clone, Copy, Debug)]
struct Move {
    source: u32,
    target: u32,
}

/// A value of a local row, and the position of its variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LocalEntry {
    pub(super) row: usize,
    pub(super) position: usize,
}

/// What is gathered where.
pub(super) struct Assembly {
    hessian: Vec<Move>,
    defects: Vec<Move>,
    local: Vec<Move>,
    /// The values that a local row has, row by row.
    pub(super) local_entries: Vec<LocalEntry>,
    /// Products of two values of a local row, and where they go when the row is condensed.
    products: Vec<(u32, u32, u32)>,
}

impl Assembly {
    pub(super) fn new(stages: Stages, sizes: Sizes, hessian: &Triplets, jacobian: &Triplets) -> Option<Self> {
        let mut assembly = Assembly {
            hessian: Vec::new(),
            defects: Vec::new(),
            local: Vec::new(),
            local_entries: Vec::new(),
            products: Vec::new(),
        };
        each_family(hessian, |family, source| {
            is_coupling(&stages, family) || assembly.add_hessian(stages, sizes, family, source)
        })?;
        each_family(jacobian, |family, source| {
            family.row >= stages.coupling().start || assembly.add_row(stages, sizes, family, source)
        })?;
        assembly.list_products(sizes);
        Some(assembly)
    }

    fn add_hessian(&mut self, stages: Stages, sizes: Sizes, family: &Family, source: u32) -> bool {
        let (Some(row), Some(column)) = (
            local_position(stages, sizes, family.row, family.row_step),
            local_position(stages, sizes, family.column, family.column_step),
        ) else {
            return false;
        };
        self.hessian.push(Move { source, target: sizes.hessian_place(row, column) as u32 });
        family.count == stages.intervals
    }

    fn add_row(&mut self, stages: Stages, sizes: Sizes, family: &Family, source: u32) -> bool {
        let Some(position) = local_position(stages, sizes, family.column, family.column_step) else {
            return false;
        };
        match family.row.checked_sub(stages.defect_rows()) {
            None => {
                let target = sizes.defect_place(family.row, position) as u32;
                self.defects.push(Move { source, target });
            }
            Some(row) => {
                let target = self.local_place(LocalEntry { row, position }) as u32;
                self.local.push(Move { source, target });
            }
        }
        family.count == stages.intervals
            && family.row < stages.row_step()
            && (family.row_step == stages.row_step() || family.count == 1)
    }

    /// The place of a value among the local values of an interval, made if needed.
    fn local_place(&mut self, entry: LocalEntry) -> usize {
        let entries = &mut self.local_entries;
        entries.iter().position(|other| *other == entry).unwrap_or_else(|| {
            entries.push(entry);
            entries.len() - 1
        })
    }

    fn list_products(&mut self, sizes: Sizes) {
        for (i, a) in self.local_entries.iter().enumerate() {
            for (j, b) in self.local_entries.iter().enumerate() {
                if a.row == b.row && a.position >= b.position {
                    let target = sizes.hessian_place(a.position, b.position);
                    self.products.push((i as u32, j as u32, target as u32));
                }
            }
        }
    }

    /// Fills the dense blocks, and the local values, of the intervals from `k` on.
    #[inline(always)]
    pub(super) fn gather(
        &self,
        sizes: Sizes,
        k: usize,
        (hessian, jacobian): (&[f64], &[f64]),
        blocks: &mut [f64],
        local: &mut [f64],
    ) {
        let (length, local_length) = (sizes.gathered(), self.local_entries.len());
        let count = blocks.len() / length;
        blocks.fill(0.0);
        add_moves(&self.hessian, (k, count), hessian, (blocks, length));
        add_moves(&self.defects, (k, count), jacobian, (blocks, length));
        local.fill(0.0);
        add_moves(&self.local, (k, count), jacobian, (local, local_length));
    }

    /// Condenses the local rows: `H += J' diag(weights) J`.
    #[inline(always)]
    pub(super) fn condense(&self, local: &[f64], weights: &[f64], gathered: &mut [f64]) {
        for &(i, j, target) in &self.products {
            let weight = weights[self.local_entries[i as usize].row];
            gathered[target as usize] += weight * local[i as usize] * local[j as usize];
        }
    }
}

/// Adds the values of `count` intervals to their blocks of this length.
#[inline(always)]
fn add_moves(
    moves: &[Move],
    (k, count): (usize, usize),
    values: &[f64],
    (blocks, length): (&mut [f64], usize),
) {
    for entry in moves {
        let (values, target) = (&values[entry.source as usize + k..][..count], entry.target as usize);
        for (block, value) in blocks.chunks_exact_mut(length).zip(values) {
            block[target] += value;
        }
    }
}

/// Calls `action` with every family and the place of its first value; `None` as soon as one returns `false`.
pub(super) fn each_family(triplets: &Triplets, mut action: impl FnMut(&Family, u32) -> bool) -> Option<()> {
    let mut source = 0;
    for family in &triplets.families {
        if !action(family, source) {
            return None;
        }
        source += family.count as u32;
    }
    Some(())
}

/// Whether a Hessian family is a single entry between ends and globals.
pub(super) fn is_coupling(stages: &Stages, family: &Family) -> bool {
    family.count == 1 && family.row_step == 0 && family.column_step == 0 && stages.intervals > 0
}

/// Position in `(x, u, theta, y, x+)` of a variable that is at `index` in interval 0 and moves by `step`.
fn local_position(stages: Stages, sizes: Sizes, index: usize, step: usize) -> Option<usize> {
    let globals = stages.globals();
    if globals.contains(&index) {
        return (step == 0).then(|| sizes.n + sizes.m + index - globals.start);
    }
    if step != stages.variable_step() && stages.intervals > 1 {
        return None;
    }
    match index.checked_sub(sizes.n + sizes.m) {
        None => Some(index),
        Some(next) => (next < sizes.next()).then(|| sizes.reduced() + next),
    }
}
