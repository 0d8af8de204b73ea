//! Exact derivatives of the true system: forward sensitivities and adjoints through crossings,
//! sliding and resets.
//!
//! ```text
//! simulate (with a tape) -> linear maps, piece by piece (sweep) -> forward, adjoint (first_order), Hessian (second_order)
//! ```
//!
//! A step is differentiated as it was computed ([`step`](self)), an event by its saltation matrix,
//! sliding with the oblique projection. [`gradient()`] is the entry.

mod bend;
mod curvature;
mod first_order;
mod gradient;
mod kink;
mod linearization;
mod one_sided;
mod perturbed;
mod quantity;
mod reset;
mod second_order;
mod sparse_step;
mod step;
mod stop;
mod surface;
mod sweep;
mod trouble;

pub use gradient::{Costates, Sensitivity, gradient};
pub use kink::Kink;
pub use one_sided::one_sided;
pub use perturbed::perturbed;
pub use quantity::Quantity;
pub use second_order::hessian;
pub use trouble::{Trouble, TroubleKind};
