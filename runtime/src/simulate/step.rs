//! One step of the Runge-Kutta pair, and the state at any time inside it.

use super::field::Field;
use super::result::Options;
use super::setting_out;
use super::tableau::{A, C, DENSE, ERROR, STAGES};

/// A step from `t` to `t + h` in one mode.
pub(super) struct Step {
    pub t: f64,
    pub h: f64,
    pub start: Vec<f64>,
    pub end: Vec<f64>,
    /// In units of the tolerance; infinite if something on the way has no value.
    pub error: f64,
    /// Coefficients of the continuous extension.
    dense: [Vec<f64>; 4],
}

impl Step {
    /// Takes a step.
    pub fn take(field: &mut Field, t: f64, x: &[f64], h: f64, options: &Options) -> Self {
        if field.sets_out(t) || h > field.stable {
            return setting_out::step(field, t, x, h, options);
        }
        let stages = stages(field, t, x, h);
        let end = combine(x, h, &stages, &A[STAGES - 1]);
        let error = error(x, &end, h, &stages, options);
        let dense = dense(x, &end, h, &stages);
        Step { t, h, start: x.to_vec(), end, error, dense }
    }

    /// A step that cannot be taken.
    pub fn refused(t: f64, x: &[f64], h: f64) -> Self {
        let dense = std::array::from_fn(|_| vec![0.0; x.len()]);
        Step { t, h, start: x.to_vec(), end: x.to_vec(), error: f64::INFINITY, dense }
    }

    /// A step along a curve that is known at its start, middle and end, with the rates at both ends.
    pub fn smooth(
        [t, h]: [f64; 2],
        [start, middle, end]: [Vec<f64>; 3],
        [first, last]: [Vec<f64>; 2],
        error: f64,
    ) -> Self {
        let size = start.len();
        let a: Vec<f64> = (0..size).map(|i| end[i] - start[i]).collect();
        let b: Vec<f64> = (0..size).map(|i| h * first[i] - a[i]).collect();
        let c: Vec<f64> = (0..size).map(|i| a[i] - h * last[i] - b[i]).collect();
        let d: Vec<f64> = (0..size)
            .map(|i| 2.0 * (2.0 * (2.0 * (2.0 * (middle[i] - start[i]) - a[i]) - b[i]) - c[i]))
            .collect();
        let dense = [a, b, c, d];
        Step { t, h, start, end, error, dense }
    }

    /// The state at `t + theta h`.
    pub fn at(&self, theta: f64) -> Vec<f64> {
        let rest = 1.0 - theta;
        let [a, b, c, d] = &self.dense;
        let value = |i: usize| self.start[i] + theta * (a[i] + rest * (b[i] + theta * (c[i] + rest * d[i])));
        (0..self.start.len()).map(value).collect()
    }
}

/// All stages; the last is at the end of the step.
fn stages(field: &mut Field, t: f64, x: &[f64], h: f64) -> Vec<Vec<f64>> {
    let mut stages: Vec<Vec<f64>> = Vec::with_capacity(STAGES);
    for stage in 0..STAGES {
        let at = combine(x, h, &stages, &A[stage]);
        let rate = field.rate(t + C[stage] * h, &at);
        stages.push(rate);
    }
    stages
}

fn combine(x: &[f64], h: f64, stages: &[Vec<f64>], weights: &[f64]) -> Vec<f64> {
    let sum = |i: usize| stages.iter().zip(weights).map(|(stage, weight)| weight * stage[i]).sum::<f64>();
    x.iter().enumerate().map(|(i, x)| x + h * sum(i)).collect()
}

/// The largest error of a component in units of its tolerance.
fn error(x: &[f64], end: &[f64], h: f64, stages: &[Vec<f64>], options: &Options) -> f64 {
    let error = combine(&vec![0.0; x.len()], h, stages, &ERROR);
    let scaled = |i: usize| error[i].abs() / (options.atol + options.rtol * x[i].abs().max(end[i].abs()));
    let is_finite = stages.iter().flatten().chain(end).all(|value| value.is_finite());
    if is_finite { (0..x.len()).map(scaled).fold(0.0, f64::max) } else { f64::INFINITY }
}

fn dense(x: &[f64], end: &[f64], h: f64, stages: &[Vec<f64>]) -> [Vec<f64>; 4] {
    let size = x.len();
    let a: Vec<f64> = (0..size).map(|i| end[i] - x[i]).collect();
    let b: Vec<f64> = (0..size).map(|i| h * stages[0][i] - a[i]).collect();
    let c: Vec<f64> = (0..size).map(|i| a[i] - h * stages[STAGES - 1][i] - b[i]).collect();
    let d = combine(&vec![0.0; size], h, stages, &DENSE);
    [a, b, c, d]
}
