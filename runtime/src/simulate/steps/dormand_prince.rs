//! The pair of order 5(4) of Dormand and Prince with its continuous extension of order 4.
//!
//! J. R. Dormand, P. J. Prince: A family of embedded Runge-Kutta formulae, J. Comput. Appl. Math. 6
//! (1980) 19-26; dense output: E. Hairer, S. P. Norsett, G. Wanner: Solving Ordinary Differential
//! Equations I, 2nd ed., II.6.

use super::Step;
use crate::simulate::field::Field;
use crate::simulate::field::tolerance::Tolerance;

/// Number of stages; the last is the first of the next step.
pub(crate) const STAGES: usize = 7;

/// When the stages are.
pub(crate) const C: [f64; STAGES] = [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];

/// How stages build on those before; the last row holds the weights of order 5.
pub(crate) const A: [[f64; 6]; STAGES] = [
    [0.0; 6],
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];

/// Order 5 minus order 4.
pub(crate) const ERROR: [f64; STAGES] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// The last coefficient of the continuous extension.
pub(crate) const DENSE: [f64; STAGES] = [
    -12715105075.0 / 11282082432.0,
    0.0,
    87487479700.0 / 32700410799.0,
    -10690763975.0 / 1880347072.0,
    701980252875.0 / 199316789632.0,
    -1453857185.0 / 822651844.0,
    69997945.0 / 29380423.0,
];

/// Takes a step of length `h` from a start whose right side is known.
pub(crate) fn attempt(step: &mut Step, field: &mut Field) {
    let Step { t, h, start, end, stages, near_end, .. } = step;
    // Stages: k_i = f(t + c_i h, x + h sum_j a_ij k_j).
    for stage in 1..STAGES {
        let (before, after) = stages.split_at_mut(stage);
        combine(end, start, *h, before, &A[stage]);
        if stage == STAGES - 2 {
            near_end.copy_from_slice(end);
        }
        field.rate_into(*t + C[stage] * *h, end, &mut after[0]);
    }
    // Local error of the embedded pair, and dense output.
    step.error = error(step, &field.tolerance);
    extend(step);
}

fn sum(i: usize, stages: &[Vec<f64>], weights: &[f64]) -> f64 {
    stages.iter().zip(weights).map(|(stage, weight)| weight * stage[i]).sum()
}

fn combine(into: &mut [f64], x: &[f64], h: f64, stages: &[Vec<f64>], weights: &[f64]) {
    into.iter_mut().enumerate().for_each(|(i, into)| *into = x[i] + h * sum(i, stages, weights));
}

/// The largest error of a component in units of its tolerance.
pub(crate) fn error(step: &Step, tolerance: &Tolerance) -> f64 {
    let mut largest = 0.0_f64;
    for (i, (x, end)) in step.start.iter().zip(&step.end).enumerate() {
        let scaled =
            (step.h * sum(i, &step.stages, &ERROR)).abs() / tolerance.of(i, [*x, *end], step.h);
        if !scaled.is_finite() || !end.is_finite() {
            return f64::INFINITY;
        }
        largest = largest.max(scaled);
    }
    largest
}

/// The continuous extension.
fn extend(step: &mut Step) {
    step.extension.start.copy_from_slice(&step.start);
    let [a, b, c, d] = &mut step.extension.dense;
    let (h, stages) = (step.h, &step.stages);
    for i in 0..step.start.len() {
        a[i] = step.end[i] - step.start[i];
        b[i] = h * stages[0][i] - a[i];
        c[i] = a[i] - h * stages[STAGES - 1][i] - b[i];
        d[i] = h * sum(i, stages, &DENSE);
    }
}

/// `h |lambda|` of the largest eigenvalue, as the last two stages show it; beyond 3.3 the pair is
/// not stable.
///
/// E. Hairer, G. Wanner: Solving Ordinary Differential Equations II, 2nd ed., IV.2, (2.21).
pub(crate) fn stiffness(step: &Step) -> f64 {
    let distance =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    let (rates, states) = (
        distance(&step.stages[STAGES - 1], &step.stages[STAGES - 2]),
        distance(&step.end, &step.near_end),
    );
    if states > 0.0 { step.h * rates / states } else { 0.0 }
}
