//! Numbers: from a [`problem::Problem`] to solutions.

pub mod problem;
