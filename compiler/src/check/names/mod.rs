//! Checks of names alone.

pub(super) mod lookalike;
pub(super) mod twice;
pub(super) mod unused;
