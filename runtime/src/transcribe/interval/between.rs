//! States and controls between the points of an interval, as sums of its variables.

use super::{Combination, Interval, Places, Signal};
use crate::lagrange;
use crate::problem::ControlShape;

impl Interval {
    /// The derivative of a signal by the time of the interval, of any order; at all times of a step
    /// it is a sum of the same variables.
    pub(crate) fn derivative_at(&self, signal: Signal, time: f64, order: usize) -> Combination {
        match signal {
            Signal::State(state) => self.places.state_derivative(state, time, order),
            Signal::Control(control) => self.places.control_derivative(control, time, order),
        }
    }

    /// A signal at the begin or at the end of the step in which a time is.
    pub(crate) fn end_of_step(&self, signal: Signal, time: f64, is_end: bool) -> Combination {
        let step = self.places.step_of(time) + usize::from(is_end);
        match signal {
            Signal::State(state) => vec![(self.places.joint(step) + state, 1.0)],
            Signal::Control(control) => {
                self.places.control_derivative(control, self.places.time(step, 0.0), 0)
            }
        }
    }

    /// Integration steps.
    pub(crate) fn steps(&self) -> usize {
        self.places.steps
    }

    /// The time in the middle of a step.
    pub(crate) fn middle_of(&self, step: usize) -> f64 {
        self.places.time(step, 0.5)
    }

    /// When the step begins in which a time is, and the part of the interval that it takes.
    pub(crate) fn step_at(&self, time: f64) -> (f64, f64) {
        let steps = self.places.steps as f64;
        (self.places.step_of(time) as f64 / steps, 1.0 / steps)
    }
}

impl Places {
    /// The step in which a time of the interval is.
    fn step_of(&self, time: f64) -> usize {
        ((time * self.steps as f64) as usize).min(self.steps - 1)
    }

    pub(super) fn state(&self, state: usize, time: f64) -> Combination {
        self.state_derivative(state, time, 0)
    }

    fn state_derivative(&self, state: usize, time: f64, order: usize) -> Combination {
        let step = self.step_of(time);
        let (points, places) = self.support(step);
        let passed = time * self.steps as f64 - step as f64;
        let scale = (self.steps as f64).powi(order as i32);
        let factors = polynomial(&points, passed, order).into_iter().map(|it| scale * it);
        places.iter().map(|place| place + state).zip(factors).collect()
    }

    pub(super) fn control(&self, control: usize, time: f64) -> Combination {
        let terms = self.control_derivative(control, time, 0).into_iter();
        terms.filter(|(_, factor)| *factor != 0.0).collect()
    }

    fn control_derivative(&self, control: usize, time: f64, order: usize) -> Combination {
        match (self.shape, self.nodes) {
            (ControlShape::Linear, _) => {
                let factors = polynomial(&[0.0, 1.0], time, order);
                vec![(self.states + control, factors[0]), (self.carried + control, factors[1])]
            }
            (ControlShape::Polynomial, Some(nodes)) => {
                let place = |j: usize| self.carried + j * self.controls + control;
                let factors = polynomial(nodes, time, order).into_iter().enumerate();
                factors.map(|(j, factor)| (place(j), factor)).collect()
            }
            _ => vec![(self.carried + control, if order == 0 { 1.0 } else { 0.0 })],
        }
    }
}

/// The derivatives of this order of the Lagrange polynomials over some points.
fn polynomial(points: &[f64], time: f64, order: usize) -> Vec<f64> {
    match order {
        0 => lagrange::values(points, time),
        _ => lagrange::derivatives(points, time, order),
    }
}
