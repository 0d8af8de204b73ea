//! Stage-wise factorisation of the optimality conditions: cost linear in the number of stages.
//!
//! The value function of the stages from `k` on is kept as a quadratic in `z = (x_k, theta)`, where
//! the border `theta = (g, nu, x0)` holds the globals, the multipliers of the coupling rows and,
//! where the ends of the chain are coupled by curvature, a copy of the initial state:
//!
//! ```text
//!     V_k(x, theta) = 1/2 [x; theta]' [ P       Lambda ] [x; theta]  +  [v_x; v_theta]' [x; theta]
//!                                     [ Lambda' Theta  ]
//! ```
//!
//! Going backward, [`interval`] puts the Hessian over `(x_k, theta, u_k, y_k, x_{k+1})` together
//! with `V_{k+1}`, removes `(y_k, x_{k+1})` by the linearised defects and then `u_k` by its own
//! block; [`solve`] uses what is kept of that ([`factors`]). What is left at `k = 0` is one small
//! dense symmetric system in `(x_0, theta)`: [`border`]. Signs of all pivots give the inertia
//! exactly (Haynsworth), so a control block may be indefinite as long as the whole is right.

mod assemble;
mod border;
mod chain;
mod compliance;
mod condense;
mod elimination;
mod factors;
mod interval;
mod kernels;
mod local;
mod phases;
mod recursion;
mod sizes;
mod solve;
mod value;

use super::structure::factor::{Factor, Inertia};
use super::structure::stages::Stages;
use super::structure::triplets::Triplets;
use border::Border;
use chain::Matrix;
pub(super) use phases::PhasedRiccati;
use recursion::Recursion;
use solve::Travel;

/// The recursion along one chain, with both its ends.
pub struct Riccati {
    recursion: Recursion,
    border: Border,
    /// `[P Lambda; Lambda' Theta]` of the last stage, then of the first.
    ends: Vec<f64>,
    travel: Travel,
    /// Right side of the last system.
    last: Vec<f64>,
}

impl Riccati {
    /// Prepares the recursion, or says why the structure does not allow it: no states, a state that
    /// is fixed inside the chain, an equality at every stage, or entries that couple distant
    /// stages. `equality_rows[i]` says that row `i` has no slack.
    pub fn new(
        stages: Stages,
        hessian: &Triplets,
        jacobian: &Triplets,
        fixed: &[bool],
        equality_rows: &[bool],
    ) -> Result<Self, &'static str> {
        let border = Border::new(stages, hessian, jacobian, fixed);
        let recursion =
            Recursion::new(stages, border.theta(), (hessian, jacobian), fixed, equality_rows)?;
        let kept = recursion.sizes.kept();
        Ok(Riccati {
            travel: Travel::new(recursion.sizes),
            last: vec![0.0; border.size()],
            border,
            recursion,
            ends: vec![0.0; kept * kept],
        })
    }
}

#[cfg(test)]
impl Riccati {
    /// As on a machine that cannot multiply and add in one instruction.
    pub(crate) fn without_fused(mut self) -> Self {
        self.recursion.fused = false;
        self
    }
}

impl Factor for Riccati {
    fn factor(&mut self, hessian: &[f64], jacobian: &[f64], sigma: &[f64], d: &[f64]) -> Inertia {
        self.border.assemble(hessian, jacobian, sigma, d, &mut self.ends);
        let matrix = Matrix { hessian, jacobian, sigma, d };
        let most = self.border.rows();
        let Some(negative) = self.recursion.factor(matrix, &mut self.ends, most) else {
            return Inertia::Wrong;
        };
        match self.border.factor(&self.ends) {
            None => Inertia::Singular,
            Some(count) if count + negative == self.border.rows() => Inertia::Correct,
            Some(_) => Inertia::Wrong,
        }
    }

    fn solve(&mut self, right_side: &mut [f64]) {
        let Riccati { recursion, border, travel, last, .. } = self;
        let stages = recursion.stages;
        let (a, b) = right_side.split_at_mut(stages.variables());
        recursion.remove_local_constraints(a, b);
        border.terminal_gradient(a, b, &mut travel.gradient);
        recursion.backward(travel, a, b);
        border.solve(&travel.gradient, last, &mut travel.state);
        recursion.forward(travel, a, b);
        let (x, theta) = travel.state.split_at(stages.states);
        a[stages.state(stages.intervals)].copy_from_slice(x);
        border.finish(theta, a, b);
        recursion.local_multipliers(a, b);
    }
}
