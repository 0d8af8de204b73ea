//! From the families of the sparse matrices to the dense blocks of one interval.
//!
//! Local positions of an interval are those of `(x_k, u_k, theta, x_{k+1})`.

use super::interval::{Block, Sizes};
use crate::linalg::{Family, Stages, Triplets};

/// Where one value of an interval goes: `block[target] += values[source + k]`.
#[derive(Clone, Copy, Debug)]
struct Move {
    source: u32,
    target: u32,
}

/// For each dense block, what is gathered into it.
pub(super) struct Assembly {
    /// The scratch block that all intervals share.
    pub(super) block: Block,
    hessian: Vec<Move>,
    defects: Vec<Move>,
    local: Vec<Move>,
}

impl Assembly {
    pub(super) fn new(stages: Stages, sizes: Sizes, hessian: &Triplets, jacobian: &Triplets) -> Option<Self> {
        let mut assembly = Assembly {
            block: Block::new(sizes, stages.local_rows),
            hessian: Vec::new(),
            defects: Vec::new(),
            local: Vec::new(),
        };
        each_family(hessian, |family, source| {
            is_coupling(&stages, family) || assembly.add_hessian(stages, sizes, family, source)
        })?;
        each_family(jacobian, |family, source| {
            family.row >= stages.coupling().start || assembly.add_row(stages, sizes, family, source)
        })?;
        Some(assembly)
    }

    fn add_hessian(&mut self, stages: Stages, sizes: Sizes, family: &Family, source: u32) -> bool {
        let (Some(row), Some(column)) = (
            local_position(stages, sizes, family.row, family.row_step),
            local_position(stages, sizes, family.column, family.column_step),
        ) else {
            return false;
        };
        let width = sizes.all();
        self.hessian.push(Move { source, target: (row * width + column) as u32 });
        if row != column {
            self.hessian.push(Move { source, target: (column * width + row) as u32 });
        }
        family.count == stages.intervals
    }

    fn add_row(&mut self, stages: Stages, sizes: Sizes, family: &Family, source: u32) -> bool {
        let Some(column) = local_position(stages, sizes, family.column, family.column_step) else {
            return false;
        };
        let target = |row: usize| Move { source, target: (row * sizes.all() + column) as u32 };
        match family.row.checked_sub(stages.states) {
            None => self.defects.push(target(family.row)),
            Some(row) => self.local.push(target(row)),
        }
        family.count == stages.intervals
            && family.row < stages.row_step()
            && (family.row_step == stages.row_step() || family.count == 1)
    }

    /// Fills the shared block with the values of interval `k`.
    pub(super) fn gather(&mut self, k: usize, hessian: &[f64], jacobian: &[f64]) -> &mut Block {
        let block = &mut self.block;
        scatter(&self.hessian, k, hessian, &mut block.hessian);
        scatter(&self.defects, k, jacobian, &mut block.defects);
        scatter(&self.local, k, jacobian, &mut block.local);
        block
    }
}

fn scatter(moves: &[Move], k: usize, values: &[f64], block: &mut [f64]) {
    block.fill(0.0);
    for entry in moves {
        block[entry.target as usize] += values[entry.source as usize + k];
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

/// Position in `(x, u, theta, x+)` of a variable that is at `index` in interval 0 and moves by `step`.
fn local_position(stages: Stages, sizes: Sizes, index: usize, step: usize) -> Option<usize> {
    let globals = stages.globals();
    if globals.contains(&index) {
        return (step == 0).then(|| sizes.n + sizes.m + index - globals.start);
    }
    if step != stages.variable_step() && stages.intervals > 1 {
        return None;
    }
    match index.checked_sub(stages.variable_step()) {
        None => Some(index),
        Some(next) => (next < sizes.n).then(|| sizes.reduced() + next),
    }
}
