//! Numbers: from a [`problem::Problem`] to solutions.
//!
//! ```text
//! Problem -- transcribe --> TranscribedNlp -- nlp::interior_point --> Solution --> Trajectory
//! ```
//!
//! Start reading at [`problem`] (the contract) and [`nlp::interior_point`] (the loop).

pub mod problem;

pub mod lagrange;
mod random;

pub mod linalg;

pub mod nlp;

pub mod transcribe;

pub mod solution;

pub mod solve;

pub mod simulate;

pub mod sensitivity;

pub mod fixed_step;
