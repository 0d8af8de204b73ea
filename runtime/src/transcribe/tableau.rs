//! The nodes of one-step schemes without stages of their own; those with are in
//! [`super::collocation`].
//!
//! With `F = (tf - t0) f` over normalised time and `h = 1/N`, every scheme here is
//!
//! ```text
//!     x_{k+1} - x_k - h sum_j b_j F(tau_k + c_j h, (1 - w_j) x_k + w_j x_{k+1}, u_k) = 0
//! ```
//!
//! with a blend `w_j` per state. The integral of a cost takes the same nodes and weights, so that
//! it has the order of the scheme.

use crate::problem::{Method, Scheme};

/// One evaluation of the right side in each interval.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Node {
    /// `b`
    pub(crate) weight: f64,
    /// `c`
    pub(crate) time: f64,
    /// `w`, one per state.
    pub(crate) blend: Vec<f64>,
}

/// The nodes of a scheme; none of a collocation scheme, whose states at the nodes are variables.
pub(crate) fn nodes(method: &Method, states: usize) -> Vec<Node> {
    let node = |[weight, time, blend]: &[f64; 3]| {
        let mut node = Node { weight: *weight, time: *time, blend: vec![*blend; states] };
        if method.scheme == Scheme::ImplicitEuler {
            method.lagged.iter().for_each(|state| node.blend[*state] = 0.0);
        }
        node
    };
    method.scheme.evaluations().iter().map(node).collect()
}
