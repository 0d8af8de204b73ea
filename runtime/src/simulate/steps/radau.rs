//! The Radau IIA method of order 5, for stiff modes: stage values `x0 + z_i`, by simplified
//! Newton's method.
//!
//! ```text
//! z_i = h sum_j a_ij f(t + c_j h, x0 + z_j),   (I - h A x J) dz = h A F - z,   x(t + h) = x0 + z_3
//! (g/h I - J) err = f(t, x0) + (e_1 z_1 + e_2 z_2 + e_3 z_3)/h
//! ```
//!
//! E. Hairer, G. Wanner: Solving Ordinary Differential Equations II, 2nd ed., IV.5 (the method) and
//! IV.8 (all else).

use super::{Extension, Step};
use crate::linalg::dense::lu::Lu;
use crate::problem::RADAU;
use crate::simulate::field::Field;
use crate::simulate::field::tolerance::Tolerance;
use crate::simulate::tuning::radau::{
    FIRST_RATE, INHERITED, MOST_ITERATIONS, MOST_REST, NOT_SOLVED, ROUNDING,
};
use nalgebra::DMatrix;

/// Number of stages; the last is at the end of the step.
pub(crate) const STAGES: usize = 3;

const ROOT_6: f64 = 2.449_489_742_783_178;

/// When the stages are.
pub(crate) const C: &[f64] = RADAU[STAGES - 1];

/// Weights of the stages.
pub(crate) const A: [[f64; STAGES]; STAGES] = [
    [
        (88.0 - 7.0 * ROOT_6) / 360.0,
        (296.0 - 169.0 * ROOT_6) / 1800.0,
        (-2.0 + 3.0 * ROOT_6) / 225.0,
    ],
    [
        (296.0 + 169.0 * ROOT_6) / 1800.0,
        (88.0 + 7.0 * ROOT_6) / 360.0,
        (-2.0 - 3.0 * ROOT_6) / 225.0,
    ],
    [(16.0 - ROOT_6) / 36.0, (16.0 + ROOT_6) / 36.0, 1.0 / 9.0],
];

/// The real eigenvalue of the inverse of `A`, `30/(6 + 81^(1/3) - 9^(1/3))`.
const EIGENVALUE: f64 = 3.637_834_252_744_496;

/// Weights of the error.
const ERROR: [f64; STAGES] =
    [-(13.0 + 7.0 * ROOT_6) / 3.0, (-13.0 + 7.0 * ROOT_6) / 3.0, -1.0 / 3.0];

/// What a step of this method needs beside the step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Newton {
    /// `J = df/dx` at the start, selectors of sliding surfaces included.
    jacobian: DMatrix<f64>,
    /// The step before with its length, if this one continues it.
    pub before: Option<(Extension, f64)>,
    z: Vec<f64>,
    change: Vec<f64>,
    rates: Vec<f64>,
    at: Vec<f64>,
    matrix: Vec<f64>,
    lu: Lu,
    error_lu: Lu,
}

impl Newton {
    /// Prepares for steps from a point.
    pub fn begin(
        &mut self,
        field: &mut Field,
        t: f64,
        x: &[f64],
        before: Option<(Extension, f64)>,
    ) {
        let (n, all) = (x.len(), STAGES * x.len());
        if self.at.len() != n {
            let zeros = |size: usize| vec![0.0; size];
            (self.z, self.change, self.rates, self.at) =
                (zeros(all), zeros(all), zeros(all), zeros(n));
            (self.matrix, self.lu, self.error_lu) = (zeros(all * all), Lu::new(all), Lu::new(n));
        }
        self.jacobian = field.jacobian_of_mode(t, x);
        self.before = before;
    }

    /// Factors both matrices; `false` if one is singular.
    fn factor(&mut self, h: f64) -> bool {
        let (n, all) = (self.at.len(), self.z.len());
        let entry = |row: usize, column: usize| {
            let one = f64::from(u8::from(row == column));
            one - h * A[row / n][column / n] * self.jacobian[(row % n, column % n)]
        };
        (0..all * all).for_each(|at| self.matrix[at] = entry(at / all, at % all));
        let is_regular = self.lu.factor(all, &self.matrix);
        let entry = |row: usize, column: usize| {
            let one = f64::from(u8::from(row == column));
            one * EIGENVALUE / h - self.jacobian[(row, column)]
        };
        (0..n * n).for_each(|at| self.matrix[at] = entry(at / n, at % n));
        is_regular && self.error_lu.factor(n, &self.matrix)
    }

    /// Where the last step would go on to, or nothing.
    fn guess(&mut self, h: f64, start: &[f64]) {
        let n = start.len();
        for (at, z) in self.z.iter_mut().enumerate() {
            let (stage, i) = (at / n, at % n);
            let ahead = |(before, length): &(Extension, f64)| {
                before.component(i, 1.0 + C[stage] * h / length)
            };
            *z = self.before.as_ref().map_or(0.0, |before| ahead(before) - start[i]);
        }
    }

    /// One iteration; the largest change in units of the tolerance.
    fn iterate(&mut self, field: &mut Field, t: f64, h: f64, start: &[f64]) -> f64 {
        let n = start.len();
        for (stage, c) in C.iter().enumerate() {
            let z = &self.z[stage * n..][..n];
            self.at.iter_mut().zip(start.iter().zip(z)).for_each(|(at, (x, z))| *at = x + z);
            field.rate_into(t + c * h, &self.at, &mut self.rates[stage * n..][..n]);
        }
        for at in 0..self.z.len() {
            let (stage, i) = (at / n, at % n);
            let sum: f64 = (0..STAGES).map(|j| A[stage][j] * self.rates[j * n + i]).sum();
            self.change[at] = h * sum - self.z[at];
        }
        self.lu.solve(self.change.len(), &mut self.change, 1);
        let mut largest = 0.0_f64;
        for at in 0..self.z.len() {
            self.z[at] += self.change[at];
            let (x, i) = (start[at % n], at % n);
            let scaled = (self.change[at] / field.tolerance.of(i, [x, x + self.z[at]], h)).abs();
            largest = if scaled.is_finite() { largest.max(scaled) } else { f64::INFINITY };
        }
        largest
    }

    /// Solves the equations of a step.
    fn solve(&mut self, field: &mut Field, t: f64, h: f64, start: &[f64], rtol: f64) -> bool {
        let enough = (ROUNDING / rtol).max(rtol.sqrt().min(MOST_REST));
        let mut last = f64::INFINITY;
        for _ in 0..MOST_ITERATIONS {
            let change = self.iterate(field, t, h, start);
            if !change.is_finite() || change >= last {
                return last <= enough;
            }
            // Stopping criterion: what the rate of convergence leaves to be added.
            let rest = if last.is_finite() {
                change * change / (last - change)
            } else {
                FIRST_RATE * change
            };
            if rest <= enough {
                return true;
            }
            last = change;
        }
        false
    }

    /// `(g/h I - J)^-1 (rate + sum e_i z_i/h)`, in `change`.
    fn error(&mut self, rate: &[f64], h: f64) {
        let n = rate.len();
        for i in 0..n {
            let sum: f64 = (0..STAGES).map(|stage| ERROR[stage] * self.z[stage * n + i]).sum();
            self.change[i] = rate[i] + sum / h;
        }
        self.error_lu.solve(n, &mut self.change[..n], 1);
    }

    /// The rates of a state at the stages of the last iteration.
    pub fn stage_rates(&self, i: usize) -> impl Iterator<Item = f64> + '_ {
        self.rates.iter().copied().skip(i).step_by(self.at.len())
    }

    /// How much the rate of a state depends on the state itself.
    pub fn own_slope(&self, i: usize) -> f64 {
        self.jacobian[(i, i)].abs()
    }

    /// The largest sum of a row of `J`, which bounds its eigenvalues.
    pub fn stiffness(&self) -> f64 {
        self.jacobian
            .row_iter()
            .map(|row| row.iter().map(|entry| entry.abs()).sum())
            .fold(0.0, f64::max)
    }
}

/// Takes a step of length `h` from a start whose right side and Jacobian are known.
pub(crate) fn attempt(step: &mut Step, field: &mut Field) {
    let Step { t, h, start, end, newton, stages, .. } = step;
    let n = start.len();
    step.error = f64::INFINITY;
    // Matrices of the stages and of the error.
    if !newton.factor(*h) {
        return;
    }
    // Starting values, and simplified Newton iterations: z_i = h sum_j a_ij f(t + c_j h, x0 + z_j).
    newton.guess(*h, start);
    let rtol = field.tolerance.rtol;
    if !newton.solve(field, *t, *h, start, rtol) {
        step.error = NOT_SOLVED;
        return;
    }
    end.iter_mut().enumerate().for_each(|(i, end)| *end = start[i] + newton.z[2 * n + i]);
    // Local error; where it is that of the start, once more from a corrected start.
    let rate = stages[0].clone();
    newton.error(&rate, *h);
    step.error = size(step, &field.tolerance);
    if step.error > 1.0 && step.error <= INHERITED && is_inherited(step, field) {
        step.error = 1.0;
    }
    // Dense output.
    extend(step);
}

/// Whether the estimate is no more than the distance of the start from a slow manifold, which the
/// step damps: then the same estimate from a start that is corrected by it is small.
fn is_inherited(step: &mut Step, field: &mut Field) -> bool {
    let Step { t, h, start, newton, .. } = step;
    newton.at.iter_mut().enumerate().for_each(|(i, at)| *at = start[i] + newton.change[i]);
    let mut rate = vec![0.0; start.len()];
    field.rate_into(*t, &newton.at, &mut rate);
    newton.error(&rate, *h);
    size(step, &field.tolerance) <= 1.0
}

/// The largest error of a component in units of its tolerance.
pub(crate) fn size(step: &Step, tolerance: &Tolerance) -> f64 {
    let of = |i: usize| tolerance.of(i, [step.start[i], step.end[i]], step.h);
    let scaled = |i: usize| (step.newton.change[i] / of(i)).abs();
    let largest = (0..step.start.len()).map(scaled);
    largest.fold(
        0.0,
        |largest, value| if value.is_finite() { f64::max(largest, value) } else { f64::INFINITY },
    )
}

/// The collocation polynomial.
fn extend(step: &mut Step) {
    let n = step.start.len();
    step.extension.start.copy_from_slice(&step.start);
    for i in 0..n {
        let z = |stage: usize| step.newton.z[stage * n + i];
        let a = z(2);
        let slope = |stage: usize| (z(stage) / C[stage] - a) / (1.0 - C[stage]);
        let c = (slope(0) - slope(1)) / (C[0] - C[1]);
        let coefficients = [a, slope(0) - C[0] * c, c, 0.0];
        step.extension
            .dense
            .iter_mut()
            .zip(coefficients)
            .for_each(|(column, value)| column[i] = value);
    }
}
