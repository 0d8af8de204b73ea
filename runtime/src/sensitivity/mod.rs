//! Exact derivatives of the true system: forward sensitivities and adjoints through crossings,
//! sliding and resets.
//!
//! ```text
//! simulate (with a tape) -> linear maps, piece by piece (linearised)
//!     -> forward, adjoint (first_order), Hessian (second_order)
//! ```
//!
//! Steps are as short as derivatives need them: those of a state at rest would be too long.
//!
//! A step is differentiated as it was computed ([`step`](self)), an event by its saltation matrix,
//! sliding with the oblique projection. [`gradient()`] is the entry.

mod first_order;
mod linearised;
mod nondifferentiability;
mod second_order;
mod tuning;

pub use first_order::gradient::{Costates, Sensitivity};
pub use first_order::one_sided::one_sided;
pub use first_order::perturbed::perturbed;
pub use first_order::quantity::Quantity;
pub use first_order::resolved::{finer, gradient};
pub(crate) use linearised::linearisation::Jacobian;
pub use nondifferentiability::kink::{Kink, KinkMet};
pub use nondifferentiability::{Nondifferentiability, NondifferentiabilityKind};
pub use second_order::hessian;
