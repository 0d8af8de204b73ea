//! Checks of names alone.

pub(super) mod lookalike;
pub(super) mod unused;
