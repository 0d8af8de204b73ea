//! **The table** of linear solvers. A new one is a file that implements [`Factor`] and a row here.

use super::cost::{is_sparse_cheaper, is_sparse_cheaper_for};
use super::riccati::{PhasedRiccati, Riccati};
use super::sparse_ldl::SparseLdl;
use super::structure::factor::Factor;
use super::structure::phases::PhaseStages;
use super::structure::stages::Stages;
use super::structure::triplets::Triplets;
use crate::problem::Linear;

/// The matrix before it has values.
#[derive(Clone)]
pub(crate) struct Structure<'a> {
    /// Of one chain.
    pub(crate) stages: Option<Stages>,
    /// Of several.
    pub(crate) phases: Vec<PhaseStages>,
    pub(crate) hessian: &'a Triplets,
    pub(crate) jacobian: &'a Triplets,
    /// Which variables have one value only.
    pub(crate) fixed: &'a [bool],
    /// Which rows are exact equalities.
    pub(crate) equality: &'a [bool],
}

/// A linear solver: its name in models, and its preparation, where it can treat the structure.
type Row = (Linear, fn(&Structure) -> Option<Box<dyn Factor>>);

/// The fastest first, the most robust last.
const SOLVERS: [Row; 2] = [(Linear::Riccati, riccati), (Linear::SparseLdl, sparse_ldl)];

fn riccati(of: &Structure) -> Option<Box<dyn Factor>> {
    // What belongs to the only interval cannot be told from what belongs to the ends.
    if of.phases.iter().any(|phase| phase.stages.intervals < 2) {
        return None;
    }
    let matrices = (of.hessian, of.jacobian);
    if !of.phases.is_empty() {
        let factor = PhasedRiccati::new(&of.phases, matrices, of.fixed, of.equality).ok()?;
        return Some(Box::new(factor));
    }
    let stages = of.stages.filter(|stages| stages.intervals > 1)?;
    let factor = Riccati::new(stages, of.hessian, of.jacobian, of.fixed, of.equality).ok()?;
    Some(Box::new(factor))
}

fn sparse_ldl(of: &Structure) -> Option<Box<dyn Factor>> {
    Some(Box::new(SparseLdl::new(of.hessian, of.jacobian, of.fixed, of.equality.len())))
}

/// The solver that is asked for, or the next one of the table that can treat the structure.
pub(crate) fn prepare(linear: Linear, of: &Structure) -> (Linear, Box<dyn Factor>) {
    let first = SOLVERS.iter().position(|row| row.0 == linear).unwrap_or(0);
    let mut able = SOLVERS[first..].iter().filter_map(|row| Some((row.0, row.1(of)?)));
    able.next().expect("the last one treats every structure")
}

/// The next one of the table, which is more robust; none after the last.
pub(crate) fn more_robust(linear: Linear) -> Option<Linear> {
    let at = SOLVERS.iter().position(|row| row.0 == linear)?;
    SOLVERS.get(at + 1).map(|row| row.0)
}

/// The solver to begin with where the choice is open: the recursion wherever there are stages,
/// unless its border makes it too dear.
pub(crate) fn cheapest(
    stages: Option<Stages>,
    phases: &[PhaseStages],
    hessian: &Triplets,
    jacobian: &Triplets,
) -> Linear {
    match stages {
        None if phases.is_empty() => Linear::SparseLdl,
        None if !is_sparse_cheaper_for(phases, hessian, jacobian) => Linear::Riccati,
        Some(stages) if !is_sparse_cheaper(stages, hessian, jacobian) => Linear::Riccati,
        _ => Linear::SparseLdl,
    }
}
