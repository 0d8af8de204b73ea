//! What a person is told of a solve: while it runs, when it ends, and where it failed.

pub mod attempts;
pub mod failure;
pub mod log;
pub mod verdict;
