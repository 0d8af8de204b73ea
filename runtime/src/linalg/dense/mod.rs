//! Small dense matrices, and groups of numbers that are computed at the same time.

pub(crate) mod eigen;
pub(crate) mod lanes;
pub(crate) mod lu;
pub(crate) mod symmetric;
