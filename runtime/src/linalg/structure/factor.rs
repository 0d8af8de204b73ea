//! What a factorisation of the matrix of the optimality conditions must do ([`crate::linalg`]).

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

/// A factorisation of the matrix of the optimality conditions ([`crate::linalg`]). Variables marked
/// as fixed at construction have `dv = 0`.
pub trait Factor {
    /// Factors with new values; `sigma` has one entry per variable, `d` one per row.
    fn factor(&mut self, hessian: &[f64], jacobian: &[f64], sigma: &[f64], d: &[f64]) -> Inertia;
    /// Replaces `[a; b]` by `[dv; dlambda]`.
    fn solve(&mut self, right_side: &mut [f64]);
}
