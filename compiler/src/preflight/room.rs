//! FDC0503: a smoothing width that leaves no room outside the layer.
//!
//! Where the whole motion stays inside `|psi| <= sigma`, the solver sees a linear damper and no
//! friction. Bounds of states prove it, by interval arithmetic, and so does how far their rates can
//! take them from their starts; a guess shows it. A guess that lies on the surface says nothing: it
//! may be held.

use super::layer::short;
use super::{Preflight, Sigma};
use crate::expressions::graph::ExprId;
use crate::expressions::interval::{Interval, Tape};
use crate::model::{Range, Surface, Symbol};
use crate::syntax::text::number;
use fdcc_grammar::{Code, Diagnostic};

/// So often what is known of one state helps to bound the next.
const ROUNDS: usize = 3;
/// A guess that goes no farther, relative to sigma, is inside the layer.
const INSIDE: f64 = 0.5;
/// A guess whose distance is so small, relative to the states in it, lies on the surface.
const HELD: f64 = 1e-2;

/// Reports the first surface that the motion does not leave the layer of.
pub(super) fn check(preflight: &Preflight<'_>, found: &mut Vec<Diagnostic>) {
    let Some(sigma) = preflight.sigma() else { return };
    let bounds = preflight.bounds();
    let reach = preflight.reach(&bounds);
    for surface in &preflight.model.surfaces {
        let is_inside = |it: &f64| *it < sigma.width;
        let bound = preflight.farthest(surface, &bounds).filter(is_inside);
        let reached = preflight.farthest(surface, &reach).filter(is_inside);
        let guessed =
            preflight.farthest_in_the_guess(surface).filter(|it| *it <= INSIDE * sigma.width);
        let name = &surface.place.name;
        if let Some(farthest) = bound {
            return found.push(no_room(name, (farthest, "within the bounds"), &sigma));
        }
        if let Some(farthest) = reached {
            let of = "as far as its rate can take it";
            return found.push(no_room(name, (farthest, of), &sigma));
        }
        if let Some(farthest) = guessed {
            return found.push(no_room(name, (farthest, "in the guess"), &sigma));
        }
    }
}

impl Preflight<'_> {
    /// The largest distance from a surface in a box, if it is not one that never changes.
    fn farthest(&self, surface: &Surface, domain: &[Interval]) -> Option<f64> {
        let psi = self.range(surface.psi, domain);
        let farthest = psi.lower.abs().max(psi.upper.abs());
        (farthest.is_finite() && psi.lower < psi.upper).then_some(farthest)
    }

    /// Where each symbol lies by its bounds.
    fn bounds(&self) -> Vec<Interval> {
        let bound = |id| self.numbers.value(self.model, id);
        let range = |range: Range| Interval::new(bound(range.lower), bound(range.upper));
        let domain = |symbol: &Symbol| match symbol {
            Symbol::State(at) => range(self.model.states[*at].range),
            Symbol::Control(at) => range(self.model.controls[*at].range),
            Symbol::Free(at) => range(self.model.frees[*at].range),
            Symbol::Time => {
                Interval::new(bound(self.model.interval[0]), bound(self.model.interval[1]))
            }
            Symbol::Param(_) => Interval::point(self.numbers.of(*symbol)),
            Symbol::Selector(_) => Interval::new(-1.0, 1.0),
            _ => Interval::ALL,
        };
        self.model.symbols.iter().map(domain).collect()
    }

    /// The same for states that no jump resets, as far as `x(0) + [0, T] x'` allows.
    fn reach(&self, bounds: &[Interval]) -> Vec<Interval> {
        let mut domain = bounds.to_vec();
        let [first, last] = self.model.interval.map(|end| self.range(end, bounds));
        let duration = Interval::new(0.0, (last + -first).upper);
        if let Some(time) = self.model.input_of(Symbol::Time) {
            domain[time as usize] = first.hull(last);
        }
        let resets: Vec<usize> =
            self.model.jumps.iter().flat_map(|jump| &jump.resets).map(|it| it.0).collect();
        for _ in 0..ROUNDS {
            for (at, state) in self.model.states.iter().enumerate() {
                let Some(input) = self.model.input_of(Symbol::State(at)) else { continue };
                let input = input as usize;
                if !resets.contains(&at) {
                    let given = state.start.map(|start| self.range(start, bounds));
                    let start = given.unwrap_or(bounds[input]);
                    let moved = start + self.range(state.rate, &domain) * duration;
                    domain[input] = domain[input].intersect(moved);
                }
            }
        }
        domain
    }

    fn range(&self, expr: ExprId, domain: &[Interval]) -> Interval {
        Tape::new(&self.model.graph, &[expr]).evaluate(domain)[0]
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
