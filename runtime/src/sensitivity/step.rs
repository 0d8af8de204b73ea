//! One step of the explicit pair as a linear map, `S+ = Phi S + Gamma W`, and its transpose.
//!
//! The derivative of the stages that were computed, not of the solution (H. G. Bock's internal differentiation), so
//! forward and adjoint differ by rounding only. With `A_i = f*_x` and `G_i = f*_(u,p)` at stage `i`
//!
//! ```text
//! K_i = A_i (S + h sum_j a_ij K_j) + G_i W,            S+ = S + h sum_i b_i K_i
//! kappa_i = h (b_i lambda+ + sum_j a_ji A_j^T kappa_j),  lambda = lambda+ + sum_i A_i^T kappa_i,  dJ/dw += G_i^T kappa_i
//! ```

use super::linearization::{Linearization, Linearizer};
use crate::simulate::tableau::{A, C, STAGES};
use crate::simulate::{Instant, Regime};
use nalgebra::{DMatrix, DVector};

/// Stages whose values enter the end of the step, whose weights are the last row of the tableau.
pub(super) const USED: usize = STAGES - 1;

/// Weights of the end of the step.
pub(super) const WEIGHTS: [f64; USED] = A[STAGES - 1];

/// A step, linearised.
pub(super) struct LinearStep {
    pub h: f64,
    pub stages: Vec<Linearization>,
    /// Where the stages are.
    pub points: Vec<(f64, DVector<f64>)>,
}

impl LinearStep {
    /// Takes the step again.
    pub fn new(linearizer: &Linearizer, regime: &Regime, start: &Instant, h: f64) -> Self {
        let mut step = LinearStep { h, stages: Vec::with_capacity(USED), points: Vec::with_capacity(USED) };
        let x = DVector::from_column_slice(&start.state);
        for stage in 0..USED {
            let mut at = x.clone();
            for (weight, before) in A[stage].iter().zip(&step.stages) {
                at.axpy(h * weight, &before.rate, 1.0);
            }
            let near = step.stages.last().map_or(&start.selectors, |last| &last.selectors);
            let time = start.time + C[stage] * h;
            let point = linearizer.at(regime, near, time, &at);
            step.stages.push(point);
            step.points.push((time, at));
        }
        step
    }

    /// The derivatives of the stages, then that of the end.
    pub fn forward(&self, s: &DMatrix<f64>, w: &DMatrix<f64>) -> (Vec<DMatrix<f64>>, DMatrix<f64>) {
        let mut slopes: Vec<DMatrix<f64>> = Vec::with_capacity(USED);
        let mut at_stages = Vec::with_capacity(USED);
        for (stage, point) in self.stages.iter().enumerate() {
            let at = self.combined(s, &slopes, &A[stage]);
            slopes.push(point.by_state() * &at + point.by_inputs() * w);
            at_stages.push(at);
        }
        let end = self.combined(s, &slopes, &WEIGHTS);
        (at_stages, end)
    }

    /// `S + h sum_j a_j K_j`.
    pub fn combined(&self, s: &DMatrix<f64>, slopes: &[DMatrix<f64>], weights: &[f64]) -> DMatrix<f64> {
        let mut sum = s.clone();
        for (weight, slope) in weights.iter().zip(slopes).filter(|(weight, _)| **weight != 0.0) {
            sum.zip_apply(slope, |sum, slope| *sum += self.h * weight * slope);
        }
        sum
    }

    /// The adjoint before the step and the derivative by `(u, p)`.
    pub fn adjoint(&self, after: &DVector<f64>) -> (DVector<f64>, DVector<f64>) {
        let mut pulled: Vec<DVector<f64>> = vec![DVector::zeros(0); USED];
        let mut before = after.clone();
        let mut inputs = DVector::zeros(self.stages[0].by_inputs().ncols());
        for stage in (0..USED).rev() {
            let mut kappa = after * (self.h * WEIGHTS[stage]);
            for later in stage + 1..USED {
                kappa.axpy(self.h * A[later][stage], &pulled[later], 1.0);
            }
            pulled[stage] = self.stages[stage].by_state().tr_mul(&kappa);
            before += &pulled[stage];
            inputs += self.stages[stage].by_inputs().tr_mul(&kappa);
        }
        (before, inputs)
    }
}
