//! A tape, linearised: each step and each event as a linear map, and the product of all, which
//! solves the variational equation.

mod controls;
pub(crate) mod event;
pub(crate) mod linearisation;
mod reset;
mod sparse_step;
pub(crate) mod step;
pub(crate) mod surface;
pub(crate) mod variational_equation;
