//! What a factorisation costs, and which of the two is cheaper.
//!
//! The recursion carries all of its border `theta` through every interval. With `w = (x, theta,
//! u)`, `kept = (x, theta)` and `next = (y, x+)` it takes about
//!
//! ```text
//!     N ( next^2 (2 w + next) + 3/2 next w^2 + kept^2 w + n w^2 )
//! ```
//!
//! multiplications ([`super::riccati`]). That is little while the border is small; but each unknown
//! of a large fit, and each condition between the ends, is one more variable or row of the border,
//! which hardly any state may have to do with.

use super::sparse_ldl::SparseLdl;
use super::structure::phases::PhaseStages;
use super::structure::stages::Stages;
use super::structure::triplets::Triplets;
use std::collections::BTreeSet;

/// So many multiplications the recursion makes while the sparse factorisation makes one; measured
/// were 6 to 12. What is in doubt is the recursion's, whose inertia is exact.
const DENSE_SPEED: f64 = 16.0;

/// The recursion treats what is inside an interval as dense: of many steps in one, or many stages,
/// that may be most of its work and memory.
const FEW_INNER: usize = 100;

/// With no more links, and globals, than this beyond what is in a stage the recursion of phases is
/// quick enough.
const FEW_LINKS: usize = 50;

/// Whether the sparse factorisation takes less time than the recursion. It is analysed for that
/// only if the border is larger than a stage, or if there is much inside an interval.
pub(super) fn is_sparse_cheaper(stages: Stages, hessian: &Triplets, jacobian: &Triplets) -> bool {
    if border(stages) <= stages.states + stages.controls && stages.inner <= FEW_INNER {
        return false;
    }
    let sparse = SparseLdl::new(hessian, jacobian, &vec![false; stages.variables()], stages.rows());
    multiplications(stages) > DENSE_SPEED * sparse.multiplications()
}

/// The same of several phases. What links them is part of the border of each of its phases.
pub(super) fn is_sparse_cheaper_for(
    phases: &[PhaseStages],
    hessian: &Triplets,
    jacobian: &Triplets,
) -> bool {
    let bordered = |phase: &PhaseStages| Stages {
        coupling_constraints: phase.stages.coupling_constraints + links(phase, phases, jacobian),
        ..phase.stages
    };
    let bordered: Vec<Stages> = phases.iter().map(bordered).collect();
    if bordered.iter().all(|stages| border(*stages) <= FEW_LINKS + stages.states + stages.controls)
    {
        return false;
    }
    let variables = phases.iter().flat_map(|it| it.globals.iter().map(|at| at + 1));
    let variables = variables.chain(phases.iter().map(|it| it.variables.end)).max().unwrap_or(0);
    let rows =
        jacobian.families.iter().map(|it| it.row + 1 + it.count.saturating_sub(1) * it.row_step);
    let rows = rows.chain(phases.iter().map(|it| it.rows.end)).max().unwrap_or(0);
    let sparse = SparseLdl::new(hessian, jacobian, &vec![false; variables], rows);
    let recursion: f64 = bordered.into_iter().map(multiplications).sum();
    recursion > DENSE_SPEED * sparse.multiplications()
}

/// How many rows that belong to no phase read something of one.
fn links(phase: &PhaseStages, phases: &[PhaseStages], jacobian: &Triplets) -> usize {
    let is_link = |row: usize| phases.iter().all(|it| !it.rows.contains(&row));
    let own = jacobian.families.iter().filter(|it| phase.variables.contains(&it.column));
    let rows = own.filter(|it| is_link(it.row));
    let rows = rows.flat_map(|it| (0..it.count).map(|k| it.row + k * it.row_step));
    rows.collect::<BTreeSet<usize>>().len()
}

fn border(stages: Stages) -> usize {
    stages.globals + stages.coupling_constraints
}

/// Of the recursion.
fn multiplications(stages: Stages) -> f64 {
    let Stages { intervals, states, controls, .. } = stages;
    let kept = (states + border(stages)) as f64;
    let (n, w, next) = (states as f64, kept + controls as f64, stages.defect_rows() as f64);
    let interval =
        next * next * (2.0 * w + next) + 1.5 * next * w * w + kept * kept * w + n * w * w;
    intervals as f64 * interval
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::structure::triplets::Family;

    /// States with an unknown rate each, where each ends at which the next one begins.
    fn rates(count: usize) -> (Stages, Triplets, Triplets) {
        let stages = Stages {
            intervals: 100,
            states: count,
            controls: 0,
            inner: 0,
            globals: count,
            local_constraints: 0,
            coupling_constraints: count,
        };
        let (step, globals) = (stages.variable_step(), stages.globals());
        let repeat = |row, column, row_step, column_step| Family {
            row,
            column,
            row_step,
            column_step,
            count: 100,
        };
        let mut hessian: Vec<Family> = (0..step).map(|i| repeat(i, i, step, step)).collect();
        let mut jacobian = Vec::new();
        for i in 0..count {
            let length = globals.start + i;
            hessian.push(repeat(length, i, 0, step));
            jacobian.extend([i, step + i].map(|column| repeat(i, column, count, step)));
            jacobian.push(repeat(i, length, count, 0));
            let (row, end) = (stages.coupling().start + i, stages.state(100).start + i);
            jacobian.extend([Family::single(row, end), Family::single(row, (i + 1) % count)]);
        }
        (stages, Triplets { families: hessian }, Triplets { families: jacobian })
    }

    /// One state, and many steps of it inside of each interval.
    fn steps(inner: usize) -> (Stages, Triplets, Triplets) {
        let stages = Stages {
            intervals: 100,
            states: 1,
            controls: 0,
            inner,
            globals: 0,
            local_constraints: 0,
            coupling_constraints: 1,
        };
        let (step, rows) = (stages.variable_step(), stages.row_step());
        let family =
            |row, column, row_step| Family { row, column, row_step, column_step: step, count: 100 };
        let hessian = (0..step).map(|i| family(i, i, step)).collect();
        // Each step sees its own value and the next one.
        let mut jacobian: Vec<Family> =
            (0..rows).flat_map(|i| [i, i + 1].map(|column| family(i, column, rows))).collect();
        jacobian.push(Family::single(stages.coupling().start, stages.state(100).start));
        (stages, Triplets { families: hessian }, Triplets { families: jacobian })
    }

    #[test]
    fn many_steps_in_an_interval_are_for_the_sparse_factorisation_and_few_are_not() {
        let is_sparse = |inner| {
            let (stages, hessian, jacobian) = steps(inner);
            is_sparse_cheaper(stages, &hessian, &jacobian)
        };
        assert!(!is_sparse(20) && is_sparse(400));
    }

    #[test]
    fn many_unknowns_of_one_state_each_are_for_the_sparse_factorisation_and_one_is_not() {
        let is_sparse = |count| {
            let (stages, hessian, jacobian) = rates(count);
            is_sparse_cheaper(stages, &hessian, &jacobian)
        };
        assert!(!is_sparse(1) && is_sparse(8));
    }
}
