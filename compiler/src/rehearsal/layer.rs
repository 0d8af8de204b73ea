//! The smoothed layer of a surface: how steep the right side is in it.
//!
//! The right side is `a + b s` in the selector `s` of `psi`. Smoothed, `s = S(psi/sigma)`, and in the layer the distance
//! `psi` obeys `psi' = ... + (grad psi . b) S(psi/sigma)`, with the slope
//!
//! ```text
//! L = J S'(0) / sigma,     J = -grad psi . b   where that is positive: the surface attracts.
//! ```

use super::Rehearsal;
use crate::differentiate::derivative;
use crate::graph::ExprId;
use crate::model::Symbol;
use crate::resolve::text;
use crate::smooth;

/// A surface that attracts along the guess.
pub(super) struct Layer {
    /// The name of the surface.
    pub name: String,
    /// The largest `J` along the guess.
    pub jump: f64,
    /// `J` in the words of the model, if it is one parameter.
    jump_text: Option<String>,
    /// Whether the jump outweighs the drift `grad psi . a + dpsi/dt` at some time of the guess: there it can be held.
    pub is_held: bool,
}

impl Layer {
    /// `muN/sigma`, or with the slope of the kernel, `1.5*muN/sigma`.
    pub fn slope_text(&self, factor: f64) -> String {
        match &self.jump_text {
            Some(jump) if factor == 1.0 => format!("{jump}/sigma"),
            Some(jump) => format!("{}*{jump}/sigma", text::number(factor)),
            None => format!("{}/sigma", text::number(short(factor * self.jump))),
        }
    }
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

impl Rehearsal<'_> {
    /// `S'(0)` of the model's kernel.
    pub(super) fn kernel_slope(&self) -> f64 {
        smooth::find(&self.model.method.kernel).map_or(1.0, smooth::Kernel::slope)
    }

    /// The surfaces by themselves that attract somewhere along the guess, steepest first.
    pub(super) fn layers(&mut self) -> Vec<Layer> {
        let alone: Vec<usize> =
            self.model.switches().iter().filter(|it| !it.is_ball).map(|it| it.surfaces.start).collect();
        let mut layers: Vec<Layer> = alone.into_iter().filter_map(|surface| self.layer(surface)).collect();
        layers.sort_by(|a, b| b.jump.total_cmp(&a.jump));
        layers
    }

    fn layer(&mut self, surface: usize) -> Option<Layer> {
        let [force, drift] = self.force_and_drift(surface)?;
        let (forces, drifts) = (self.along(force), self.along(drift));
        let jump = forces.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max);
        let name = self.model.surfaces[surface].place.name.clone();
        let jump_text = self.parameter_behind(force, jump);
        let is_held = forces.iter().zip(&drifts).any(|(force, drift)| drift.abs() < *force);
        (jump > 0.0).then_some(Layer { name, jump, jump_text, is_held })
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
        for (index, state) in self.model.states.iter().enumerate() {
            let input = self.model.input_of(Symbol::State(index))?;
            if inputs.binary_search(&input).is_err() {
                continue;
            }
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
    fn parameter_behind(&self, force: ExprId, jump: f64) -> Option<String> {
        let is_close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b.abs();
        let equals = |value: f64, inputs: &[f64]| {
            is_close(crate::graph::evaluate(&self.graph, &[force], inputs, &[])[0], value)
        };
        let is_it = |index: usize| {
            let input = self.model.input_of(Symbol::Param(index)).map_or(usize::MAX, |input| input as usize);
            self.points.iter().filter_map(|inputs| Some((inputs, *inputs.get(input)?))).all(
                |(inputs, value)| {
                    let mut doubled = inputs.clone();
                    doubled[input] *= 2.0;
                    is_close(value, jump) && equals(value, inputs) && equals(2.0 * value, &doubled)
                },
            )
        };
        let index = (0..self.model.params.len()).find(|&index| is_it(index))?;
        Some(self.model.params[index].place.name.clone())
    }
}
