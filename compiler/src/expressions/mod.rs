//! Expressions over real inputs, before they are about a model: their graph with the table of
//! functions, intervals, polynomials, and what smooths them.

pub(crate) mod blend;
pub(crate) mod curve;
pub mod graph;
pub mod interval;
pub mod kernels;
pub(crate) mod polynomial;
