//! A phase in the recursion over several: its stages, with the border that is carried through it.

use super::lifetimes::Item;
use crate::linalg::riccati::chain::Matrix;
use crate::linalg::riccati::recursion::Recursion;
use crate::linalg::riccati::solve::Travel;
use crate::linalg::structure::phases::PhaseStages;
use crate::linalg::structure::stages::Stages;
use crate::linalg::structure::triplets::{Family, Triplets};

/// A phase with its recursion.
pub(super) struct Phase {
    pub of: PhaseStages,
    recursion: Recursion,
    /// Its border.
    pub theta: Vec<Item>,
    /// Where its values are among all.
    hessian: Vec<Copied>,
    jacobian: Vec<Copied>,
    hessian_values: Vec<f64>,
    jacobian_values: Vec<f64>,
    pub travel: Travel,
    /// Its stages, then the unknowns of its border.
    a: Vec<f64>,
    /// A value function, square over `(x, theta)`.
    pub value: Vec<f64>,
}

/// `count` values that follow each other in the matrix of the whole.
#[derive(Clone, Copy)]
struct Copied {
    from: usize,
    count: usize,
}

/// Whether a row belongs to the stages of a phase.
pub(super) fn is_of_stage(phase: &PhaseStages, row: usize) -> bool {
    phase.rows.contains(&row) && row - phase.rows.start < phase.stages.coupling().start
}

impl Phase {
    pub fn new(
        of: &PhaseStages,
        theta: Vec<Item>,
        (hessian, jacobian): (&Triplets, &Triplets),
        fixed: &[bool],
        equality_rows: &[bool],
    ) -> Result<Self, &'static str> {
        let unknowns: Vec<usize> = theta.iter().filter_map(Item::unknown).collect();
        // To the recursion all unknowns of the border are globals, and no row is a coupling row.
        let stages = Stages { globals: unknowns.len(), coupling_constraints: 0, ..of.stages };
        let own = |variable: usize| match unknowns.iter().position(|it| *it == variable) {
            Some(unknown) => Some(of.variables.len() + unknown),
            None => of.variables.contains(&variable).then(|| variable - of.variables.start),
        };
        let row = |row: usize| is_of_stage(of, row).then(|| row - of.rows.start);
        let (hessian, hessian_copies) = families(hessian, of, &own, &own);
        let (jacobian, jacobian_copies) = families(jacobian, of, &row, &own);
        let its_fixed: Vec<bool> =
            of.variables.clone().chain(unknowns.iter().copied()).map(|at| fixed[at]).collect();
        let exact = &equality_rows[of.rows.clone()];
        let matrices = (&hessian, &jacobian);
        let recursion = Recursion::new(stages, theta.len(), matrices, &its_fixed, exact)?;
        let kept = recursion.sizes.kept();
        Ok(Phase {
            travel: Travel::new(recursion.sizes),
            a: vec![0.0; its_fixed.len()],
            value: vec![0.0; kept * kept],
            hessian_values: vec![0.0; hessian.len()],
            jacobian_values: vec![0.0; jacobian.len()],
            hessian: hessian_copies,
            jacobian: jacobian_copies,
            of: of.clone(),
            recursion,
            theta,
        })
    }

    /// Turns the value function of the last state into that of the first.
    pub fn factor(
        &mut self,
        (hessian, jacobian): (&[f64], &[f64]),
        sigma: &[f64],
        d: &[f64],
        most: usize,
    ) -> Option<usize> {
        copy(&self.hessian, hessian, &mut self.hessian_values);
        copy(&self.jacobian, jacobian, &mut self.jacobian_values);
        let matrix = Matrix {
            hessian: &self.hessian_values,
            jacobian: &self.jacobian_values,
            sigma: &sigma[self.of.variables.clone()],
            d: &d[self.of.rows.clone()],
        };
        self.recursion.factor(matrix, &mut self.value, most)
    }

    /// Takes its local rows out of the right side.
    pub fn begin(&mut self, a: &mut [f64], b: &[f64]) {
        let stages = self.of.variables.len();
        self.a[..stages].copy_from_slice(&a[self.of.variables.clone()]);
        self.a[stages..].fill(0.0);
        self.recursion.remove_local_constraints(&mut self.a, &b[self.of.rows.clone()]);
        let unknowns = self.theta.iter().filter_map(Item::unknown);
        unknowns.zip(&self.a[stages..]).for_each(|(place, value)| a[place] += value);
    }

    pub fn backward(&mut self, b: &mut [f64]) {
        self.recursion.backward(&mut self.travel, &mut self.a, &mut b[self.of.rows.clone()]);
    }

    pub fn forward(&mut self, b: &mut [f64]) {
        self.recursion.forward(&mut self.travel, &mut self.a, &mut b[self.of.rows.clone()]);
        let (x, _) = self.travel.state.split_at(self.of.stages.states);
        self.a[self.of.stages.state(self.of.stages.intervals)].copy_from_slice(x);
    }

    /// Gives its stages and local rows their values; those of unknowns are known.
    pub fn finish(&mut self, a: &mut [f64], b: &mut [f64]) {
        let stages = self.of.variables.len();
        a[self.of.variables.clone()].copy_from_slice(&self.a[..stages]);
        for (at, place) in self.theta.iter().filter_map(Item::unknown).enumerate() {
            self.a[stages + at] = a[place];
        }
        self.recursion.local_multipliers(&self.a, &mut b[self.of.rows.clone()]);
    }
}

/// The families of a matrix that belong to the stages of a phase, in its own numbers, and where
/// their values are.
fn families(
    of: &Triplets,
    phase: &PhaseStages,
    row: &dyn Fn(usize) -> Option<usize>,
    column: &dyn Fn(usize) -> Option<usize>,
) -> (Triplets, Vec<Copied>) {
    let (mut own, mut copies, mut from) = (Triplets::default(), Vec::new(), 0);
    for family in &of.families {
        let is_stage = family.count == phase.stages.intervals
            && (family.row_step > 0 || family.column_step > 0);
        if let (true, Some(row), Some(column)) = (is_stage, row(family.row), column(family.column))
        {
            own.families.push(Family { row, column, ..*family });
            copies.push(Copied { from, count: family.count });
        }
        from += family.count;
    }
    (own, copies)
}

fn copy(copies: &[Copied], from: &[f64], to: &mut [f64]) {
    let mut at = 0;
    for copied in copies {
        to[at..at + copied.count].copy_from_slice(&from[copied.from..][..copied.count]);
        at += copied.count;
    }
}
