//! FDC0503: a smoothing width that leaves no room outside the layer.
//!
//! Where the whole motion stays inside `|psi| <= sigma`, the solver sees a linear damper and no
//! friction. Bounds of states prove it, by interval arithmetic; a guess shows it. A guess that lies
//! on the surface says nothing: it may be held.

use super::layer::short;
use super::{Preflight, Sigma};
use crate::expressions::interval::{Interval, Tape};
use crate::model::{Range, Surface, Symbol};
use crate::syntax::text::number;
use fdcc_grammar::{Code, Diagnostic};

/// A guess that goes no farther, relative to sigma, is inside the layer.
const INSIDE: f64 = 0.5;
/// A guess whose distance is so small, relative to the states in it, lies on the surface.
const HELD: f64 = 1e-2;

/// Reports the first surface that the motion does not leave the layer of.
pub(super) fn check(preflight: &Preflight<'_>, found: &mut Vec<Diagnostic>) {
    let Some(sigma) = preflight.sigma() else { return };
    for surface in &preflight.model.surfaces {
        let bound = preflight.farthest_within_bounds(surface).filter(|it| *it < sigma.width);
        let guessed =
            preflight.farthest_in_the_guess(surface).filter(|it| *it <= INSIDE * sigma.width);
        let name = &surface.place.name;
        if let Some(farthest) = bound {
            return found.push(no_room(name, (farthest, "within the bounds"), &sigma));
        }
        if let Some(farthest) = guessed {
            return found.push(no_room(name, (farthest, "in the guess"), &sigma));
        }
    }
}

impl Preflight<'_> {
    /// The largest distance from a surface that bounds allow, if they allow one only that is not 0.
    fn farthest_within_bounds(&self, surface: &Surface) -> Option<f64> {
        let bound = |id| self.numbers.value(self.model, id);
        let range = |range: Range| Interval::new(bound(range.lower), bound(range.upper));
        let domain = |symbol: &Symbol| match symbol {
            Symbol::State(at) => range(self.model.states[*at].range),
            Symbol::Time => {
                Interval::new(bound(self.model.interval[0]), bound(self.model.interval[1]))
            }
            Symbol::Param(_) => Interval::point(self.numbers.of(*symbol)),
            _ => Interval::ALL,
        };
        let domain: Vec<Interval> = self.model.symbols.iter().map(domain).collect();
        let psi = Tape::new(&self.model.graph, &[surface.psi]).evaluate(&domain)[0];
        let farthest = psi.lower.abs().max(psi.upper.abs());
        (farthest.is_finite() && psi.lower < psi.upper).then_some(farthest)
    }

    /// The largest distance along a guess that is written and leaves the surface.
    fn farthest_in_the_guess(&self, surface: &Surface) -> Option<f64> {
        if self.points.is_empty() || self.model.states.iter().all(|state| state.guess.is_none()) {
            return None;
        }
        let largest = |values: Vec<f64>| values.into_iter().map(f64::abs).fold(0.0, f64::max);
        let is_state =
            |input: &u32| matches!(self.model.symbols[*input as usize], Symbol::State(_));
        let inputs = self.model.graph.inputs_of(&[surface.psi]);
        let size =
            |input: u32| largest(self.points.iter().map(|point| point[input as usize]).collect());
        let size = inputs.into_iter().filter(is_state).map(size).fold(0.0, f64::max);
        let farthest = largest(self.along(surface.psi));
        (farthest > HELD * size).then_some(farthest)
    }
}

fn no_room(surface: &str, (farthest, of): (f64, &str), sigma: &Sigma) -> Diagnostic {
    let shown = |value: f64| number(short(value / sigma.scale));
    let unit = sigma.unit.replace(['[', ']'], "");
    let message = "`sigma` has no room: the whole run is inside the smoothed layer";
    let label = format!("{of}, abs({surface}) <= {}{unit} throughout", shown(farthest));
    let narrow = shown(farthest / 10.0);
    Diagnostic::new(Code::NoRoom, message, sigma.span, label).help(format!(
        "the solver would see a linear damper, not friction. Start with sigma = {narrow}{}.",
        sigma.unit
    ))
}
