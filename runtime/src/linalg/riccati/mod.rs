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
mod sizes;
mod solve;
mod value;

use super::dense::lanes::is_fused;
use super::structure::factor::{Factor, Inertia};
use super::structure::stages::Stages;
use super::structure::triplets::Triplets;
use assemble::Assembly;
use border::Border;
use chain::Matrix;
use condense::Condensed;
use factors::Factors;
use interval::Block;
use sizes::Sizes;
use solve::Travel;
use value::Value;

/// The recursion, with all its memory.
pub struct Riccati {
    stages: Stages,
    sizes: Sizes,
    /// Whether the machine multiplies and adds in one instruction.
    fused: bool,
    fixed: Vec<bool>,
    assembly: Assembly,
    border: Border,
    condensed: Condensed,
    block: Block,
    factors: Factors,
    /// The value function of the stage being left.
    value: Value,
    /// `[P Lambda; Lambda' Theta]` of the last stage, then of the first.
    ends: Vec<f64>,
    travel: Travel,
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
        if stages.states == 0 {
            return Err("there are no states");
        }
        if (1..=stages.intervals).any(|k| stages.state(k).any(|i| fixed[i])) {
            return Err("a state is fixed inside the chain");
        }
        if (0..stages.intervals).any(|k| stages.inner(k).any(|i| fixed[i])) {
            return Err("an inner variable is fixed");
        }
        if (0..stages.intervals).any(|k| stages.local(k).any(|i| equality_rows[i])) {
            return Err("an equality holds at every stage");
        }
        let border = Border::new(stages, hessian, jacobian, fixed);
        let sizes =
            Sizes { n: stages.states, m: stages.controls, inner: stages.inner, q: border.theta() };
        let assembly = Assembly::new(stages, sizes, hessian, jacobian)
            .ok_or("entries couple distant stages")?;
        let local_values = assembly.local_entries.len();
        Ok(Riccati {
            stages,
            sizes,
            fused: is_fused(),
            fixed: fixed.to_vec(),
            travel: Travel::new(sizes, border.size()),
            border,
            condensed: Condensed::new(sizes, stages, &assembly),
            block: Block::new(sizes),
            factors: Factors::new(sizes, stages.intervals, stages.local_constraints, local_values),
            assembly,
            value: Value::new(sizes),
            ends: vec![0.0; sizes.kept() * sizes.kept()],
        })
    }
}

#[cfg(test)]
impl Riccati {
    /// As on a machine that cannot multiply and add in one instruction.
    pub(crate) fn without_fused(self) -> Self {
        Riccati { fused: false, ..self }
    }
}

impl Factor for Riccati {
    fn factor(&mut self, hessian: &[f64], jacobian: &[f64], sigma: &[f64], d: &[f64]) -> Inertia {
        self.border.assemble(hessian, jacobian, sigma, d, &mut self.ends);
        let mut intervals = d.chunks(self.stages.row_step().max(1)).take(self.stages.intervals);
        let defects = self.stages.defect_rows();
        self.factors.penalised = intervals.any(|d| d[..defects].iter().sum::<f64>() > 0.0);
        self.value.set(self.sizes, &self.ends);
        let Some(negative) = self.factor_chain(Matrix { hessian, jacobian, sigma, d }) else {
            return Inertia::Wrong;
        };
        self.value.write(self.sizes, &mut self.ends);
        match self.border.factor(&self.ends) {
            None => Inertia::Singular,
            Some(count) if count + negative == self.border.rows() => Inertia::Correct,
            Some(_) => Inertia::Wrong,
        }
    }

    fn solve(&mut self, right_side: &mut [f64]) {
        let (a, b) = right_side.split_at_mut(self.stages.variables());
        let mut travel = std::mem::take(&mut self.travel);
        self.remove_local_constraints(a, b);
        self.border.terminal_gradient(a, b, &mut travel.gradient);
        self.solve_chain(&mut travel, a, b);
        let (x, theta) = travel.state.split_at(self.stages.states);
        a[self.stages.state(self.stages.intervals)].copy_from_slice(x);
        self.border.finish(theta, a, b);
        self.local_multipliers(a, b);
        self.travel = travel;
    }
}
