//! Linear algebra of the optimality conditions: one matrix, two factorisations.
//!
//! ```text
//!     [ H + diag(sigma)    J'      ] [ dv      ]   [ a ]
//!     [ J                 -diag(d) ] [ dlambda ] = [ b ]
//! ```
//!
//! `H` is the Lagrangian Hessian, `J` the Jacobian of all rows. `sigma >= 0` holds barrier terms
//! and primal regularisation; `d >= 0` holds what the elimination of a slack leaves (inequality
//! rows), dual regularisation, or the penalty of a restoration phase. Inertia is right if there are
//! as many positive eigenvalues as variables and as many negative ones as rows.

#[cfg(test)]
mod conformance;
#[cfg(test)]
mod conformance_of_phases;
mod cost;
pub(crate) mod dense;
mod products;
pub mod riccati;
pub(crate) mod solvers;
pub mod sparse_ldl;
pub(crate) mod structure;

pub use dense::lanes::is_fused;
pub(crate) use products::Products;
pub(crate) use structure::columns::Columns;
pub use structure::factor::{Factor, Inertia};
pub use structure::phases::PhaseStages;
pub use structure::stages::Stages;
pub use structure::triplets::{Family, Triplets};
