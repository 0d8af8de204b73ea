//! One step in one mode, and the state at any time inside it.
//!
//! ```text
//! x(t + theta h) = x0 + theta (a + (1 - theta) (b + theta (c + (1 - theta) d)))
//! ```

pub(crate) mod departure;
pub(crate) mod dormand_prince;
pub(crate) mod radau;

use super::field::Field;
use super::field::tolerance::Tolerance;
use super::result::Method;
use super::tape::Rule;
use crate::simulate::tuning::radau::NOT_SOLVED;
use dormand_prince::STAGES;
use radau::Newton;

/// The state inside a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Extension {
    pub start: Vec<f64>,
    /// Coefficients `a`, `b`, `c`, `d`.
    pub dense: [Vec<f64>; 4],
}

impl Extension {
    fn new(states: usize) -> Self {
        Extension { start: vec![0.0; states], dense: std::array::from_fn(|_| vec![0.0; states]) }
    }

    /// The Bernstein coefficients of a component.
    pub fn coefficients(&self, i: usize) -> [f64; 5] {
        let [a, b, c, d] = self.dense.each_ref().map(|column| column[i]);
        let added =
            [0.0, (a + b) / 4.0, a / 2.0 + b / 3.0 + (c + d) / 6.0, (3.0 * a + b + c) / 4.0, a];
        added.map(|added| self.start[i] + added)
    }

    /// Those of its rate, per step.
    pub fn slopes(&self, i: usize) -> [f64; 4] {
        let values = self.coefficients(i);
        std::array::from_fn(|at| 4.0 * (values[at + 1] - values[at]))
    }

    /// A component at a part of the step, or beyond it.
    pub fn component(&self, i: usize, theta: f64) -> f64 {
        let rest = 1.0 - theta;
        let [a, b, c, d] = &self.dense;
        self.start[i] + theta * (a[i] + rest * (b[i] + theta * (c[i] + rest * d[i])))
    }
}

/// A step from `t` to `t + h`. Its memory is used again for the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Step {
    pub t: f64,
    pub h: f64,
    pub start: Vec<f64>,
    pub end: Vec<f64>,
    pub method: Method,
    /// How it was taken in the end.
    pub rule: Rule,
    /// In units of the tolerance; infinite if something on the way has no value.
    pub error: f64,
    pub extension: Extension,
    /// The right side at each stage of the explicit pair; the first at the start.
    pub stages: [Vec<f64>; STAGES],
    /// Where its last stage but one is.
    pub near_end: Vec<f64>,
    /// What the stiff method needs.
    pub newton: Newton,
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
            rule: Rule::Explicit,
            error: f64::INFINITY,
            extension: Extension::new(states),
            stages: std::array::from_fn(|_| zeros()),
            near_end: zeros(),
            newton: Newton::default(),
        }
    }

    /// Takes a single step.
    pub fn take(field: &mut Field, t: f64, x: &[f64], h: f64) -> Self {
        let mut step = Step::new(x.len());
        step.begin(field, t, x, Method::Explicit, false);
        step.attempt(field, h);
        step
    }

    /// Prepares for the next step, which may continue this one.
    pub fn begin(
        &mut self,
        field: &mut Field,
        t: f64,
        x: &[f64],
        method: Method,
        is_continued: bool,
    ) {
        let is_same = is_continued && self.method == method;
        (self.t, self.method) = (t, method);
        self.start.copy_from_slice(x);
        if is_same && method == Method::Explicit {
            self.stages.swap(0, STAGES - 1);
        } else {
            field.rate_into(t, x, &mut self.stages[0]);
        }
        if method == Method::Stiff {
            let before = is_same.then(|| (self.extension.clone(), self.h));
            self.newton.begin(field, t, x, before);
        }
    }

    /// Takes the step, with this length.
    pub fn attempt(&mut self, field: &mut Field, h: f64) {
        self.h = h;
        match self.method {
            Method::Explicit if field.departs(self.t) || h > field.stable => {
                self.rule = Rule::Collocation;
                departure::attempt(self, field);
            }
            Method::Explicit => {
                self.rule = Rule::Explicit;
                dormand_prince::attempt(self, field);
            }
            Method::Stiff => {
                self.rule = Rule::Radau;
                radau::attempt(self, field);
            }
        }
    }

    /// The error once more, after the tolerance has changed.
    pub fn measure(&mut self, tolerance: &Tolerance) {
        match self.rule {
            Rule::Explicit => self.error = dormand_prince::error(self, tolerance),
            Rule::Radau if self.error != NOT_SOLVED => self.error = radau::size(self, tolerance),
            Rule::Radau | Rule::Collocation | Rule::Straight => {}
        }
    }

    /// Ends the step along a curve that is known in its middle and at its end, with the rate there;
    /// that at the start is known.
    pub fn end_smoothly(&mut self, middle: &[f64], end: &[f64], last: &[f64]) {
        for i in 0..end.len() {
            let (start, first) = (self.start[i], self.stages[0][i]);
            let a = end[i] - start;
            let b = self.h * first - a;
            let c = a - self.h * last[i] - b;
            let d = 2.0 * (2.0 * (2.0 * (2.0 * (middle[i] - start) - a) - b) - c);
            self.extension.start[i] = start;
            [a, b, c, d]
                .into_iter()
                .zip(&mut self.extension.dense)
                .for_each(|(value, dense)| dense[i] = value);
        }
        self.end.copy_from_slice(end);
        self.near_end.copy_from_slice(end);
        self.stages[STAGES - 1].copy_from_slice(last);
    }

    /// The state at `t + theta h`.
    pub fn at(&self, theta: f64) -> Vec<f64> {
        (0..self.start.len()).map(|i| self.component(i, theta)).collect()
    }

    /// The state after a part of the step, as exact as its end: the collocation polynomial is not.
    pub fn exactly_at(&self, field: &mut Field, h: f64) -> Vec<f64> {
        if self.method == Method::Explicit || h == 0.0 {
            return self.at(h / self.h);
        }
        let mut shorter = self.clone();
        shorter.attempt(field, h);
        shorter.end
    }

    /// A component of the state at `t + theta h`.
    pub fn component(&self, i: usize, theta: f64) -> f64 {
        self.extension.component(i, theta)
    }

    /// The least and the greatest rate of a component at the stages.
    pub fn rates(&self, i: usize) -> [f64; 2] {
        let widened = |[low, high]: [f64; 2], rate: f64| [low.min(rate), high.max(rate)];
        let first = [self.stages[0][i]; 2];
        match self.rule {
            Rule::Explicit => self.stages.iter().map(|stage| stage[i]).fold(first, widened),
            Rule::Radau => self.newton.stage_rates(i).fold(first, widened),
            Rule::Collocation | Rule::Straight => first,
        }
    }

    /// By how much it is stiff: `h` times the largest eigenvalue, as far as the method knows it.
    pub fn stiffness(&self) -> f64 {
        match self.method {
            Method::Explicit => dormand_prince::stiffness(self),
            Method::Stiff => self.h * self.newton.stiffness(),
        }
    }
}
