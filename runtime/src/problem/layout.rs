//! The inputs of a function.

use std::ops::Range;

/// How many inputs of each kind a function has. Their order is always `z = [t | x | u | p | s]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Times (0 or 1).
    pub t: usize,
    /// States; twice the states (start, then end) for boundary functions.
    pub x: usize,
    /// Controls.
    pub u: usize,
    /// Parameters: the `param`s, the `free` unknowns and the smoothing widths.
    pub p: usize,
    /// Selectors, one per surface; in a simulation, then one for each kink of the right side.
    pub s: usize,
}

impl Layout {
    /// Number of inputs.
    pub fn inputs(&self) -> usize {
        self.t + self.x + self.u + self.p + self.s
    }
    /// Positions of the states.
    pub fn states(&self) -> Range<usize> {
        self.t..self.t + self.x
    }
    /// Positions of the controls.
    pub fn controls(&self) -> Range<usize> {
        self.t + self.x..self.t + self.x + self.u
    }
    /// Positions of the parameters.
    pub fn parameters(&self) -> Range<usize> {
        let start = self.t + self.x + self.u;
        start..start + self.p
    }
    /// Positions of the selectors.
    pub fn selectors(&self) -> Range<usize> {
        let start = self.t + self.x + self.u + self.p;
        start..start + self.s
    }
    /// Inputs that differ from point to point of a grid: `[t | x | u | s]`, all but the parameters.
    pub fn point_inputs(&self) -> usize {
        self.t + self.x + self.u + self.s
    }
}
