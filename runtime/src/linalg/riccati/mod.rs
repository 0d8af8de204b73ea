//! Stage-wise factorisation of the optimality conditions: cost linear in the number of stages.
//!
//! The value function of the stages from `k` on is kept as a quadratic in `z = (x_k, theta)`, where the border
//! `theta = (g, nu, x0)` holds the globals, the multipliers of the coupling rows and, where the ends of the chain
//! are coupled by curvature, a copy of the initial state:
//!
//! ```text
//!     V_k(x, theta) = 1/2 [x; theta]' [ P       Lambda ] [x; theta]  +  [v_x; v_theta]' [x; theta]
//!                                     [ Lambda' Theta  ]
//! ```
//!
//! Going backward, [`interval`] puts the Hessian over `(x_k, u_k, theta, x_{k+1})` together with `V_{k+1}`, removes
//! `x_{k+1}` by the linearised defects and then `u_k` by its own block. What is left at `k = 0` is one small dense
//! symmetric system in `(x_0, theta)`: [`border`]. Signs of all pivots give the inertia exactly (Haynsworth), so a
//! control block may be indefinite as long as the whole is right.

mod assemble;
mod border;
mod interval;
mod kernels;
mod solve;

use super::{Factor, Inertia, Stages, Triplets};
use assemble::Assembly;
use border::Border;
use interval::{Interval, Sizes};

/// The recursion, with all its memory.
pub struct Riccati {
    stages: Stages,
    assembly: Assembly,
    intervals: Vec<Interval>,
    border: Border,
    /// `[P Lambda; Lambda' Theta]` of the stage being left.
    value: Vec<f64>,
    /// `[v_x; v_theta]` of the stage being left.
    gradient: Vec<f64>,
    theta: Vec<f64>,
    x: Vec<f64>,
    scratch: Vec<f64>,
}

impl Riccati {
    /// Prepares the recursion, or says why the structure does not allow it: a state that is fixed inside the
    /// chain, an equality at every stage, or entries that couple distant stages. `equality_rows[i]` says that
    /// row `i` has no slack.
    pub fn new(
        stages: Stages,
        hessian: &Triplets,
        jacobian: &Triplets,
        fixed: &[bool],
        equality_rows: &[bool],
    ) -> Result<Self, &'static str> {
        if (1..=stages.intervals).any(|k| stages.state(k).any(|i| fixed[i])) {
            return Err("a state is fixed inside the chain");
        }
        if (0..stages.intervals).any(|k| stages.local(k).any(|i| equality_rows[i])) {
            return Err("an equality holds at every stage");
        }
        let border = Border::new(stages, hessian, jacobian, fixed);
        let sizes = Sizes { n: stages.states, m: stages.controls, q: border.theta() };
        let assembly =
            Assembly::new(stages, sizes, hessian, jacobian).ok_or("entries couple distant stages")?;
        let interval =
            |k| Interval::new(sizes, stages.local_rows, stages.control(k).map(|i| fixed[i]).collect());
        let intervals = (0..stages.intervals).map(interval).collect();
        let kept = sizes.kept();
        let (value, gradient, theta) = (vec![0.0; kept * kept], vec![0.0; kept], vec![0.0; sizes.q]);
        let (x, scratch) = (vec![0.0; sizes.n], vec![0.0; sizes.all()]);
        Ok(Riccati { stages, assembly, intervals, border, value, gradient, theta, x, scratch })
    }
}

impl Factor for Riccati {
    fn factor(&mut self, hessian: &[f64], jacobian: &[f64], sigma: &[f64], d: &[f64]) -> Inertia {
        self.border.assemble(hessian, jacobian, sigma, d, &mut self.value);
        let mut negative = 0;
        for (k, interval) in self.intervals.iter_mut().enumerate().rev() {
            let block = self.assembly.gather(k, hessian, jacobian);
            interval.add_diagonals(block, &self.stages, k, sigma, d);
            match interval.factor(block, &mut self.value) {
                Some(count) => negative += count,
                None => return Inertia::Wrong,
            }
            // The border cannot have fewer than no negative eigenvalues.
            if negative > self.border.rows() {
                return Inertia::Wrong;
            }
        }
        match self.border.factor(&self.value) {
            None => Inertia::Singular,
            Some(count) if count + negative == self.border.rows() => Inertia::Correct,
            Some(_) => Inertia::Wrong,
        }
    }

    fn solve(&mut self, right_side: &mut [f64]) {
        let (a, b) = right_side.split_at_mut(self.stages.variables());
        self.border.terminal_gradient(a, b, &mut self.gradient);
        for (k, interval) in self.intervals.iter_mut().enumerate().rev() {
            interval.backward(&self.stages, k, (a, b), &mut self.gradient, &mut self.scratch);
        }
        self.border.solve(&self.gradient, &mut self.x, &mut self.theta);
        for (k, interval) in self.intervals.iter_mut().enumerate() {
            interval.forward(&self.stages, k, (a, b), (&mut self.x, &self.theta), &mut self.scratch);
        }
        a[self.stages.state(self.stages.intervals)].copy_from_slice(&self.x);
        self.border.finish(&self.theta, a, b);
    }
}
