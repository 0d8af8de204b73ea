//! The numbers of warm starts.

/// What is outside by no more than this part of all times is so by rounding.
pub(super) const ROUNDING: f64 = 1e-6;
