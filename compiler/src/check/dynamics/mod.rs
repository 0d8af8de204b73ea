//! Checks of time and of the right side.

pub(super) mod duration;
pub(super) mod equations;
pub(super) mod finite;
pub(super) mod idle_jump;
pub(super) mod moving_rest;
pub(super) mod needs_time;
