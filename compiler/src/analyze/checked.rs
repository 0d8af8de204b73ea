//! What a syntax tree means, and everything that is wrong with it.

use super::consequences::{sort, without_consequences, without_echoes};
use crate::check as checks;
use crate::check::Facts;
use crate::data::{self, Files, Tables};
use crate::model::Model;
use crate::model::numbers::numbers;
use crate::preflight;
use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::phases::Inner;
use crate::resolve::phases::in_order;
use crate::resolve::{Around, resolve, resolve_phase};
use crate::syntax::like::written_out;
use crate::units::{self, NamedUnit, Units};
use fdcc_grammar::ast::{self, Assignment, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Severity, Span};
use std::collections::HashSet;

/// What a syntax tree means, and what is wrong with it.
pub struct Checked {
    /// Present if there is no error, but for parameters that wait for a value and trajectories that
    /// are not unique.
    pub model: Option<Model>,
    /// In the order of the text.
    pub diagnostics: Vec<Diagnostic>,
    /// The unit of each name, if the text uses units; for hover and hints.
    pub units: Vec<NamedUnit>,
}

/// Finds out what a syntax tree means. Never fails: it reports everything that is wrong, each
/// mistake once.
pub fn check(tree: &ast::Model) -> Checked {
    check_with(tree, None)
}

/// The same with the texts of data files; without them a model with data waits for them.
pub fn check_with(tree: &ast::Model, files: Option<&Files>) -> Checked {
    let mut unread = Vec::new();
    let tables =
        files.map_or_else(Tables::new, |files| data::read(&tree.items, files, &mut unread));
    let mut found = check_tables(tree, &tables);
    if !unread.is_empty() {
        found.model = None;
        found.diagnostics.retain(|it| it.code != Code::NotYet);
        found.diagnostics.extend(unread);
        sort(&mut found.diagnostics);
    }
    found
}

fn check_tables(tree: &ast::Model, tables: &Tables) -> Checked {
    let mut diagnostics = Vec::new();
    let tree = &*written_out(tree, &mut diagnostics);
    let everything: Vec<&Item> = tree.items.iter().collect();
    let phases = phases(&tree.items);
    let units = units::infer(tree);
    let mut not_yet = Vec::new();
    let mut inner = Vec::new();
    for phase in &phases {
        let mut part = resolve_phase(&everything, &phase.around, &units.readings, tables);
        diagnostics.extend(checked(&mut part, phase.around.items.clone(), tree, Some(phase.name)));
        not_yet.append(&mut part.not_yet);
        inner.push(Inner::new(phase.name, part));
    }
    let mut whole = resolve(&everything, inner, &units.readings, tables);
    diagnostics.extend(checked(&mut whole, everything, tree, None));
    whole.not_yet.append(&mut not_yet);
    diagnostics.extend(checks::unused(tree));
    diagnostics.extend(checks::lookalike(tree));
    diagnostics.extend(units.diagnostics.iter().cloned());
    sort(&mut diagnostics);
    let mut diagnostics = without_echoes(without_consequences(diagnostics));
    sort(&mut whole.not_yet);
    let model = (!diagnostics.iter().any(is_fatal)).then(|| {
        let mut model = whole.into_model();
        model.name = tree.name.as_ref().map_or("model", |name| &name.name).into();
        model.take_units(&units, &phases);
        model
    });
    if let Some(model) = &model {
        diagnostics.extend(told_early(model));
        diagnostics.extend(numbers(model).iter().flat_map(|it| model.misplaced_rows(it)));
        diagnostics.extend(numbers(model).iter().flat_map(|it| model.misplaced_times(it)));
        diagnostics.extend(preflight::check(model, tree));
        sort(&mut diagnostics);
    }
    Checked { model, diagnostics, units: units.names }
}

impl Model {
    /// Gives the whole and each phase the units of the names that it knows.
    fn take_units(&mut self, units: &Units, phases: &[Phase<'_>]) {
        let mut names = units.names.clone();
        for unit in &units.names {
            for phase in phases.iter().filter(|phase| phase.holds(unit.span)) {
                let name = format!("{}.{}", phase.name.name, unit.name);
                names.push(NamedUnit { name, ..unit.clone() });
            }
        }
        for (phase, part) in phases.iter().zip(&mut self.phases) {
            let is_known =
                |unit: &&NamedUnit| unit.name.contains('.') || phase.knows(unit.span, phases);
            part.model.units = names.iter().filter(is_known).cloned().collect();
            part.model.width_unit.clone_from(&units.width);
            part.model.condition_units.clone_from(&units.conditions);
        }
        self.units = names;
        self.condition_units.clone_from(&units.conditions);
        self.width_unit.clone_from(&units.width);
    }
}

/// What `solve` will refuse. To `check` it is no mistake: the model is right, and waits.
fn told_early(model: &Model) -> Option<Diagnostic> {
    let written = || model.not_yet.first().cloned();
    let by_all = written().or_else(|| model.jump_in_phase()).or_else(|| model.rows_beside_jumps());
    // Where nothing is minimised, the model may be there to be simulated.
    let by_solve = || model.jump_by_side().filter(|_| model.objective.is_some());
    let (mut first, help) = match by_all {
        Some(found) => (found, "`solve`, `simulate` and `grad` refuse it"),
        None => (by_solve()?, "`simulate` and `grad` take it, `solve` refuses it"),
    };
    first.severity = Severity::Advice;
    Some(first.help(format!("it is checked all the same; {help}")))
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
    /// Its block, and the items that it takes over from others.
    spans: Vec<Span>,
    around: Around<'a>,
}

impl Phase<'_> {
    fn holds(&self, place: Span) -> bool {
        self.spans.iter().any(|span| span.start <= place.start && place.end <= span.end)
    }

    /// Whether what is declared at a place is known in this phase.
    fn knows(&self, place: Span, phases: &[Phase<'_>]) -> bool {
        self.holds(place) || !phases.iter().any(|phase| phase.holds(place))
    }
}

/// The phases of a text, those that are linked in the order of time.
fn phases(items: &[Item]) -> Vec<Phase<'_>> {
    let mut before: HashSet<&str> = HashSet::new();
    let mut phases = Vec::new();
    let links: Vec<(&str, &str, &[Assignment])> = items.iter().filter_map(link).collect();
    for item in in_order(items) {
        let ItemKind::Phase { name, items, .. } = &item.kind else { continue };
        let own = links.iter().filter(|link| link.0 == name.name).map(|link| link.2);
        let around = Around {
            items: items.iter().collect(),
            follows: links.iter().any(|link| link.1 == name.name && before.contains(link.0)),
            links: own.collect(),
        };
        before.insert(&name.name);
        let is_taken_over =
            |it: &&Item| it.span.end < item.span.start || item.span.end < it.span.start;
        let taken_over = items.iter().filter(is_taken_over).map(|it| it.span);
        let spans = std::iter::once(item.span).chain(taken_over).collect();
        phases.push(Phase { name, spans, around });
    }
    phases
}

fn link(item: &Item) -> Option<(&str, &str, &[Assignment])> {
    match &item.kind {
        ItemKind::Link { from, to, assignments, .. } => Some((&from.name, &to.name, assignments)),
        _ => None,
    }
}

fn checked<'a>(
    meaning: &mut Elaborator<'a>,
    items: Vec<&'a Item>,
    tree: &'a ast::Model,
    phase: Option<&'a ast::Ident>,
) -> Vec<Diagnostic> {
    let is_one = meaning.phases.is_empty();
    let found = checks::check(&mut Facts { items, phase, meaning, tree }, is_one);
    let mut all = std::mem::take(&mut meaning.diagnostics);
    all.extend(found);
    all
}
