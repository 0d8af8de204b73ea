//! From syntax tree to [`Model`]: names, shapes and units, with everything that is wrong with them.
//!
//! One walk evaluates every expression straight into the graph. A mistake is told where it is and
//! gives the unknown value, from which nothing follows: so several mistakes are told at once, and
//! none because of another.

mod blend;
mod calls;
pub(crate) mod conditions;
mod context;
mod declare;
mod direction;
pub(crate) mod elaborator;
pub(crate) mod expression;
mod forms;
mod guess;
mod items;
mod jumps;
pub(crate) mod knots;
pub(crate) mod misfit;
mod operators;
pub(crate) mod order;
mod piecewise;
pub(crate) mod scope;
pub(crate) mod settings;
mod sweep;
pub(crate) mod text;
pub(crate) mod value;
pub(crate) mod walk;

use crate::model::{Model, Surface};
use crate::units::{self, Readings};
pub(crate) use blend::no_width;
pub use calls::function_names;
pub(crate) use calls::is_function;
use elaborator::Elaborator;
pub(crate) use elaborator::not_yet;
use fdcc_grammar::Diagnostic;
use fdcc_grammar::ast::Item;
use scope::Scope;

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

/// The known name that is nearest to a misspelt one, if any is near.
pub fn closest<'n>(name: &str, known: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let (length, lower) = (name.chars().count(), name.to_lowercase());
    let distance = |candidate: &'n str| {
        let resized = length.abs_diff(candidate.chars().count());
        // What differs in length alone by more is not worth a comparison: large models have
        // thousands of names.
        if candidate == name || resized > length / 3 {
            return None;
        }
        // `mun` for `muN` is nearer than `mu`.
        let folded = strsim::osa_distance(&lower, &candidate.to_lowercase());
        let exact = || strsim::osa_distance(name, candidate);
        (folded <= length / 3).then(|| ((folded, exact(), resized), candidate))
    };
    known.filter_map(distance).min_by_key(|it| it.0).map(|(_, candidate)| candidate)
}
