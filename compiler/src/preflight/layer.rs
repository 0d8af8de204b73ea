//! The smoothed layer of a surface: how steep the right side is in it.
//!
//! The right side is `a + b s` in the selector `s` of `psi`. Smoothed, `s = S(psi/sigma)`, and in
//! the layer the distance `psi` obeys `psi' = ... + (grad psi . b) S(psi/sigma)`, with the slope
//!
//! ```text
//! L = J S'(0) / sigma,     J = -grad psi . b   where that is positive: the surface attracts.
//! ```

use super::Preflight;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, evaluate};
use crate::expressions::kernels;
use crate::model::Symbol;
use crate::syntax::text;

/// A surface that attracts along the guess.
pub(super) struct Layer {
    /// The surface.
    pub surface: usize,
    /// Its name.
    pub name: String,
    /// The largest `J` along the guess.
    pub jump: f64,
    /// `J` as an expression.
    force: ExprId,
    /// Whether the jump outweighs the drift `grad psi . a + dpsi/dt` at some time of the guess.
    pub is_held: bool,
    /// Whether that is proved, not read off the guess.
    pub is_proved: bool,
}

/// Three digits are enough for a message.
pub(super) fn short(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let scale = 10_f64.powi(2 - value.abs().log10().floor() as i32);
    let rounded = (value * scale).round() / scale;
    // Away from the digits that division leaves behind: 0.012, not 0.012000000000000002.
    format!("{rounded:.12e}").parse().unwrap_or(rounded)
}

impl Preflight<'_> {
    /// `S'(0)` of the model's kernel.
    pub(super) fn kernel_slope(&self) -> f64 {
        kernels::find(&self.model.method.kernel).map_or(1.0, kernels::Kernel::slope)
    }

    /// `muN/sigma`, or with the slope of the kernel, `1.5*muN/sigma`.
    pub(super) fn slope_text(&self, layer: &Layer) -> String {
        let factor = self.kernel_slope();
        match self.parameter_behind(layer) {
            Some(jump) if factor == 1.0 => format!("{jump}/sigma"),
            Some(jump) => format!("{}*{jump}/sigma", text::number(factor)),
            None => format!("{}/sigma", text::number(short(factor * layer.jump))),
        }
    }

    /// The surfaces by themselves that attract somewhere along the guess, steepest first.
    pub(super) fn layers(&mut self) -> Vec<Layer> {
        let alone: Vec<usize> = self
            .model
            .switches()
            .iter()
            .filter(|it| !it.is_ball)
            .map(|it| it.surfaces.start)
            .collect();
        let known = |surface| Some((surface, self.force_and_drift(surface)?));
        let known: Vec<(usize, [ExprId; 2])> = alone.into_iter().filter_map(known).collect();
        let roots: Vec<ExprId> = known.iter().flat_map(|it| it.1).collect();
        let points: Vec<Vec<f64>> =
            self.points.iter().map(|at| evaluate(&self.graph, &roots, at, &[])).collect();
        let layer = |(at, (surface, [force, _])): (usize, (usize, [ExprId; 2]))| {
            let values = || points.iter().map(|values| (values[2 * at], values[2 * at + 1]));
            let jump =
                values().map(|it| it.0).filter(|force| force.is_finite()).fold(0.0, f64::max);
            let is_held = values().any(|(force, drift)| drift.abs() < force);
            let name = self.model.surfaces[surface].place.name.clone();
            (jump > 0.0).then_some(Layer { surface, name, jump, force, is_held, is_proved: false })
        };
        let mut layers: Vec<Layer> = known.into_iter().enumerate().filter_map(layer).collect();
        layers.sort_by(|a, b| b.jump.total_cmp(&a.jump));
        layers
    }

    /// `-grad psi . b` and `grad psi . (a + b s) + dpsi/dt`.
    fn force_and_drift(&mut self, surface: usize) -> Option<[ExprId; 2]> {
        let selector = self.model.input_of(Symbol::Selector(surface))?;
        let psi = self.model.surfaces[surface].psi;
        let time = self.model.input_of(Symbol::Time);
        let mut drifts: Vec<ExprId> =
            time.map(|time| derivative(&mut self.graph, psi, time)).into_iter().collect();
        let mut forces = Vec::new();
        // A large model has many states, and a surface depends on few of them.
        let inputs = self.graph.inputs_of(&[psi]);
        for input in inputs {
            let Symbol::State(index) = self.model.symbols[input as usize] else { continue };
            let state = &self.model.states[index];
            let gradient = derivative(&mut self.graph, psi, input);
            if self.graph.as_number(gradient) != Some(0.0) {
                let force = derivative(&mut self.graph, state.rate, selector);
                forces.push(self.graph.mul(gradient, force));
                drifts.push(self.graph.mul(gradient, state.rate));
            }
        }
        let sum = self.graph.sum(&forces);
        Some([self.graph.neg(sum), self.graph.sum(&drifts)])
    }

    /// The parameter that the jump is: its value all along the guess, and doubled with it.
    fn parameter_behind(&self, layer: &Layer) -> Option<&str> {
        let is_close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs();
        let force = |inputs: &[f64]| evaluate(&self.graph, &[layer.force], inputs, &[])[0];
        let doubles = |inputs: &Vec<f64>, input: usize| {
            let mut doubled = inputs.clone();
            doubled[input] *= 2.0;
            is_close(force(inputs), inputs[input]) && is_close(force(&doubled), doubled[input])
        };
        let is_it = |index: &usize| {
            let Some(input) = self.model.input_of(Symbol::Param(*index)) else { return false };
            let input = input as usize;
            self.points
                .iter()
                .all(|inputs| is_close(inputs[input], layer.jump) && doubles(inputs, input))
        };
        let index = (0..self.model.params.len()).find(is_it)?;
        Some(&self.model.params[index].place.name)
    }
}
