//! Numbers: from a [`problem::Problem`] to solutions.
//!
//! Start reading at [`nlp::interior_point`].

mod clarabel;
pub mod linalg;
pub mod nlp;
pub mod problem;
pub mod transcribe;
