//! What a syntax tree means, and everything that is wrong with it.

use super::consequences::{sort, without_consequences, without_echoes};
use crate::check as checks;
use crate::check::Facts;
use crate::model::Model;
use crate::preflight;
use crate::resolve::elaborator::Elaborator;
use crate::resolve::resolve;
use crate::units::{self, NamedUnit};
use fdcc_grammar::ast::{self, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Severity, Span};

/// What a syntax tree means, and what is wrong with it.
pub struct Checked {
    /// Present if there is no error, but for parameters that wait for a value and trajectories that
    /// are not unique.
    pub model: Option<Model>,
    /// Each phase by itself, with what stands outside of all phases, if there is a model.
    pub phases: Vec<Model>,
    /// In the order of the text.
    pub diagnostics: Vec<Diagnostic>,
    /// The unit of each name, if the text uses units; for hover and hints.
    pub units: Vec<NamedUnit>,
}

/// Finds out what a syntax tree means. Never fails: it reports everything that is wrong, each
/// mistake once.
pub fn check(tree: &ast::Model) -> Checked {
    let everything: Vec<&Item> = tree.items.iter().collect();
    let phases: Vec<Phase<'_>> = tree.items.iter().filter_map(phase).collect();
    let units = units::infer(tree);
    let mut whole = resolve(&[], &everything, &units.readings);
    let mut diagnostics = checked(&mut whole, everything.clone(), tree, phases.is_empty());
    let mut parts = Vec::new();
    for Phase { name, items, .. } in &phases {
        let items: Vec<&Item> = items.iter().collect();
        let mut part = resolve(&everything, &items, &units.readings);
        diagnostics.extend(checked(&mut part, items, tree, true));
        whole.not_yet(name.span, "a model with phases");
        whole.not_yet.append(&mut part.not_yet);
        // Each phase knows the names of all, and there may be many.
        (part.values, part.scope) = Default::default();
        parts.push(part);
    }
    diagnostics.extend(checks::unused(tree));
    diagnostics.extend(checks::lookalike(tree));
    diagnostics.extend(units.diagnostics.iter().cloned());
    sort(&mut diagnostics);
    let mut diagnostics = without_echoes(without_consequences(diagnostics));
    sort(&mut whole.not_yet);
    let name = tree.name.as_ref().map_or("model", |name| &name.name);
    let model = (!diagnostics.iter().any(is_fatal)).then(|| Model {
        name: name.into(),
        units: units.names.clone(),
        condition_units: units.conditions.clone(),
        width_unit: units.width.clone(),
        ..whole.into_model()
    });
    let understood = phases.iter().zip(parts).filter(|_| model.is_some());
    let units_in = |phase: &Phase<'_>| {
        units.names.iter().filter(|unit| phase.knows(unit.span, &phases)).cloned().collect()
    };
    let model_of = |(phase, part): (&Phase<'_>, Elaborator<'_>)| Model {
        name: phase.name.name.clone(),
        units: units_in(phase),
        width_unit: units.width.clone(),
        ..part.into_model()
    };
    let phases = understood.map(model_of).collect();
    if let Some(model) = &model {
        diagnostics.extend(told_early(model));
        diagnostics.extend(preflight::check(model, tree));
        sort(&mut diagnostics);
    }
    Checked { model, phases, diagnostics, units: units.names }
}

/// What `solve` will refuse. To `check` it is no mistake: the model is right, and waits.
fn told_early(model: &Model) -> Option<Diagnostic> {
    let mut first = model.not_yet.first()?.clone();
    first.severity = Severity::Advice;
    Some(first.help("it is checked all the same; `solve`, `simulate` and `grad` refuse it"))
}

/// Whether there can be no meaning. What waits for a value, what has no unique trajectory and what
/// has none has one: a run tells more.
fn is_fatal(found: &Diagnostic) -> bool {
    let has_meaning = matches!(
        found.code,
        Code::NoValue | Code::Repelling | Code::EndlessJumps | Code::Contradiction
    );
    found.severity == Severity::Error && !has_meaning
}

/// A phase of a tree.
struct Phase<'a> {
    name: &'a ast::Ident,
    items: &'a [Item],
    span: Span,
}

impl Phase<'_> {
    fn holds(&self, place: Span) -> bool {
        self.span.start <= place.start && place.end <= self.span.end
    }

    /// Whether what is declared at a place is known in this phase.
    fn knows(&self, place: Span, phases: &[Phase<'_>]) -> bool {
        self.holds(place) || !phases.iter().any(|phase| phase.holds(place))
    }
}

fn phase(item: &Item) -> Option<Phase<'_>> {
    match &item.kind {
        ItemKind::Phase { name, items } => Some(Phase { name, items, span: item.span }),
        _ => None,
    }
}

fn checked<'a>(
    meaning: &mut Elaborator<'a>,
    items: Vec<&'a Item>,
    tree: &'a ast::Model,
    is_phase: bool,
) -> Vec<Diagnostic> {
    let found = checks::check(&mut Facts { items, meaning, tree }, is_phase);
    let mut all = std::mem::take(&mut meaning.diagnostics);
    all.extend(found);
    all
}
