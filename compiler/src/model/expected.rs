//! What is asked of a solution: reports and expectations.

use super::{Place, Symbol};
use crate::expressions::graph::ExprId;

/// One scalar of the `report` block.
#[derive(Clone, Debug)]
pub struct Report {
    /// Its name, with the part for a vector.
    pub place: Place,
    /// Its value over time.
    pub value: ExprId,
}

/// How the two sides of an expectation compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// `==`
    Equal,
    /// `<=`
    LessEqual,
    /// `>=`
    GreaterEqual,
}

/// One line of the `expect` block.
#[derive(Clone, Debug)]
pub struct Expectation {
    /// The line; named by its text.
    pub place: Place,
    /// The comparison.
    pub comparison: Comparison,
    /// Left side, right side and tolerance.
    pub values: [ExprId; 3],
}

/// A number that only a simulation of the true system can tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Simulated {
    /// For how long a surface is held.
    Sliding(usize),
    /// The derivative of a number.
    Sensitivity {
        /// Over the symbols that an objective may read.
        of: ExprId,
        /// A parameter, an unknown or a start.
        by: Symbol,
    },
}
