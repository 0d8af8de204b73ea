//! The block structure of several chains of stages that are tied together.

use super::stages::Stages;
use std::ops::Range;

/// A chain of stages among the variables and rows of a larger problem.
#[derive(Clone, Debug)]
pub struct PhaseStages {
    /// Its own sizes; its globals are unknowns of the whole, its coupling rows come last.
    pub stages: Stages,
    /// Its stages among all variables.
    pub variables: Range<usize>,
    /// Its globals, as places among all variables.
    pub globals: Vec<usize>,
    /// Its rows among all rows.
    pub rows: Range<usize>,
}

impl PhaseStages {
    /// What one number per variable of the whole is for the phase.
    pub(crate) fn own(&self, of: &[f64]) -> Vec<f64> {
        let globals = self.globals.iter().map(|place| of[*place]);
        of[self.variables.clone()].iter().copied().chain(globals).collect()
    }

    /// The place among all variables of one of its own.
    pub(crate) fn place(&self, own: usize) -> usize {
        match own.checked_sub(self.variables.len()) {
            Some(global) => self.globals[global],
            None => self.variables.start + own,
        }
    }

    /// The first state among all variables.
    pub(crate) fn first(&self) -> Range<usize> {
        let own = self.stages.state(0);
        self.variables.start + own.start..self.variables.start + own.end
    }

    /// The last state among all variables.
    pub(crate) fn last(&self) -> Range<usize> {
        let own = self.stages.state(self.stages.intervals);
        self.variables.start + own.start..self.variables.start + own.end
    }
}
