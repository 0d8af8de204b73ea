//! From the syntax tree to compiled functions.

mod allow;
mod asked;
mod bidirectional;
mod blend;
pub mod builtins;
mod check;
mod described;
pub mod differentiate;
mod dump;
mod gaps;
pub mod generate;
pub mod graph;
pub mod interval;
pub mod lower;
pub mod model;
pub mod names;
mod overrides;
mod polynomial;
mod portrait;
pub mod program;
mod rehearsal;
mod repair;
mod resolve;
mod review;
pub mod smooth;
mod surfaces;
pub mod units;
mod unroll;
pub mod vocabulary;

pub use asked::check_with_objective;
use check::Facts;
use differentiate::differentiate;
pub use dump::{Stage, dump};
use fdcc_grammar::ast::{self, Item, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Label, Severity, Span};
use fdcc_runtime::problem::{ByParameters, Function, Problem};
use fdcc_runtime::simulate::System;
use graph::Graph;
pub use lower::{Expectations, Expected, Program, expectations};
use lower::{Purpose, by_parameters, lower, numbers, problem};
pub use model::Model;
pub use overrides::is_method_key;
pub use portrait::{Grid, Portrait, grid, portrait};
use program::VectorFunction;
pub use repair::repair;
use resolve::resolve;
pub use resolve::{closest, function_names};
pub use review::{Reviewed, review, review_with};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;
pub use surfaces::{Order, Smoothness, SurfaceClass, SurfaceReport};
pub use units::{NamedUnit, WidthUnit, parse_quantity};
use unroll::between_jumps;
pub use unroll::{Sequences, crossings, sequences, unrolled};

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
    diagnostics.extend(check::unused(tree));
    diagnostics.extend(check::lookalike(tree));
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
    let model_of = |(phase, part): (&Phase<'_>, resolve::elaborator::Elaborator<'_>)| Model {
        name: phase.name.name.clone(),
        units: units_in(phase),
        width_unit: units.width.clone(),
        ..part.into_model()
    };
    let phases = understood.map(model_of).collect();
    if let Some(model) = &model {
        diagnostics.extend(told_early(model));
        diagnostics.extend(rehearsal::check(model, tree));
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
    meaning: &mut resolve::elaborator::Elaborator<'a>,
    items: Vec<&'a Item>,
    tree: &'a ast::Model,
    is_phase: bool,
) -> Vec<Diagnostic> {
    let found = check::check(&mut Facts { items, meaning, tree }, is_phase);
    let mut all = std::mem::take(&mut meaning.diagnostics);
    all.extend(found);
    all
}

/// In the order of the text, each finding once.
fn sort(diagnostics: &mut Vec<Diagnostic>) {
    diagnostics.sort_by_key(|it| (it.span(), it.code));
    diagnostics.dedup_by(|a, b| (a.span(), a.code, &a.message) == (b.span(), b.code, &b.message));
}

/// A condition with another mistake in it contradicts nothing.
fn without_consequences(mut diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let is_mistake =
        |it: &&Diagnostic| it.severity == Severity::Error && it.code != Code::Contradiction;
    let mistakes: Vec<Span> = diagnostics.iter().filter(is_mistake).map(Diagnostic::span).collect();
    let follows = |it: &Diagnostic| {
        let whole = it.span();
        it.code == Code::Contradiction
            && mistakes.iter().any(|part| whole.start <= part.start && part.end <= whole.end)
    };
    diagnostics.retain(|it| !follows(it));
    diagnostics
}

/// One finding for each unknown name, wherever it is used; and what it is likely a slip for is not
/// called unused.
fn without_echoes(diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let mut kept: Vec<Diagnostic> = Vec::new();
    let mut first_use: HashMap<String, usize> = HashMap::new();
    let mut meant: HashSet<Span> = HashSet::new();
    for found in diagnostics {
        if found.code == Code::UnknownName {
            meant.extend(found.labels[1..].iter().map(|label| label.span));
            if let Some(&at) = first_use.get(&found.message) {
                kept[at].labels.push(Label { span: found.span(), text: "here too".into() });
                continue;
            }
            first_use.insert(found.message.clone(), kept.len());
        }
        kept.push(found);
    }
    kept.retain(|it| it.code != Code::Unused || !meant.contains(&it.span()));
    let twice: HashSet<String> =
        kept.iter().filter(|it| it.code == Code::DuplicateName).filter_map(quoted).collect();
    let follows = |it: &Diagnostic| {
        matches!(it.code, Code::WrongKind | Code::Unused)
            && quoted(it).is_some_and(|name| twice.contains(&name))
    };
    kept.retain(|it| !follows(it));
    kept
}

/// What is known about every surface of a model, or which parameters it waits for.
pub fn surfaces(model: &Model) -> Result<Vec<SurfaceReport>, Vec<Diagnostic>> {
    Ok(surfaces::surfaces(model, &numbers(model)?))
}

/// How smooth everything is that has a name in a model, or which parameters it waits for.
pub fn smoothness(model: &Model) -> Result<Vec<Smoothness>, Vec<Diagnostic>> {
    Ok(surfaces::smoothness(model, &numbers(model)?))
}

/// The name that a message speaks of.
fn quoted(found: &Diagnostic) -> Option<String> {
    found.message.split('`').nth(1).map(str::to_owned)
}

/// Turns a model into an optimal control problem with compiled functions; or says what cannot be
/// solved yet. Of a model with jumps it is what holds between them: [`unrolled`] makes of it one in
/// which they happen.
pub fn compile(model: &Model) -> Result<Problem, Vec<Diagnostic>> {
    not_yet(model)?;
    let model = &between_jumps(model);
    let numbers = numbers(model)?;
    let program = lower(model);
    let functions = program.functions().map(VectorFunction::clone).to_vec();
    let functions = machine_code(program.graph.clone(), functions);
    Ok(problem(model, &program, &numbers, functions))
}

/// The functions of a problem differentiated by the parameters of the model, for what its optimum
/// is worth to them.
pub fn compile_by_parameters(model: &Model) -> Result<ByParameters, Vec<Diagnostic>> {
    not_yet(model)?;
    let mut program = lower(model);
    let functions = by_parameters(model, &mut program).to_vec();
    let functions = machine_code(program.graph, functions);
    let [dynamics, path, boundary, given] =
        functions.try_into().unwrap_or_else(|_| unreachable!("there are four"));
    Ok(ByParameters { parameters: model.params.len(), dynamics, path, boundary, given })
}

/// Turns a model into the true system, for simulation; or says what cannot be simulated yet.
pub fn compile_simulation(model: &Model) -> Result<System, Vec<Diagnostic>> {
    compile_system(model, Purpose::Simulation)
}

/// The true system with all its derivatives, to the second order, for sensitivities.
pub fn compile_sensitivities(model: &Model) -> Result<System, Vec<Diagnostic>> {
    compile_system(model, Purpose::Sensitivities)
}

/// The system as a solve smooths it, without surfaces, with all its derivatives; or says that jumps
/// cannot be smoothed.
pub fn compile_smoothed(model: &Model) -> Result<System, Vec<Diagnostic>> {
    if let Some(jump) = model.jumps.first() {
        return Err(vec![resolve::not_yet(jump.place.span, "a smoothed model with jumps")]);
    }
    compile_system(model, Purpose::Smoothed)
}

fn compile_system(model: &Model, purpose: Purpose) -> Result<System, Vec<Diagnostic>> {
    not_yet(model)?;
    let numbers = numbers(model)?;
    let (graph, program) = lower::simulation(model, purpose);
    let functions = machine_code(graph, program.functions.clone());
    Ok(lower::system(model, &program, &numbers, functions))
}

/// The first construct that is understood but cannot be solved.
fn not_yet(model: &Model) -> Result<(), Vec<Diagnostic>> {
    model.not_yet.first().map_or(Ok(()), |first| Err(vec![first.clone()]))
}

/// Derivatives, then machine code.
fn machine_code(mut graph: Graph, functions: Vec<VectorFunction>) -> Vec<Arc<dyn Function>> {
    let functions =
        functions.into_iter().map(|function| differentiate(&mut graph, function)).collect();
    debug_assert_eq!(graph::verify(&graph), Ok(()));
    generate::generate(graph, functions)
}
