//! From the syntax tree to compiled functions.

pub mod builtins;
pub mod differentiate;
pub mod generate;
pub mod graph;
pub mod program;
pub mod smooth;
