//! One step in one mode, and the state at any time inside it.
//!
//! ```text
//! x(t + theta h) = x0 + theta (a + (1 - theta) (b + theta (c + (1 - theta) d)))
//! ```

use super::explicit::{self, STAGES};
use super::field::Field;
use super::result::{Method, Options};

/// A step from `t` to `t + h`. Its memory is used again for the next.
#[derive(Clone, Debug, Default)]
pub(super) struct Step {
    pub t: f64,
    pub h: f64,
    pub start: Vec<f64>,
    pub end: Vec<f64>,
    pub method: Method,
    /// In units of the tolerance; infinite if something on the way has no value.
    pub error: f64,
    /// Coefficients `a`, `b`, `c`, `d` of the continuous extension.
    pub dense: [Vec<f64>; 4],
    /// The right side at each stage; the first at the start.
    pub stages: [Vec<f64>; STAGES],
    /// Where the last stage but one is.
    pub near_end: Vec<f64>,
}

impl Step {
    pub fn new(states: usize) -> Self {
        let zeros = || vec![0.0; states];
        Step {
            t: 0.0,
            h: 0.0,
            start: zeros(),
            end: zeros(),
            method: Method::Explicit,
            error: f64::INFINITY,
            dense: std::array::from_fn(|_| zeros()),
            stages: std::array::from_fn(|_| zeros()),
            near_end: zeros(),
        }
    }

    /// Takes a single step.
    pub fn take(field: &mut Field, t: f64, x: &[f64], h: f64, options: &Options) -> Self {
        let mut step = Step::new(x.len());
        step.begin(field, t, x);
        step.attempt(field, h, options);
        step
    }

    /// The next step starts anew.
    pub fn begin(&mut self, field: &mut Field, t: f64, x: &[f64]) {
        self.t = t;
        self.start.copy_from_slice(x);
        field.rate_into(t, x, &mut self.stages[0]);
    }

    /// The next step continues this one, whose last stage is its first.
    pub fn follow(&mut self, t: f64, x: &[f64]) {
        self.t = t;
        self.start.copy_from_slice(x);
        self.stages.swap(0, STAGES - 1);
    }

    /// Takes the step, with this length.
    pub fn attempt(&mut self, field: &mut Field, h: f64, options: &Options) {
        self.h = h;
        explicit::attempt(self, field, options);
    }

    /// The state at `t + theta h`.
    pub fn at(&self, theta: f64) -> Vec<f64> {
        (0..self.start.len()).map(|i| self.component(i, theta)).collect()
    }

    /// A component of the state at `t + theta h`.
    pub fn component(&self, i: usize, theta: f64) -> f64 {
        let rest = 1.0 - theta;
        let [a, b, c, d] = &self.dense;
        self.start[i] + theta * (a[i] + rest * (b[i] + theta * (c[i] + rest * d[i])))
    }
}
