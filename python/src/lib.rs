//! The half of the Python package that is Rust: models, solutions, simulations and gradients of the
//! library, lent to `package/fdcc`, which gives them the face that users see.

mod cases;
mod column;
mod controller;
mod errors;
mod gradient;
mod inputs;
mod model;
mod simulation;
mod solution;
mod watch;

/// What `fdcc` is made of; use `fdcc` instead.
#[pyo3::pymodule]
mod _fdcc {
    #[pymodule_export]
    use super::cases::Cases;
    #[pymodule_export]
    use super::column::Column;
    #[pymodule_export]
    use super::controller::Controller;
    #[pymodule_export]
    use super::gradient::Gradient;
    #[pymodule_export]
    use super::model::{Model, check};
    #[pymodule_export]
    use super::simulation::Simulation;
    #[pymodule_export]
    use super::solution::Solution;
}
