//! From syntax tree to [`Model`]: names, shapes and units, with everything that is wrong with them.
//!
//! One walk evaluates every expression straight into the graph. A mistake is told where it is and
//! gives the unknown value, from which nothing follows: so several mistakes are told at once, and
//! none because of another.

pub(crate) mod elaborator;
pub(crate) mod expressions;
mod items;

use crate::model::{Model, Surface};
use crate::syntax::scope::Scope;
use crate::units::{self, Readings};
use elaborator::Elaborator;
use fdcc_grammar::Diagnostic;
use fdcc_grammar::ast::Item;

/// Resolves the items of one phase together with those around it. `items` are resolved; the
/// declarations of `outer` are known to them.
pub(crate) fn resolve<'a>(
    outer: &[&'a Item],
    items: &[&'a Item],
    readings: &'a Readings,
) -> Elaborator<'a> {
    let mut diagnostics: Vec<Diagnostic> = Vec::new();
    let all: Vec<&Item> = outer.iter().chain(items).copied().collect();
    let scope = Scope::new(&all, &mut diagnostics);
    items.iter().for_each(|item| units::unknown(item, &mut diagnostics));
    let mut elaborator = Elaborator::new(scope, readings);
    elaborator.diagnostics = diagnostics;
    elaborator.declare_all();
    elaborator.resolve_items(items);
    elaborator
}

impl Elaborator<'_> {
    /// The model, once nothing is wrong with it.
    pub(crate) fn into_model(mut self) -> Model {
        let zero = self.graph.number(0.0);
        // A function that is unknown for want of a feature: such a model is never lowered.
        let surface = |entry: elaborator::SurfaceEntry| Surface {
            place: entry.place,
            psi: entry.psi.unwrap_or(zero),
        };
        let surfaces: Vec<Surface> = self.surfaces.into_iter().map(surface).collect();
        Model {
            smooth: self.model.smooth || !surfaces.is_empty(),
            surfaces,
            balls: self.balls,
            graph: self.graph,
            symbols: self.symbols,
            integrals: self.integrals,
            interval: self.interval,
            not_yet: self.not_yet,
            ..self.model
        }
    }
}
