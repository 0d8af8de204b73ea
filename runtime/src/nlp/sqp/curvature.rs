//! A convex `B` that gives the subproblem the solution that the Hessian `H` of the Lagrangian
//! would.
//!
//! Where conditions `A d + r = 0` are expected to hold at the solution,
//!
//! ```text
//!     1/2 d'H d    and    1/2 d'H d + rho/2 ||A d + r||^2
//! ```
//!
//! are the same at it, and `B = H + rho A'A` is positive definite for a large `rho` if `H` is so
//! where `A d = 0` (Debreu 1952). Where it is not, `delta` is added to the diagonal, which makes
//! the step shorter. Whether `B` is positive definite is known without forming it: it is exactly if
//! the inertia of
//!
//! ```text
//!     [ H + delta    A'     ]
//!     [ A           -1/rho  ]
//! ```
//!
//! is right, and that is what the sparse factorisation tells.

use super::working::Working;
use crate::linalg::sparse_ldl::SparseLdl;
use crate::linalg::{Factor, Inertia};
use crate::nlp::{Counts, Derivatives, Nlp};
use crate::problem::Bounds;

const SMALLEST_RHO: f64 = 1.0;
const LARGEST_RHO: f64 = 1e4;
const RHO_GROWTH: f64 = 10.0;
const FIRST_DELTA: f64 = 1e-8;
const LARGEST_DELTA: f64 = 1e20;
const DELTA_GROWTH: f64 = 8.0;
/// A row that is not expected to hold stands in the matrix with a weight of one over this.
const WEIGHTLESS: f64 = 1e20;

/// What is added to the Hessian: `delta` on the diagonal, `rho A'A`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Convexity {
    pub(super) delta: f64,
    pub(super) rho: f64,
}

/// The factorisation that judges, and what it asked for last.
pub(super) struct Curvature {
    factor: SparseLdl,
    last: Convexity,
    sigma: Vec<f64>,
    d: Vec<f64>,
}

impl Curvature {
    pub(super) fn new(nlp: &dyn Nlp) -> Self {
        let (variables, rows) = (nlp.variable_bounds().len(), nlp.row_bounds().len());
        let fixed: Vec<bool> = nlp.variable_bounds().iter().map(Bounds::is_equality).collect();
        let factor =
            SparseLdl::new(nlp.hessian_structure(), nlp.jacobian_structure(), &fixed, rows);
        Curvature {
            factor,
            last: Convexity::default(),
            sigma: vec![0.0; variables],
            d: vec![0.0; rows],
        }
    }

    /// `B` with this `delta`, if that will do.
    pub(super) fn with(
        &mut self,
        derivatives: &Derivatives,
        working: &Working,
        delta: f64,
        counts: &mut Counts,
    ) -> Option<Convexity> {
        self.is_convex(derivatives, working, Convexity { delta, rho: LARGEST_RHO }, counts)
            .then(|| self.smallest_rho(derivatives, working, delta, counts))
    }

    /// `B` with the smallest `delta` from `least` on that will do; `None` if none does.
    pub(super) fn regularized(
        &mut self,
        derivatives: &Derivatives,
        working: &Working,
        least: f64,
        counts: &mut Counts,
    ) -> Option<Convexity> {
        let mut delta = least;
        while delta <= LARGEST_DELTA {
            if let Some(convexity) = self.with(derivatives, working, delta, counts) {
                self.last.delta = delta;
                return Some(convexity);
            }
            delta = (DELTA_GROWTH * delta).max(FIRST_DELTA).max(self.last.delta / DELTA_GROWTH);
        }
        None
    }

    /// The smallest `rho` in steps, where the largest is large enough; a smaller one than the last
    /// is tried first.
    fn smallest_rho(
        &mut self,
        derivatives: &Derivatives,
        working: &Working,
        delta: f64,
        counts: &mut Counts,
    ) -> Convexity {
        let mut rho = (self.last.rho / RHO_GROWTH).max(SMALLEST_RHO);
        while !self.is_convex(derivatives, working, Convexity { delta, rho }, counts)
            && rho < LARGEST_RHO
        {
            rho *= RHO_GROWTH;
        }
        self.last.rho = rho;
        Convexity { delta, rho }
    }

    fn is_convex(
        &mut self,
        derivatives: &Derivatives,
        working: &Working,
        Convexity { delta, rho }: Convexity,
        counts: &mut Counts,
    ) -> bool {
        counts.factorizations += 1;
        counts.regularizations += usize::from(delta > 0.0);
        for (target, expected) in self.sigma.iter_mut().zip(&working.variables) {
            *target = delta + expected.map_or(0.0, |_| rho);
        }
        for (target, expected) in self.d.iter_mut().zip(&working.rows) {
            *target = expected.map_or(WEIGHTLESS, |_| 1.0 / rho);
        }
        let Derivatives { hessian, jacobian, .. } = derivatives;
        self.factor.factor(hessian, jacobian, &self.sigma, &self.d) == Inertia::Correct
    }

    /// The smallest step, measured by `B`, that removes the residuals of expected rows: a
    /// second-order correction.
    pub(super) fn correction(&mut self, residuals: &[f64]) -> Vec<f64> {
        let mut right = vec![0.0; self.sigma.len()];
        right.extend(residuals.iter().map(|residual| -residual));
        self.factor.solve(&mut right);
        right.truncate(self.sigma.len());
        right
    }
}
