//! The numbers of replays.

/// Rows of controls may begin so much of the whole time after its end.
pub(super) const SLACK: f64 = 1e-9;
/// A node is outside of its interval by rounding if it is by no more than this part of it.
pub(super) const ROUNDING: f64 = 1e-6;
