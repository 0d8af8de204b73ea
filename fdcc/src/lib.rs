//! Optimal control of systems with friction, switches and impacts: read a model, solve it, check
//! the answer on the true system, differentiate it.

pub mod bounds;
pub mod exact;
pub mod motion;
pub mod parallel;
pub mod quantities;
pub mod stays;
pub mod terms;
