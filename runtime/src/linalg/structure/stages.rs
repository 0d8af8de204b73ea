//! The block structure of a problem that is a chain of stages.
//!
//! ```text
//! variables   x_0 u_0 y_0  x_1 u_1 y_1  ...  x_{N-1} u_{N-1} y_{N-1}  x_N  g
//! rows        defects_0 local_0   defects_1 local_1   ...   coupling
//! ```
//!
//! Rows of interval `k` see only `x_k, u_k, y_k, x_{k+1}` and the globals `g`; there are as many
//! defects as inner variables `y_k` and states, and they are regular in `(y_k, x_{k+1})`.
//! Coupling rows see only `x_0, x_N` and `g`. The Hessian couples only what some row couples.

use std::ops::Range;

/// Sizes of a chain of stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stages {
    /// Number of intervals, `N`.
    pub intervals: usize,
    /// States per stage.
    pub states: usize,
    /// Controls per interval.
    pub controls: usize,
    /// Inner variables per interval, which its defects determine: the states at the nodes of a
    /// collocation scheme.
    pub inner: usize,
    /// Variables that belong to no stage.
    pub globals: usize,
    /// Rows per interval beside the defects.
    pub local_constraints: usize,
    /// Rows that belong to no interval.
    pub coupling_constraints: usize,
}

impl Stages {
    /// Variables from one stage to the next.
    pub fn variable_step(&self) -> usize {
        self.states + self.controls + self.inner
    }
    /// Rows from one interval to the next.
    pub fn row_step(&self) -> usize {
        self.defect_rows() + self.local_constraints
    }
    /// Defects of an interval.
    pub fn defect_rows(&self) -> usize {
        self.inner + self.states
    }
    /// All variables.
    pub fn variables(&self) -> usize {
        self.intervals * self.variable_step() + self.states + self.globals
    }
    /// All rows.
    pub fn rows(&self) -> usize {
        self.intervals * self.row_step() + self.coupling_constraints
    }
    /// `x_k`
    pub fn state(&self, k: usize) -> Range<usize> {
        let start = k * self.variable_step();
        start..start + self.states
    }
    /// `u_k`
    pub fn control(&self, k: usize) -> Range<usize> {
        let start = k * self.variable_step() + self.states;
        start..start + self.controls
    }
    /// `y_k`
    pub fn inner(&self, k: usize) -> Range<usize> {
        let end = (k + 1) * self.variable_step();
        end - self.inner..end
    }
    /// `g`
    pub fn globals(&self) -> Range<usize> {
        self.variables() - self.globals..self.variables()
    }
    /// Defects of interval `k`.
    pub fn defects(&self, k: usize) -> Range<usize> {
        let start = k * self.row_step();
        start..start + self.defect_rows()
    }
    /// Local rows of interval `k`.
    pub fn local(&self, k: usize) -> Range<usize> {
        let start = k * self.row_step() + self.defect_rows();
        start..start + self.local_constraints
    }
    /// Coupling rows.
    pub fn coupling(&self) -> Range<usize> {
        self.intervals * self.row_step()..self.rows()
    }
}
