//! From syntax tree to [`Model`]: names, shapes and units, with everything that is wrong with them.
//!
//! One walk evaluates every expression straight into the graph. A mistake is told where it is and
//! gives the unknown value, from which nothing follows: so several mistakes are told at once, and
//! none because of another.

mod chosen_bounds;
pub(crate) mod elaborator;
pub(crate) mod expressions;
mod items;
pub(crate) mod phases;

use crate::data::Tables;
use crate::model::{Begins, Model, Phase, Place, Surface};
use crate::settings::SCHEME_OF_FITS;
use crate::syntax::scope::Scope;
use crate::units::{self, Readings};
use elaborator::Elaborator;
use elaborator::phases::Inner;
use fdcc_grammar::Diagnostic;
use fdcc_grammar::ast::{Assignment, Item, ItemKind};

/// Resolves what stands outside of all phases, and reads of them what they turned out to mean.
/// Signals are what the text says, or given on so many intervals.
pub(crate) fn resolve<'a>(
    items: &[&'a Item],
    phases: Vec<Inner<'a>>,
    readings: &'a Readings,
    tables: &'a Tables,
    intervals: Option<usize>,
) -> Elaborator<'a> {
    let mut elaborator = declared(items, readings, tables);
    elaborator.intervals = intervals;
    items.iter().for_each(|item| units::unknown(item, &mut elaborator.diagnostics));
    elaborator.phases = phases;
    elaborator.declare_all();
    let is_split = !elaborator.phases.is_empty();
    let is_own = |item: &&&Item| {
        let is_of_both = matches!(item.kind, ItemKind::Guess { .. } | ItemKind::Method { .. });
        !is_split || is_of_both || !is_of_each_phase(item)
    };
    let own: Vec<&Item> = items.iter().filter(is_own).copied().collect();
    elaborator.resolve_items(&own);
    elaborator
}

/// Resolves one phase. The declarations of `outer` are known to it, and what is said there of
/// states that stand outside of all phases holds in each.
pub(crate) fn resolve_phase<'a>(
    outer: &[&'a Item],
    phase: &Around<'a>,
    readings: &'a Readings,
    tables: &'a Tables,
) -> Elaborator<'a> {
    let all: Vec<&Item> = outer.iter().chain(&phase.items).copied().collect();
    let mut elaborator = declared(&all, readings, tables);
    phase.items.iter().for_each(|item| units::unknown(item, &mut elaborator.diagnostics));
    elaborator.declare_all();
    if phase.follows {
        elaborator.begin_by_link(outer);
    }
    let shared = outer.iter().filter(|item| is_of_each_phase(item));
    let items: Vec<&Item> = shared.chain(&phase.items).copied().collect();
    elaborator.resolve_items(&items);
    phase.links.iter().for_each(|link| elaborator.hand_over(link));
    elaborator
}

/// A phase of a text with what leads into it and out of it.
pub(crate) struct Around<'a> {
    /// Its own items.
    pub items: Vec<&'a Item>,
    /// Whether a link from an earlier phase leads into it.
    pub follows: bool,
    /// The links that begin with it.
    pub links: Vec<&'a [Assignment]>,
}

fn declared<'a>(items: &[&'a Item], readings: &'a Readings, tables: &'a Tables) -> Elaborator<'a> {
    let mut diagnostics: Vec<Diagnostic> = Vec::new();
    let scope = Scope::new(items, &mut diagnostics);
    let mut elaborator = Elaborator::new(scope, readings, tables);
    elaborator.diagnostics = diagnostics;
    elaborator
}

/// What speaks of a motion: outside of all phases it speaks of that of each.
fn is_of_each_phase(item: &Item) -> bool {
    matches!(
        item.kind,
        ItemKind::Dynamics { .. }
            | ItemKind::Path { .. }
            | ItemKind::Jump { .. }
            | ItemKind::Metric { .. }
            | ItemKind::Guess { .. }
            | ItemKind::Report { .. }
            | ItemKind::Plot { .. }
            | ItemKind::Method { .. }
    )
}

impl Elaborator<'_> {
    /// The model, once nothing is wrong with it.
    pub(crate) fn into_model(mut self) -> Model {
        let zero = self.graph.number(0.0);
        // A function that is unknown for want of a feature: such a model is never lowered.
        let surface = |entry: elaborator::SurfaceEntry| Surface {
            place: entry.place,
            psi: entry.psi.unwrap_or(zero),
            begins: Begins::default(),
        };
        let surfaces: Vec<Surface> = self.surfaces.into_iter().map(surface).collect();
        let phase = |inner: Inner<'_>| Phase {
            hold_at_first: usize::MAX,
            place: Place { name: inner.name.name.clone(), span: inner.name.span },
            model: Model { name: inner.name.name.clone(), ..inner.meaning.into_model() },
        };
        let phases = self.phases.into_iter().map(phase).collect();
        let mut model = Model {
            smooth: self.model.smooth || !surfaces.is_empty(),
            surfaces,
            balls: self.balls,
            graph: self.graph,
            symbols: self.symbols,
            integrals: self.integrals,
            interval: self.interval,
            not_yet: self.not_yet,
            phases,
            ..self.model
        };
        model.bounds_as_conditions();
        phases::distribute(&mut model);
        choose_scheme(&mut model);
        model
    }
}

/// Where rows of data are added up and no scheme is written.
fn choose_scheme(model: &mut Model) {
    let adds_up = |it: &Model| !it.sums.is_empty();
    if adds_up(model) || model.phases.iter().any(|it| adds_up(&it.model)) {
        let of_phases = model.phases.iter_mut().map(|it| &mut it.model.method);
        for method in of_phases.chain([&mut model.method]).filter(|it| !it.names_scheme) {
            method.scheme = SCHEME_OF_FITS;
        }
    }
}
