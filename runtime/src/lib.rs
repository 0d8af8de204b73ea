//! Numbers: from a [`problem::Problem`] to solutions.
//!
//! ```text
//! Problem -- transcribe --> TranscribedNlp -- nlp::interior_point --> Solution --> Trajectory
//! ```
//!
//! Start reading at [`problem`] (the contract) and [`nlp::interior_point`] (the loop).

pub mod problem;

mod clarabel;
pub mod linalg;

pub mod nlp;
pub mod transcribe;

pub mod lagrangian;
mod minimum;
pub mod modes;
pub mod quadrature;
pub mod trajectory;

mod pause;

pub mod simulate;
pub mod stepping;

pub mod sensitivity;

mod prolong;
pub mod starts;
pub mod warm;

pub mod homotopy;
pub mod pieces;
pub mod refine;
