//! From the families of the sparse matrices to the dense blocks of several intervals.
//!
//! Local positions of an interval are those of `(x_k, theta, u_k, y_k, x_{k+1})`.

use super::sizes::Sizes;
use crate::linalg::dense::lanes::Lanes;
use crate::linalg::structure::stages::Stages;
use crate::linalg::structure::triplets::{Family, Triplets};

/// Where one value of an interval goes: `target += values[source + k]`.
#[derive(Clone, Copy, Debug)]
struct Move {
    source: u32,
    target: u32,
}

/// A value of a local row: its variable is `variable + k step`, which has this position in interval
/// `k`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LocalEntry {
    pub(super) row: usize,
    position: usize,
    pub(super) variable: usize,
    pub(super) step: usize,
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
    pub(super) fn new(
        stages: Stages,
        sizes: Sizes,
        hessian: &Triplets,
        jacobian: &Triplets,
    ) -> Option<Self> {
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
        let Some(position) = local_position(stages, sizes, family.column, family.column_step)
        else {
            return false;
        };
        match family.row.checked_sub(stages.defect_rows()) {
            None => {
                let target = sizes.defect_place(family.row, position) as u32;
                self.defects.push(Move { source, target });
            }
            Some(row) => {
                let (variable, step) = (family.column, family.column_step);
                let target = self.local_place(LocalEntry { row, position, variable, step }) as u32;
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

    /// Fills the dense blocks, and the values of the local rows, of `count` intervals from `first`
    /// on.
    #[inline(always)]
    pub(super) fn gather(
        &self,
        (first, count): (usize, usize),
        (hessian, jacobian): (&[f64], &[f64]),
        blocks: &mut [Lanes],
        local: &mut [Lanes],
    ) {
        blocks.iter_mut().for_each(|it| *it = Lanes::ZERO);
        local.fill(Lanes::ZERO);
        add_moves(&self.hessian, (first, count), hessian, blocks);
        add_moves(&self.defects, (first, count), jacobian, blocks);
        add_moves(&self.local, (first, count), jacobian, local);
    }

    /// Condenses the local rows: `H += J' diag(weights) J`.
    #[inline(always)]
    pub(super) fn condense<const FUSED: bool>(
        &self,
        local: &[Lanes],
        weights: &[Lanes],
        blocks: &mut [Lanes],
    ) {
        for &(i, j, target) in &self.products {
            let weighted = local[i as usize].times(weights[self.local_entries[i as usize].row]);
            let sum = &mut blocks[target as usize];
            *sum = Lanes::multiply_add::<FUSED>(weighted, local[j as usize], *sum);
        }
    }
}

/// Adds the values of `count` intervals to their places: a family has them one after the other.
#[inline(always)]
fn add_moves(moves: &[Move], (first, count): (usize, usize), values: &[f64], blocks: &mut [Lanes]) {
    let from = |entry: &Move| entry.source as usize + first;
    if count < Lanes::COUNT {
        for entry in moves {
            let values = &values[from(entry)..][..count];
            blocks[entry.target as usize]
                .add(Lanes::from(|l| values.get(l).copied().unwrap_or(0.0)));
        }
        return;
    }
    for entry in moves {
        let values = &values[from(entry)..][..Lanes::COUNT];
        blocks[entry.target as usize].add(Lanes::from(|l| values[l]));
    }
}

/// Calls `action` with every family and the place of its first value; `None` as soon as one returns
/// `false`.
pub(super) fn each_family(
    triplets: &Triplets,
    mut action: impl FnMut(&Family, u32) -> bool,
) -> Option<()> {
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

/// Position in `(x, theta, u, y, x+)` of a variable that is at `index` in interval 0 and moves by
/// `step`.
fn local_position(stages: Stages, sizes: Sizes, index: usize, step: usize) -> Option<usize> {
    let globals = stages.globals();
    if globals.contains(&index) {
        return (step == 0).then(|| sizes.n + index - globals.start);
    }
    if step != stages.variable_step() && stages.intervals > 1 {
        return None;
    }
    (sizes.position(index) < sizes.all()).then(|| sizes.position(index))
}
