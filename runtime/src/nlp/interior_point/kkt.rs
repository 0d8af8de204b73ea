//! The Newton step on the optimality conditions of the barrier problem.
//!
//! Bounds contribute `Sigma = z / distance`; an attached variable `j` of row `i` is eliminated and
//! leaves `1 / Sigma_j` on the diagonal of its row. What is factored is (see [`crate::linalg`])
//!
//! ```text
//!     [ H + Sigma + delta_w    J'               ] [ dv ]     [ r_v                           ]
//!     [ J                     -1/Sigma - delta_c ] [ dl ] = - [ residual - sign r_j / Sigma_j ]
//! ```
//!
//! Inertia is corrected as in Waechter & Biegler 2006, algorithm IC.

use super::barrier::Barrier;
use super::formulation::Space;
use super::iterate::{Iterate, Slopes, Step};
use super::vectors::{are_finite, dot, largest};
use crate::linalg::riccati::Riccati;
use crate::linalg::sparse_ldl::SparseLdl;
use crate::linalg::{Factor, Inertia, Products};
use crate::nlp::{Counts, Derivatives, Nlp};
use crate::problem::Linear;

const FIRST_REGULARIZATION: f64 = 1e-4;
const SMALLEST_REGULARIZATION: f64 = 1e-20;
const LARGEST_REGULARIZATION: f64 = 1e40;
const FIRST_GROWTH: f64 = 100.0;
const GROWTH: f64 = 8.0;
const DECAY: f64 = 1.0 / 3.0;
/// A line search that keeps less than the first fraction of a step raises the caution, one that
/// keeps more than the second lowers it.
const CUT_SHORT: f64 = 0.1;
const NOT_CUT: f64 = 0.5;
const CAUTION_GROWTH: f64 = 4.0;
const MOST_CAUTION: f64 = 1.0;
const ROW_REGULARIZATION: f64 = 1e-8;
/// The same where rows depend on each other by their multipliers, although the inertia is right.
const DEPENDENT_ROWS: f64 = 1e-6;
/// Refinement stops at this residual, relative to the right side.
const REFINED: f64 = 1e-11;
const MOST_REFINEMENTS: usize = 8;

/// What the optimality conditions are linearised around.
#[derive(Clone, Copy)]
pub(super) struct System<'a> {
    pub(super) space: &'a Space,
    pub(super) at: &'a Iterate,
    pub(super) slopes: &'a Slopes,
    pub(super) mu: f64,
}

/// The matrix, its factors and its memory.
pub(super) struct Kkt {
    factor: Box<dyn Factor>,
    products: Products,
    /// Whether the factorisation is the recursion, which has no pivoting.
    is_recursion: bool,
    /// `z / distance` over `y`.
    sigma: Vec<f64>,
    /// Diagonals of the factored matrix.
    diagonal: Vec<f64>,
    d: Vec<f64>,
    /// Gradient over `y` of the barrier function but for the objective, and of the barrier
    /// Lagrangian.
    push: Vec<f64>,
    gradient: Vec<f64>,
    /// `1 / distance` of each finite bound.
    inverses: Vec<f64>,
    right: Vec<f64>,
    residual: Vec<f64>,
    solution: Vec<f64>,
    /// Regularisation of this factorisation, and the last that was needed.
    pub(super) regularization: f64,
    last_regularization: f64,
    /// Whether the last factorisation had to raise its first guess of the regularisation.
    was_needed: bool,
    /// Regularisation that is used even where the inertia does not ask for it.
    pub(super) caution: f64,
}

impl Kkt {
    /// Prepares the factorisation the caller asks for; the recursion wherever the structure allows
    /// it.
    pub(super) fn new(nlp: &dyn Nlp, space: &Space, linear: Linear) -> Self {
        // Elastic rows are no longer exact equalities, and need no special care in the recursion.
        let elastic = space.attached.len() > space.slacks;
        let equality: Vec<bool> =
            space.equality.iter().map(|equality| *equality && !elastic).collect();
        let (hessian, jacobian) = (nlp.hessian_structure(), nlp.jacobian_structure());
        let recursion = match (linear, nlp.stages()) {
            (Linear::SparseLdl, _) | (_, None) => None,
            // What belongs to the only interval cannot be told from what belongs to the ends.
            (_, Some(stages)) if stages.intervals == 1 => None,
            (_, Some(stages)) => {
                Riccati::new(stages, hessian, jacobian, &space.fixed, &equality).ok()
            }
        };
        let rows = space.target.len();
        let is_recursion = recursion.is_some();
        let factor: Box<dyn Factor> = match recursion {
            Some(recursion) => Box::new(recursion),
            None => Box::new(SparseLdl::new(hessian, jacobian, &space.fixed, rows)),
        };
        let zeros = |length: usize| vec![0.0; length];
        let size = space.variables + rows;
        Kkt {
            products: Products::new(nlp.stages(), hessian, jacobian),
            factor,
            is_recursion,
            sigma: zeros(space.len()),
            diagonal: zeros(space.variables),
            d: zeros(rows),
            push: zeros(space.len()),
            gradient: zeros(space.len()),
            inverses: zeros(space.bounds()),
            right: zeros(size),
            residual: zeros(size),
            solution: zeros(size),
            regularization: 0.0,
            last_regularization: 0.0,
            was_needed: false,
            caution: 0.0,
        }
    }

    /// Goes over from the recursion to the sparse factorisation, which loses fewer digits where a
    /// state has almost no room; `false` if it is there already.
    pub(super) fn fall_back(&mut self, nlp: &dyn Nlp, space: &Space) -> bool {
        let was_recursion = std::mem::take(&mut self.is_recursion);
        if was_recursion {
            let (hessian, jacobian) = (nlp.hessian_structure(), nlp.jacobian_structure());
            self.factor =
                Box::new(SparseLdl::new(hessian, jacobian, &space.fixed, space.target.len()));
        }
        was_recursion
    }

    /// Computes the diagonals that belong to the iterate.
    pub(super) fn assemble(
        &mut self,
        space: &Space,
        at: &Iterate,
        slopes: &Slopes,
        barrier: &Barrier,
    ) {
        let Kkt { sigma, push, gradient, inverses, .. } = self;
        sigma.fill(0.0);
        push.fill(0.0);
        let mut inverses = inverses.iter_mut();
        space.for_each_bound(&at.y, |i, distance, direction| {
            let inverse = 1.0 / distance;
            *inverses.next().expect("there is one for each bound") = inverse;
            sigma[i] += inverse * if direction > 0.0 { at.lower[i] } else { at.upper[i] };
            push[i] -= direction * barrier.mu * inverse;
        });
        barrier.add_damping(space, push);
        for ((sum, push), slope) in gradient.iter_mut().zip(&*push).zip(&slopes.lagrangian) {
            *sum = push + slope;
        }
    }

    /// Gradient over `y` of the barrier function but for the objective, at the iterate that was
    /// assembled last.
    pub(super) fn push(&self) -> &[f64] {
        &self.push
    }

    /// Factors with the smallest regularisation that gives the right inertia; `false` if none does.
    /// Rows that depend on each other are regularised from the beginning.
    pub(super) fn factor_with_inertia(
        &mut self,
        space: &Space,
        slopes: &Slopes,
        mu: f64,
        are_dependent: bool,
        counts: &mut Counts,
    ) -> bool {
        // Curvature that was wrong a moment ago is likely to be wrong again: zero is tried only
        // every other time.
        let start = if self.was_needed { self.smaller_regularization() } else { 0.0 };
        self.regularization = start.max(self.caution);
        let (first, mut rows) =
            (self.regularization, if are_dependent { DEPENDENT_ROWS } else { 0.0 });
        loop {
            match self.factor_once(space, slopes, rows, counts) {
                Inertia::Correct => break,
                Inertia::Singular if rows == 0.0 => rows = ROW_REGULARIZATION * mu.powf(0.25),
                Inertia::Wrong | Inertia::Singular => {
                    self.regularization = self.next_regularization()
                }
            }
            if self.regularization > LARGEST_REGULARIZATION {
                return false;
            }
        }
        self.was_needed = self.regularization > first;
        if self.regularization > 0.0 {
            self.last_regularization = self.regularization;
        }
        true
    }

    /// Factors with a regularisation of at least `least` that gives the right inertia, to a factor
    /// of [`GROWTH`]; `true` if that is `least` itself, or none does.
    pub(super) fn factor_barely(
        &mut self,
        space: &Space,
        slopes: &Slopes,
        mu: f64,
        least: f64,
        counts: &mut Counts,
    ) -> bool {
        self.regularization = least;
        let mut rows = 0.0;
        loop {
            match self.factor_once(space, slopes, rows, counts) {
                Inertia::Correct => return self.regularization == least,
                Inertia::Singular if rows == 0.0 => rows = ROW_REGULARIZATION * mu.powf(0.25),
                Inertia::Wrong | Inertia::Singular => self.regularization *= GROWTH,
            }
            if self.regularization.is_nan() || self.regularization > LARGEST_REGULARIZATION {
                return true;
            }
        }
    }

    /// The slope of the barrier Lagrangian along a step, at the iterate that was assembled last.
    pub(super) fn slope(&self, step: &Step) -> f64 {
        dot(&self.gradient, &step.y)
    }

    /// Whether the last factorisation was that of Newton's own matrix.
    pub(super) fn is_newton(&self) -> bool {
        self.regularization == 0.0
    }

    /// One step of inverse iteration from the variables of `step`, with the matrix that was
    /// factored last: the next unit vector over `y`, and the curvature of the barrier
    /// Lagrangian along it. `None` where there is no number.
    pub(super) fn inverse_iteration(
        &mut self,
        space: &Space,
        slopes: &Slopes,
        step: &mut Step,
    ) -> Option<f64> {
        let variables = space.variables;
        self.right.fill(0.0);
        let free = (0..variables).filter(|i| !space.fixed[*i]);
        free.for_each(|i| self.right[i] = step.y[i]);
        self.solve_refined(space, slopes);
        let (dv, dl) = self.solution.split_at(variables);
        let product = dot(dv, &self.right[..variables]);
        step.y[..variables].copy_from_slice(dv);
        for (j, attached) in space.attached.iter().enumerate() {
            let i = variables + j;
            step.y[i] = -attached.sign * dl[attached.row] / (self.sigma[i] + self.regularization);
        }
        let length = dot(&step.y, &step.y).sqrt();
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        step.y.iter_mut().for_each(|d| *d /= length);
        Some(product / (length * length) - self.regularization)
    }

    /// Learns from a line search: steps that are cut again and again often come from a nearly
    /// singular Hessian, and are made shorter by regularising it although its inertia is right.
    /// Where that does not help it is given up.
    pub(super) fn judge(&mut self, fraction: f64) {
        if fraction < CUT_SHORT {
            let raised = (CAUTION_GROWTH * self.caution).max(FIRST_REGULARIZATION);
            self.caution = if raised > MOST_CAUTION { 0.0 } else { raised };
        } else if fraction > NOT_CUT {
            self.caution = if self.caution < FIRST_REGULARIZATION {
                0.0
            } else {
                self.caution / CAUTION_GROWTH
            };
        }
    }

    fn smaller_regularization(&self) -> f64 {
        (DECAY * self.last_regularization).max(SMALLEST_REGULARIZATION)
    }

    fn next_regularization(&self) -> f64 {
        match (self.regularization, self.last_regularization) {
            (0.0, 0.0) => FIRST_REGULARIZATION,
            (0.0, _) => self.smaller_regularization(),
            (now, 0.0) => FIRST_GROWTH * now,
            (now, _) => GROWTH * now,
        }
    }

    fn factor_once(
        &mut self,
        space: &Space,
        slopes: &Slopes,
        rows: f64,
        counts: &mut Counts,
    ) -> Inertia {
        counts.factorizations += 1;
        counts.regularizations += usize::from(self.regularization > 0.0);
        for (target, sigma) in self.diagonal.iter_mut().zip(&self.sigma) {
            *target = sigma + self.regularization;
        }
        self.d.fill(rows);
        for (attached, sigma) in space.attached.iter().zip(&self.sigma[space.variables..]) {
            self.d[attached.row] += 1.0 / (sigma + self.regularization);
        }
        let derivatives = &slopes.derivatives;
        self.factor.factor(&derivatives.hessian, &derivatives.jacobian, &self.diagonal, &self.d)
    }

    /// The Newton step that removes `residuals`; `false` if the linear system could not be solved
    /// accurately.
    pub(super) fn step(&mut self, system: &System, residuals: &[f64], step: &mut Step) -> bool {
        let System { space, at, slopes, mu } = *system;
        self.fill_right_side(space, residuals);
        if !self.solve_refined(space, slopes) {
            return false;
        }
        step.y[..space.variables].copy_from_slice(&self.solution[..space.variables]);
        step.lambda.copy_from_slice(&self.solution[space.variables..]);
        for (j, attached) in space.attached.iter().enumerate() {
            let i = space.variables + j;
            let pull = self.gradient[i] + attached.sign * step.lambda[attached.row];
            step.y[i] = -pull / (self.sigma[i] + self.regularization);
        }
        let Step { y, lower, upper, .. } = step;
        let mut inverses = self.inverses.iter();
        space.for_each_bound(&at.y, |i, _, direction| {
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

    fn fill_right_side(&mut self, space: &Space, residuals: &[f64]) {
        let (a, b) = self.right.split_at_mut(space.variables);
        for i in 0..space.variables {
            a[i] = if space.fixed[i] { 0.0 } else { -self.gradient[i] };
        }
        for (target, residual) in b.iter_mut().zip(residuals) {
            *target = -residual;
        }
        for (j, attached) in space.attached.iter().enumerate() {
            let i = space.variables + j;
            b[attached.row] +=
                attached.sign * self.gradient[i] / (self.sigma[i] + self.regularization);
        }
    }

    /// Iterative refinement against the matrix itself.
    fn solve_refined(&mut self, space: &Space, slopes: &Slopes) -> bool {
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
            self.compute_residual(space, slopes);
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
        size.is_finite() && now <= 1e-5 * size
    }

    fn compute_residual(&mut self, space: &Space, slopes: &Slopes) {
        let variables = space.variables;
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
        for i in (0..variables).filter(|i| space.fixed[*i]) {
            self.residual[i] = 0.0;
        }
    }

    /// Least-squares multipliers: those that make the gradient of the Lagrangian smallest. Zeros
    /// where they would be huge.
    pub(super) fn estimate_multipliers(
        &mut self,
        space: &Space,
        at: &mut Iterate,
        slopes: &Slopes,
    ) {
        const HUGE: f64 = 1e3;
        let zeros = vec![0.0; slopes.derivatives.hessian.len()];
        self.sigma.fill(1.0);
        self.diagonal.fill(1.0);
        self.d.fill(0.0);
        for attached in &space.attached {
            self.d[attached.row] += 1.0;
        }
        at.lambda.fill(0.0);
        self.gradient[..space.variables].copy_from_slice(&slopes.derivatives.gradient);
        for (target, attached) in self.gradient[space.variables..].iter_mut().zip(&space.attached) {
            *target = attached.cost;
        }
        for i in 0..space.len() {
            self.gradient[i] += at.upper[i] - at.lower[i];
        }
        self.regularization = 0.0;
        let residuals = vec![0.0; at.lambda.len()];
        self.fill_right_side(space, &residuals);
        let inertia =
            self.factor.factor(&zeros, &slopes.derivatives.jacobian, &self.diagonal, &self.d);
        if inertia != Inertia::Correct {
            return;
        }
        self.factor.solve(&mut self.right);
        let estimate = &self.right[space.variables..];
        if largest(estimate) <= HUGE {
            at.lambda.copy_from_slice(estimate);
        }
    }
}
