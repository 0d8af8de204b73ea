//! The explicit pair of order 5(4) of Dormand and Prince; see [`tableau`](super::tableau).

use super::field::Field;
use super::step::Step;
use super::tableau::{A, C, DENSE, ERROR};
use super::tolerance::Tolerance;

pub(super) use super::tableau::STAGES;

/// Takes a step of length `h` from a start whose right side is known.
pub(super) fn attempt(step: &mut Step, field: &mut Field) {
    let Step { t, h, start, end, stages, near_end, .. } = step;
    for stage in 1..STAGES {
        let (before, after) = stages.split_at_mut(stage);
        combine(end, start, *h, before, &A[stage]);
        if stage == STAGES - 2 {
            near_end.copy_from_slice(end);
        }
        field.rate_into(*t + C[stage] * *h, end, &mut after[0]);
    }
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
pub(super) fn error(step: &Step, tolerance: &Tolerance) -> f64 {
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
pub(super) fn stiffness(step: &Step) -> f64 {
    let distance =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    let (rates, states) = (
        distance(&step.stages[STAGES - 1], &step.stages[STAGES - 2]),
        distance(&step.end, &step.near_end),
    );
    if states > 0.0 { step.h * rates / states } else { 0.0 }
}
