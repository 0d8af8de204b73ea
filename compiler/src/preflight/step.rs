//! FDC0501: an explicit step that is too long for the smoothed layer.
//!
//! With the slope `L` of the layer, an Euler step of length `h` multiplies the distance to the
//! surface by `1 - h L`: beyond `h L = 1` it lands on the other side, beyond 2 it moves away.

use super::layer::{Layer, short};
use super::{Preflight, Sigma, span};
use crate::expressions::graph::Expr;
use crate::model::Symbol;
use crate::syntax::text::number;
use fdcc_grammar::{Code, Diagnostic};
use fdcc_runtime::problem::{Grid, Scheme};

/// Reports the steepest layer that the step does not resolve.
pub(super) fn check(preflight: &mut Preflight<'_>, found: &mut Vec<Diagnostic>) {
    let method = &preflight.model.method;
    let (Some(sigma), Scheme::Euler) = (preflight.sigma(), method.scheme) else { return };
    if method.grid == Grid::Auto {
        return;
    }
    let step = preflight.duration / (method.intervals() * method.steps) as f64;
    let factor = preflight.kernel_slope();
    let Some(layer) = preflight.layers().into_iter().next() else { return };
    let slope = factor * layer.jump / sigma.width;
    if step * slope > 1.0 {
        found.push(too_long(preflight, &layer, &sigma, step, slope));
    }
}

fn too_long(
    preflight: &Preflight<'_>,
    layer: &Layer,
    sigma: &Sigma,
    step: f64,
    slope: f64,
) -> Diagnostic {
    let shown = |value: f64| number(short(value));
    let width = sigma.text(sigma.width);
    let message = format!("the step is too long for the smoothed layer of `{}`", layer.name);
    let label = format!("layer slope L = {} = {}", preflight.slope_text(layer), shown(slope));
    let found = Diagnostic::new(Code::LongStep, message, sigma.span, label);
    let length = format!("{}, so h*L = {}", preflight.step_text(step), shown(step * slope));
    let found = match preflight.setting("N").or(preflight.setting("scheme")) {
        Some(setting) => found.label(span(setting), length),
        None => found,
    };
    found.help(format!(
        "Euler overshoots the layer when h*L > 1 and oscillates when h*L > 2.\n\
         use N >= {} for sigma = {width}, or sigma >= {} for N = {}, or `scheme implicit_euler`\n\
         (the implicit scheme removes the oscillation, not the gradient error: still keep h small)",
        number((preflight.duration * slope).ceil()),
        sigma.text(slope * sigma.width * step),
        preflight.model.method.intervals()
    ))
}

impl Preflight<'_> {
    /// `h = T/N = 0.012 at T = 6`, where the duration is one unknown; `h = 4/500 = 0.008` where it
    /// is a number.
    fn step_text(&self, step: f64) -> String {
        let [duration, step] = [self.duration, step].map(|it| self.time_text(it));
        match self.free_duration() {
            Some(name) => format!("h = {name}/N = {step} at {name} = {duration}"),
            None => format!("h = {duration}/N = {step}"),
        }
    }

    /// A span of time in the unit of time, which is told unless it is that of SI.
    pub(super) fn time_text(&self, seconds: f64) -> String {
        match self.model.units.iter().find(|it| it.is_time && it.scale != 1.0) {
            Some(it) => format!("{} {}", number(short(seconds / it.scale)), it.unit),
            None => number(short(seconds)),
        }
    }

    /// The unknown that the duration is.
    pub(super) fn free_duration(&self) -> Option<&str> {
        let [first, last] = self.model.interval;
        let is_zero = self.model.graph.as_number(first) == Some(0.0);
        let input = |index: usize| self.model.input_of(Symbol::Free(index));
        let is_it = |index: &usize| {
            input(*index).is_some_and(|input| *self.model.graph.expr(last) == Expr::Input(input))
        };
        let index = (0..self.model.frees.len()).find(is_it).filter(|_| is_zero)?;
        Some(&self.model.frees[index].place.name)
    }
}
