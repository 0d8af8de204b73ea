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
mod cost;
mod lanes;
pub(crate) mod lu;
mod multifrontal;
mod products;
pub mod riccati;
pub mod sparse_ldl;
mod stages;
mod symmetric;
mod triplets;

pub(crate) use cost::is_sparse_cheaper;
pub(crate) use products::Products;
pub use stages::Stages;
pub(crate) use symmetric::SymmetricFactor;
pub use triplets::{Family, Triplets};

/// What a factorisation found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inertia {
    /// Positive on the null space of the rows: the step is a descent direction.
    Correct,
    /// Some direction of negative curvature: regularise the Hessian.
    Wrong,
    /// A zero pivot: regularise the rows.
    Singular,
}

/// A factorisation of the matrix above. Variables marked as fixed at construction have `dv = 0`.
pub trait Factor {
    /// Factors with new values; `sigma` has one entry per variable, `d` one per row.
    fn factor(&mut self, hessian: &[f64], jacobian: &[f64], sigma: &[f64], d: &[f64]) -> Inertia;
    /// Replaces `[a; b]` by `[dv; dlambda]`.
    fn solve(&mut self, right_side: &mut [f64]);
}
