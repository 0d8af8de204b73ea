//! The Newton step on the optimality conditions of the barrier problem.
//!
//! Bounds contribute `Sigma = z / distance`; a slack `j` of row `i` is eliminated and
//! leaves `1 / Sigma_j` on the diagonal of its row. What is factored is (see [`crate::linalg`])
//!
//! ```text
//!     [ H + Sigma + delta_w    J'               ] [ dv ]     [ r_v                           ]
//!     [ J                     -1/Sigma - delta_c ] [ dl ] = - [ residual - sign r_j / Sigma_j ]
//! ```
//!
//! Its inertia is corrected in [`inertia`](super::inertia).

use super::barrier::Barrier;
use super::formulation::Formulation;
use super::iterate::{Iterate, SearchDirection, Slopes};
use super::tuning::kkt::{HUGE, INACCURATE, MOST_REFINEMENTS, REFINED};
use super::vectors::{are_finite, dot, largest};
use crate::linalg::solvers::{Structure, more_robust, prepare};
use crate::linalg::{Factor, Inertia, Products};
use crate::nlp::{Derivatives, Nlp};
use crate::problem::Linear;

/// What the optimality conditions are linearised around.
#[derive(Clone, Copy)]
pub(super) struct System<'a> {
    pub(super) formulation: &'a Formulation,
    pub(super) at: &'a Iterate,
    pub(super) slopes: &'a Slopes,
    pub(super) mu: f64,
}

/// The matrix, its factors and its memory.
pub(super) struct Kkt {
    pub(super) factor: Box<dyn Factor>,
    products: Products,
    /// Which factorisation it is.
    linear: Linear,
    /// `z / distance` over `y`.
    pub(super) sigma: Vec<f64>,
    /// Diagonals of the factored matrix.
    pub(super) diagonal: Vec<f64>,
    pub(super) d: Vec<f64>,
    /// Gradient over `y` of the barrier function but for the objective, and of the barrier
    /// Lagrangian.
    barrier_gradient: Vec<f64>,
    gradient: Vec<f64>,
    /// `1 / distance` of each finite bound.
    inverses: Vec<f64>,
    right: Vec<f64>,
    residual: Vec<f64>,
    solution: Vec<f64>,
    /// Regularisation of this factorisation, and the last that was needed.
    pub(super) regularization: f64,
    pub(super) last_regularization: f64,
    /// Whether the last factorisation had to raise its first guess of the regularisation.
    pub(super) was_needed: bool,
    /// Regularisation that is used even where the inertia does not ask for it.
    pub(super) caution: f64,
}

impl Kkt {
    /// Prepares the factorisation that the caller asks for, or the next one that the structure
    /// allows.
    pub(super) fn new(nlp: &dyn Nlp, formulation: &Formulation, linear: Linear) -> Self {
        let rows = formulation.target.len();
        let (linear, factor) = prepare(linear, &structure(nlp, &exact(formulation), formulation));
        let zeros = |length: usize| vec![0.0; length];
        let size = formulation.variables + rows;
        Kkt {
            products: Products::new(
                nlp.stages(),
                nlp.hessian_structure(),
                nlp.jacobian_structure(),
            ),
            factor,
            linear,
            sigma: zeros(formulation.len()),
            diagonal: zeros(formulation.variables),
            d: zeros(rows),
            barrier_gradient: zeros(formulation.len()),
            gradient: zeros(formulation.len()),
            inverses: zeros(formulation.bounds()),
            right: zeros(size),
            residual: zeros(size),
            solution: zeros(size),
            regularization: 0.0,
            last_regularization: 0.0,
            was_needed: false,
            caution: 0.0,
        }
    }

    /// Goes over to a more robust factorisation, such as one with pivoting, which loses fewer
    /// digits where a state has almost no room; `false` if there is none.
    pub(super) fn fall_back(&mut self, nlp: &dyn Nlp, formulation: &Formulation) -> bool {
        let Some(next) = more_robust(self.linear) else { return false };
        let exact = exact(formulation);
        (self.linear, self.factor) = prepare(next, &structure(nlp, &exact, formulation));
        true
    }

    /// Computes the diagonals that belong to the iterate.
    pub(super) fn assemble(
        &mut self,
        formulation: &Formulation,
        at: &Iterate,
        slopes: &Slopes,
        barrier: &Barrier,
    ) {
        let Kkt { sigma, barrier_gradient, gradient, inverses, .. } = self;
        sigma.fill(0.0);
        barrier_gradient.fill(0.0);
        let mut inverses = inverses.iter_mut();
        formulation.for_each_bound(&at.y, |i, distance, direction| {
            let inverse = 1.0 / distance;
            *inverses.next().expect("there is one for each bound") = inverse;
            sigma[i] += inverse * if direction > 0.0 { at.lower[i] } else { at.upper[i] };
            barrier_gradient[i] -= direction * barrier.mu * inverse;
        });
        barrier.add_damping(formulation, barrier_gradient);
        for ((sum, barrier_gradient), slope) in
            gradient.iter_mut().zip(&*barrier_gradient).zip(&slopes.lagrangian)
        {
            *sum = barrier_gradient + slope;
        }
    }

    /// Takes the barrier out of the matrix of variables (one entry each) but of those that are near
    /// a bound.
    pub(super) fn forget_barrier(&mut self, is_near: &[bool]) {
        let sigma = self.sigma.iter_mut().zip(is_near).filter(|it| !it.1);
        sigma.for_each(|(sigma, _)| *sigma = 0.0);
    }

    /// Gradient over `y` of the barrier function but for the objective, at the iterate that was
    /// assembled last.
    pub(super) fn barrier_gradient(&self) -> &[f64] {
        &self.barrier_gradient
    }

    /// The slope of the barrier Lagrangian along a step, at the iterate that was assembled last.
    pub(super) fn slope(&self, step: &SearchDirection) -> f64 {
        dot(&self.gradient, &step.y)
    }

    /// One step of inverse iteration from the variables of `step`, with the matrix that was
    /// factored last: the next unit vector over `y`, and the curvature of the barrier
    /// Lagrangian along it. `None` where there is no number.
    pub(super) fn inverse_iteration(
        &mut self,
        formulation: &Formulation,
        slopes: &Slopes,
        step: &mut SearchDirection,
    ) -> Option<f64> {
        if !self.is_factored() {
            return None;
        }
        let variables = formulation.variables;
        self.right.fill(0.0);
        let free = (0..variables).filter(|i| !formulation.fixed[*i]);
        free.for_each(|i| self.right[i] = step.y[i]);
        self.solve_refined(formulation, slopes);
        let (dv, dl) = self.solution.split_at(variables);
        let product = dot(dv, &self.right[..variables]);
        step.y[..variables].copy_from_slice(dv);
        for (j, slack) in formulation.slacks.iter().enumerate() {
            let i = variables + j;
            step.y[i] = -slack.sign * dl[slack.row] / (self.sigma[i] + self.regularization);
        }
        let length = dot(&step.y, &step.y).sqrt();
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        step.y.iter_mut().for_each(|d| *d /= length);
        Some(product / (length * length) - self.regularization)
    }

    /// The Newton step that removes `residuals`; `false` if the linear system could not be solved
    /// accurately.
    pub(super) fn step(
        &mut self,
        system: &System,
        residuals: &[f64],
        step: &mut SearchDirection,
    ) -> bool {
        let System { formulation, at, slopes, mu } = *system;
        self.fill_right_side(formulation, residuals);
        if !self.solve_refined(formulation, slopes) {
            return false;
        }
        step.y[..formulation.variables].copy_from_slice(&self.solution[..formulation.variables]);
        step.lambda.copy_from_slice(&self.solution[formulation.variables..]);
        for (j, slack) in formulation.slacks.iter().enumerate() {
            let i = formulation.variables + j;
            let slack_gradient = self.gradient[i] + slack.sign * step.lambda[slack.row];
            step.y[i] = -slack_gradient / (self.sigma[i] + self.regularization);
        }
        let SearchDirection { y, lower, upper, .. } = step;
        let mut inverses = self.inverses.iter();
        formulation.for_each_bound(&at.y, |i, _, direction| {
            let (z, dz) = if direction > 0.0 {
                (at.lower[i], &mut lower[i])
            } else {
                (at.upper[i], &mut upper[i])
            };
            let inverse = inverses.next().expect("there is one for each bound");
            *dz = (mu - direction * z * y[i]) * inverse - z;
        });
        [&*y, lower, upper].into_iter().all(|values| are_finite(values))
    }

    fn fill_right_side(&mut self, formulation: &Formulation, residuals: &[f64]) {
        let (a, b) = self.right.split_at_mut(formulation.variables);
        for i in 0..formulation.variables {
            a[i] = if formulation.fixed[i] { 0.0 } else { -self.gradient[i] };
        }
        for (target, residual) in b.iter_mut().zip(residuals) {
            *target = -residual;
        }
        for (j, slack) in formulation.slacks.iter().enumerate() {
            let i = formulation.variables + j;
            b[slack.row] += slack.sign * self.gradient[i] / (self.sigma[i] + self.regularization);
        }
    }

    /// Iterative refinement against the matrix itself.
    fn solve_refined(&mut self, formulation: &Formulation, slopes: &Slopes) -> bool {
        self.solution.fill(0.0);
        self.residual.copy_from_slice(&self.right);
        let right = largest(&self.right);
        let (mut before, mut now) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..MOST_REFINEMENTS {
            self.factor.solve(&mut self.residual);
            self.solution
                .iter_mut()
                .zip(&self.residual)
                .for_each(|(x, correction)| *x += correction);
            self.compute_residual(formulation, slopes);
            now = largest(&self.residual);
            if now <= REFINED * right && right.is_finite() {
                return true;
            }
            if now.is_nan() || now > 0.5 * before {
                break;
            }
            before = now;
        }
        let size = right.max(largest(&self.solution));
        size.is_finite() && now <= INACCURATE * size
    }

    fn compute_residual(&mut self, formulation: &Formulation, slopes: &Slopes) {
        let variables = formulation.variables;
        let (dv, dl) = self.solution.split_at(variables);
        let (a, b) = self.residual.split_at_mut(variables);
        for i in 0..variables {
            a[i] = self.diagonal[i] * dv[i];
        }
        for (i, target) in b.iter_mut().enumerate() {
            *target = -self.d[i] * dl[i];
        }
        let Derivatives { hessian, jacobian, .. } = &slopes.derivatives;
        self.products.multiply_add((hessian, jacobian), (dv, dl), (a, b));
        for (residual, right) in self.residual.iter_mut().zip(&self.right) {
            *residual = right - *residual;
        }
        for i in (0..variables).filter(|i| formulation.fixed[*i]) {
            self.residual[i] = 0.0;
        }
    }

    /// Least-squares multipliers: those that make the gradient of the Lagrangian smallest. Zeros
    /// where they would be huge.
    pub(super) fn estimate_multipliers(
        &mut self,
        formulation: &Formulation,
        at: &mut Iterate,
        slopes: &Slopes,
    ) {
        let zeros = vec![0.0; slopes.derivatives.hessian.len()];
        self.sigma.fill(1.0);
        self.diagonal.fill(1.0);
        self.d.fill(0.0);
        for slack in &formulation.slacks {
            self.d[slack.row] += 1.0;
        }
        at.lambda.fill(0.0);
        self.gradient[..formulation.variables].copy_from_slice(&slopes.derivatives.gradient);
        for (target, slack) in
            self.gradient[formulation.variables..].iter_mut().zip(&formulation.slacks)
        {
            *target = slack.cost;
        }
        for i in 0..formulation.len() {
            self.gradient[i] += at.upper[i] - at.lower[i];
        }
        self.regularization = 0.0;
        let residuals = vec![0.0; at.lambda.len()];
        self.fill_right_side(formulation, &residuals);
        let inertia =
            self.factor.factor(&zeros, &slopes.derivatives.jacobian, &self.diagonal, &self.d);
        if inertia != Inertia::Correct {
            return;
        }
        self.factor.solve(&mut self.right);
        let estimate = &self.right[formulation.variables..];
        if largest(estimate) <= HUGE {
            at.lambda.copy_from_slice(estimate);
        }
    }
}

/// Which rows are exact equalities: elastic ones are none, and need no special care.
fn exact(formulation: &Formulation) -> Vec<bool> {
    let is_elastic = formulation.slacks.len() > formulation.inequalities;
    formulation.equality.iter().map(|equality| *equality && !is_elastic).collect()
}

fn structure<'a>(
    nlp: &'a dyn Nlp,
    equality: &'a [bool],
    formulation: &'a Formulation,
) -> Structure<'a> {
    Structure {
        stages: nlp.stages(),
        phases: nlp.phases(),
        hessian: nlp.hessian_structure(),
        jacobian: nlp.jacobian_structure(),
        fixed: &formulation.fixed,
        equality,
    }
}
