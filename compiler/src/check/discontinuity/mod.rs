//! Checks of what is not smooth: sets, knots and kinks, jumps that nobody named.

pub(super) mod hidden_jump;
pub(super) mod joints;
pub(super) mod sets;
pub(super) mod smoothness;
