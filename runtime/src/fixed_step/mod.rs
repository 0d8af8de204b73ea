//! Fixed steps through the differential inclusion itself, without events, and the exact gradient of
//! what they compute.
//!
//! ```text
//! Grid -- rule --> one step (a mixed complementarity problem) -- run --> Stepped
//!      -- gradient (adjoint) --> Gradient
//! ```
//!
//! Values converge with the step; gradients do not, however small it is
//! (`docs/method/stepping.md`). That is what this is for: to show it beside the true gradient. A
//! system without surfaces gets the ordinary one-step methods.

mod field;
mod gradient;
mod linearised;
mod rule;
mod run;
mod step;

pub use gradient::{Gradient, gradient};
pub use rule::Grid;
pub use run::{Failure, Stepped, step_through};
