//! The recursion along one chain of stages, without its ends.

use super::assemble::Assembly;
use super::chain::Matrix;
use super::condense::Condensed;
use super::factors::Factors;
use super::interval::Block;
use super::sizes::Sizes;
use super::value::Value;
use crate::linalg::dense::lanes::is_fused;
use crate::linalg::structure::stages::Stages;
use crate::linalg::structure::triplets::Triplets;

/// The stages of a chain, with all memory.
pub(super) struct Recursion {
    pub(super) stages: Stages,
    pub(super) sizes: Sizes,
    /// Whether the machine multiplies and adds in one instruction.
    pub(super) fused: bool,
    pub(super) fixed: Vec<bool>,
    pub(super) assembly: Assembly,
    pub(super) condensed: Condensed,
    pub(super) block: Block,
    pub(super) factors: Factors,
    /// The value function of the stage being left.
    pub(super) value: Value,
}

impl Recursion {
    /// Prepares the recursion with a border of size `theta`, or says why the structure does not
    /// allow it; see [`super::Riccati::new`].
    pub(super) fn new(
        stages: Stages,
        theta: usize,
        (hessian, jacobian): (&Triplets, &Triplets),
        fixed: &[bool],
        equality_rows: &[bool],
    ) -> Result<Self, &'static str> {
        if stages.states == 0 {
            return Err("there are no states");
        }
        if (1..=stages.intervals).any(|k| stages.state(k).any(|i| fixed[i])) {
            return Err("a state is fixed inside the chain");
        }
        if (0..stages.intervals).any(|k| stages.inner(k).any(|i| fixed[i])) {
            return Err("an inner variable is fixed");
        }
        if (0..stages.intervals).any(|k| stages.local(k).any(|i| equality_rows[i])) {
            return Err("an equality holds at every stage");
        }
        let sizes = Sizes { n: stages.states, m: stages.controls, inner: stages.inner, q: theta };
        let assembly = Assembly::new(stages, sizes, hessian, jacobian)
            .ok_or("entries couple distant stages")?;
        let local_values = assembly.local_entries.len();
        Ok(Recursion {
            stages,
            sizes,
            fused: is_fused(),
            fixed: fixed.to_vec(),
            condensed: Condensed::new(sizes, stages, &assembly),
            block: Block::new(sizes),
            factors: Factors::new(sizes, stages.intervals, stages.local_constraints, local_values),
            assembly,
            value: Value::new(sizes),
        })
    }

    /// Turns the value function of the last state into that of the first, both as a square matrix
    /// over `(x, theta)`. Returns how many negative eigenvalues there are beyond one per row;
    /// nothing at a zero pivot, or where there are more than `most`.
    pub(super) fn factor(
        &mut self,
        matrix: Matrix,
        ends: &mut [f64],
        most: usize,
    ) -> Option<usize> {
        let (stages, defects) = (self.stages, self.stages.defect_rows());
        let mut intervals = matrix.d.chunks(stages.row_step().max(1)).take(stages.intervals);
        self.factors.penalised = intervals.any(|d| d[..defects].iter().sum::<f64>() > 0.0);
        self.value.set(self.sizes, ends);
        let negative = self.factor_chain(matrix, most)?;
        self.value.write(self.sizes, ends);
        Some(negative)
    }
}
