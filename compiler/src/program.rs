//! Vector functions over one graph: what lowering makes, what differentiation adds.

use fdcc_runtime::problem::{Degree, Layout, Origin, Pattern};

use crate::graph::ExprId;

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

/// A function with its derivatives.
#[derive(Clone, Debug)]
pub struct Differentiated {
    /// The function itself.
    pub function: VectorFunction,
    /// `dy/dz`: which entries, and their expressions.
    pub jacobian: (Pattern, Vec<ExprId>),
    /// The lower triangle of the Hessian of `sum_i multiplier(i) * y_i`.
    pub hessian: (Pattern, Vec<ExprId>),
    /// How each output depends on the inputs it was differentiated by.
    pub degrees: Vec<Degree>,
}
