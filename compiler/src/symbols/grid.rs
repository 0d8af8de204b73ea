//! The grid of a model in numbers, for hover.

use crate::model::Model;
use crate::model::numbers::numbers;
use fdcc_runtime::problem::{ControlShape, Method, Scheme};

/// What a grid costs and how fine it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Control intervals.
    pub intervals: usize,
    /// Unknowns of the nonlinear program, for schemes without variables inside of an interval.
    pub unknowns: Option<usize>,
    /// The step, with the duration of the guess.
    pub step: f64,
    /// The width of the smoothed layer, if the model names one.
    pub sigma: Option<f64>,
}

/// The grid of a model; nothing if it waits for a parameter.
pub fn grid(model: &Model) -> Option<Grid> {
    let numbers = numbers(model).ok()?;
    let [first, last] = model.interval.map(|end| numbers.value(model, end));
    let Method { steps, sigma, .. } = model.method;
    let intervals = model.method.intervals();
    let has_inner = matches!(model.method.scheme, Scheme::Radau(_) | Scheme::Gauss(_));
    let (states, controls) = (model.states.len(), model.controls.len());
    let whole =
        intervals.saturating_mul(states + controls).saturating_add(states + model.frees.len());
    let is_plain = !has_inner && model.method.controls == ControlShape::Constant;
    let step = (last - first) / (intervals * steps) as f64;
    Some(Grid { intervals, unknowns: is_plain.then_some(whole), step, sigma })
}
