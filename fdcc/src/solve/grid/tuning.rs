//! The numbers of ranges.

/// More values are a mistake.
pub(super) const MOST: f64 = 1e8;
/// The last step may miss the end by so much of a step.
pub(super) const ROUNDING: f64 = 1e-6;
/// More decimals a number does not have.
pub(super) const DECIMALS: i32 = 17;
