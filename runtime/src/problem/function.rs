//! Functions with exact derivatives.

use super::{Columns, Layout};
use std::sync::Arc;

/// Which entries of a matrix are not zero by structure: (row, column), sorted by row, then column.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Pattern {
    /// Rows of the matrix.
    pub rows: usize,
    /// Columns of the matrix.
    pub columns: usize,
    /// The entries.
    pub entries: Vec<(u32, u32)>,
}

/// How a function depends on what the optimiser chooses (states, controls, `free` parameters).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Degree {
    /// Constant derivative.
    Affine,
    /// Constant second derivative.
    Quadratic,
    /// Anything else.
    Nonlinear,
}

/// Where in the model something comes from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Origin {
    /// In the model's words, such as `track` or `vel.x'`.
    pub label: Arc<str>,
    /// Byte range in the text of the model.
    pub span: (u32, u32),
}

/// `y = f(z)` with `z = [t | x | u | p | s]`, known sparsity and exact derivatives, over a whole
/// grid per call.
///
/// `points` holds the columns `[t | x | u | s]`; `parameters` is the same at all points. The
/// Jacobian and the Hessian cover the inputs the function was differentiated by; pattern columns
/// are positions in `z`. All tables have as many points as `points`. Nothing is checked but sizes,
/// by `assert!`.
pub trait Function: Send + Sync {
    /// Sizes of the inputs.
    fn layout(&self) -> &Layout;
    /// Number of outputs.
    fn outputs(&self) -> usize;
    /// Entries of dy/dz.
    fn jacobian_pattern(&self) -> &Pattern;
    /// Entries of the lower triangle of the Hessian of `multipliers . y`.
    fn hessian_pattern(&self) -> &Pattern;
    /// How one output depends on the differentiated inputs.
    fn degree(&self, row: usize) -> Degree;
    /// Where one output comes from.
    fn origin(&self, row: usize) -> Origin;
    /// Gets ready to be called often for derivatives up to this order, 0 for values alone.
    fn prepare(&self, order: usize);
    /// The outputs: one column each.
    fn value(&self, points: &Columns, parameters: &[f64], values: &mut Columns);
    /// Outputs and Jacobian: one column per output, one per pattern entry.
    fn jacobian(
        &self,
        points: &Columns,
        parameters: &[f64],
        values: &mut Columns,
        jacobian: &mut Columns,
    );
    /// Outputs, Jacobian and the Hessian of `multipliers . y` (one column of multipliers per
    /// output) in one pass.
    fn derivatives(
        &self,
        points: &Columns,
        parameters: &[f64],
        multipliers: &Columns,
        values: &mut Columns,
        jacobian: &mut Columns,
        hessian: &mut Columns,
    );
}
