//! Vector functions over one graph: what lowering makes.

use fdcc_runtime::problem::{Layout, Origin};

use crate::expressions::graph::ExprId;

/// `y = f(z)` as expressions of a graph.
#[derive(Clone, Debug)]
pub struct VectorFunction {
    /// For dumps: `dynamics`, `path`, ...
    pub name: String,
    /// Sizes of the inputs.
    pub layout: Layout,
    /// `y`.
    pub outputs: Vec<ExprId>,
    /// Where each output comes from.
    pub origins: Vec<Origin>,
    /// The inputs to differentiate by, ascending; none if only values are needed.
    pub by: Vec<u32>,
    /// The highest derivatives that are needed.
    pub order: Order,
}

/// How far a function is differentiated by its inputs [`VectorFunction::by`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Order {
    /// The Jacobian.
    First,
    /// The Jacobian and the Hessian.
    Second,
}
