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
use crate::syntax::outer::Outer;
use crate::units::{self, NamedUnit, Units};
use fdcc_grammar::ast::{self, Assignment, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Severity, Span};
use std::collections::{HashMap, HashSet};

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
pub fn check_with(tree: &ast::Model, files: Option<&dyn Files>) -> Checked {
    check_given(tree, files, None)
}

/// The same, where signals are given from outside on so many equal intervals of time.
pub fn check_given(
    tree: &ast::Model,
    files: Option<&dyn Files>,
    intervals: Option<usize>,
) -> Checked {
    let mut unread = Vec::new();
    let tree = &*data::written_out(tree, files, &mut unread);
    let tables =
        files.map_or_else(Tables::default, |files| data::read(&tree.items, files, &mut unread));
    let mut found = check_tables(tree, &tables, intervals);
    if !unread.is_empty() {
        found.model = None;
        found.diagnostics.retain(|it| it.code != Code::NotYet);
        found.diagnostics.extend(unread);
        sort(&mut found.diagnostics);
    }
    data::told_once(tree, &mut found.diagnostics);
    found
}

fn check_tables(tree: &ast::Model, tables: &Tables, intervals: Option<usize>) -> Checked {
    let mut diagnostics = Vec::new();
    let (tree, written) = (&*written_out(tree, &mut diagnostics), tree);
    let everything: Vec<&Item> = tree.items.iter().collect();
    let phases = phases(&tree.items);
    let units = units::infer(tree);
    let mut not_yet = Vec::new();
    let mut inner = Vec::new();
    let outer = Outer::new(&tree.items);
    for phase in &phases {
        let seen = outer.seen_by(phase.name, phase.items);
        let mut part = resolve_phase(&seen, &phase.around, &units.readings, tables);
        diagnostics.extend(checked(&mut part, phase.around.items.clone(), tree, Some(phase.name)));
        not_yet.append(&mut part.not_yet);
        inner.push(Inner::new(phase.name, part));
    }
    let mut whole = resolve(&everything, inner, &units.readings, tables, intervals);
    diagnostics.extend(checked(&mut whole, everything, tree, None));
    whole.not_yet.append(&mut not_yet);
    diagnostics.extend(checks::unused(tree));
    diagnostics.extend(checks::lookalike(tree));
    diagnostics.extend(checks::twice(written, tree));
    diagnostics.extend(units.diagnostics.iter().cloned());
    sort(&mut diagnostics);
    let mut diagnostics = without_echoes(without_consequences(diagnostics));
    sort(&mut whole.not_yet);
    let model = (!diagnostics.iter().any(is_fatal)).then(|| {
        let mut model = whole.into_model();
        model.durations_as_conditions();
        model.name = tree.name.as_ref().map_or("model", |name| &name.name).into();
        model.take_units(&units, &phases);
        model
    });
    if let Some(model) = &model {
        diagnostics.extend(told_early(model));
        let parts = std::iter::once(model).chain(model.phases.iter().map(|it| &it.model));
        diagnostics.extend(parts.flat_map(|part| {
            numbers(part).map_or(Vec::new(), |numbers| part.misplaced_rows(&numbers))
        }));
        diagnostics.extend(numbers(model).iter().flat_map(|it| model.misplaced_times(it)));
        diagnostics.extend(preflight::check(model, tree));
        sort(&mut diagnostics);
    }
    Checked { model, diagnostics, units: units.names }
}

impl Model {
    /// Gives the whole and each phase the units of the names that it knows.
    fn take_units(&mut self, units: &Units, phases: &[Phase<'_>]) {
        let holding = |unit: &NamedUnit| -> Vec<usize> {
            (0..phases.len()).filter(|at| phases[*at].holds(unit.span)).collect()
        };
        let holders: Vec<Vec<usize>> = units.names.iter().map(holding).collect();
        let mut names = units.names.clone();
        for (unit, holders) in units.names.iter().zip(&holders) {
            for at in holders {
                let name = format!("{}.{}", phases[*at].name.name, unit.name);
                names.push(NamedUnit { name, ..unit.clone() });
            }
        }
        let (own, of_phases) = names.split_at(holders.len());
        for (at, part) in self.phases.iter_mut().enumerate() {
            let is_known = |(unit, holders): &(&NamedUnit, &Vec<usize>)| {
                unit.name.contains('.') || holders.is_empty() || holders.contains(&at)
            };
            let known = own.iter().zip(&holders).filter(is_known).map(|it| it.0);
            part.model.units = known.chain(of_phases).cloned().collect();
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
    let by_all = written().or_else(|| model.rows_beside_jumps());
    // Where nothing is minimised, the model may be there to be simulated.
    let by_solve = || model.jump_by_side().filter(|_| model.has_objective());
    let (mut first, help) = match by_all {
        Some(found) => (found, "`solve`, `simulate` and `grad` refuse it"),
        None if model.phases.is_empty() => {
            (by_solve()?, "`simulate` and `grad` take it, `solve` refuses it")
        }
        None => (by_solve()?, "`simulate` takes it, `solve` refuses it"),
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
    items: &'a [Item],
    /// Its block, and the items that it takes over from others.
    spans: Vec<Span>,
    around: Around<'a>,
}

impl Phase<'_> {
    fn holds(&self, place: Span) -> bool {
        self.spans.iter().any(|span| span.start <= place.start && place.end <= span.end)
    }
}

/// The phases of a text, those that are linked in the order of time.
fn phases(items: &[Item]) -> Vec<Phase<'_>> {
    let mut before: HashSet<&str> = HashSet::new();
    let mut phases = Vec::new();
    let mut into: HashMap<&str, Vec<&str>> = HashMap::new();
    let mut out_of: HashMap<&str, Vec<&[Assignment]>> = HashMap::new();
    for (from, to, assignments) in items.iter().filter_map(link) {
        into.entry(to).or_default().push(from);
        out_of.entry(from).or_default().push(assignments);
    }
    for item in in_order(items) {
        let ItemKind::Phase { name, items, .. } = &item.kind else { continue };
        let earlier = into.get(name.name.as_str()).into_iter().flatten();
        let around = Around {
            items: items.iter().collect(),
            follows: earlier.into_iter().any(|from| before.contains(from)),
            links: out_of.get(name.name.as_str()).cloned().unwrap_or_default(),
        };
        before.insert(&name.name);
        let is_taken_over =
            |it: &&Item| it.span.end < item.span.start || item.span.end < it.span.start;
        let taken_over = items.iter().filter(is_taken_over).map(|it| it.span);
        let spans = std::iter::once(item.span).chain(taken_over).collect();
        phases.push(Phase { name, items, spans, around });
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
