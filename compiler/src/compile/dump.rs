//! Any stage of a model as text, for `fdcc show`.

use super::not_yet;
use super::summary::summary;
use crate::differentiate::Differentiated;
use crate::differentiate::differentiate;
use crate::expressions::graph::{ExprId, Graph, print};
use crate::generate;
use crate::lower::VectorFunction;
use crate::lower::{LoweredProblem, lower};
use crate::model::numbers::numbers;
use crate::model::{Model, Symbol};
use fdcc_grammar::Diagnostic;
use fdcc_runtime::problem::Layout;

/// What can be shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The problem as understood: names, sizes, bounds, sparsity, surfaces.
    Summary,
    /// Every expression of the model over its symbols.
    Model,
    /// The functions that are compiled.
    Graph,
    /// With their Jacobians and Hessians.
    Derivatives,
    /// Their machine code before Cranelift's own passes.
    Clif,
}

/// One stage of a model as text.
pub fn dump(model: &Model, stage: Stage) -> Result<String, Vec<Diagnostic>> {
    if stage == Stage::Model {
        return Ok(in_si(model) + &symbols(model));
    }
    not_yet(model)?;
    let numbers = numbers(model)?;
    let lowered = lower(model);
    Ok(match stage {
        Stage::Graph => in_si(model) + &functions(model, &lowered),
        Stage::Derivatives => in_si(model) + &with_derivatives(model, &lowered),
        Stage::Clif => {
            let (graph, differentiated) = differentiated(&lowered);
            generate::clif(&graph, &differentiated)
        }
        _ => summary(model, &lowered, &numbers),
    })
}

/// What is said above formulas of a model that declares other units: their numbers have none of
/// these.
fn in_si(model: &Model) -> String {
    if model.is_in_si() { String::new() } else { "# formulas in SI\n".into() }
}

/// The name of a symbol in the model's words.
fn symbol_name(model: &Model, symbol: Symbol) -> String {
    match symbol {
        Symbol::Time => "t".into(),
        Symbol::State(index) => model.states[index].place.name.clone(),
        Symbol::Control(index) => model.controls[index].place.name.clone(),
        Symbol::Param(index) => model.params[index].place.name.clone(),
        Symbol::Free(index) => model.frees[index].place.name.clone(),
        Symbol::Selector(index) => selector_name(model, index),
        Symbol::AtStart(index) => format!("{}(start)", model.states[index].place.name),
        Symbol::AtEnd(index) => format!("{}(end)", model.states[index].place.name),
        Symbol::Integral(index) => model.integrals[index].place.name.clone(),
        Symbol::ControlAtStart(index) => format!("{}(start)", model.controls[index].place.name),
        Symbol::ControlAtEnd(index) => format!("{}(end)", model.controls[index].place.name),
        Symbol::OfPhase { phase, input } => {
            let phase = &model.phases[phase];
            let symbol = phase.model.symbols[input as usize];
            format!("{}.{}", phase.place.name, symbol_name(&phase.model, symbol))
        }
        Symbol::Sum(index) => model.sums[index].place.name.clone(),
        Symbol::Column(table, column) => format!("{}[{}]", model.tables[table].name, column + 1),
        Symbol::Simulated(_) | Symbol::Argument(_) => "_".into(),
    }
}

/// `Sgn(slip)`, `Dir(vel)[1]`.
fn selector_name(model: &Model, index: usize) -> String {
    match model.balls.iter().find(|ball| ball.surfaces.contains(&index)) {
        Some(ball) => format!("Dir({})[{}]", ball.place.name, index - ball.surfaces.start + 1),
        None => format!("Sgn({})", model.surfaces[index].place.name),
    }
}

/// Expressions over the symbols of the model.
pub(super) fn over_symbols(model: &Model, roots: &[(String, ExprId)]) -> String {
    print(&model.graph, roots, &|input| symbol_name(model, model.symbols[input as usize]))
}

/// Every expression of the model.
fn symbols(model: &Model) -> String {
    let mut roots: Vec<(String, ExprId)> =
        vec![("t0".into(), model.interval[0]), ("tf".into(), model.interval[1])];
    roots.extend(model.params.iter().filter_map(|it| Some((it.place.name.clone(), it.value?))));
    roots.extend(model.surfaces.iter().map(|it| (it.place.name.clone(), it.psi)));
    for state in &model.states {
        roots.extend(state.start.map(|start| (format!("{}(start)", state.place.name), start)));
        roots.push((state.equation.name.clone(), state.rate));
    }
    roots.extend(model.path.iter().map(|it| (format!("path {}", it.place.name), it.value)));
    let at_times = model.at_times.iter().flat_map(|it| &it.rows);
    let conditions = model.boundary.iter().chain(at_times);
    roots.extend(conditions.map(|it| (it.place.name.clone(), it.value)));
    roots
        .extend(model.integrals.iter().map(|it| (format!("d/dt {}", it.place.name), it.integrand)));
    roots.extend(model.objective.iter().map(|it| (it.0.name.clone(), it.1)));
    roots.extend(model.report.iter().map(|it| (format!("report {}", it.place.name), it.value)));
    over_symbols(model, &roots)
}

/// The names of a function's inputs.
pub(super) fn input_names(model: &Model, lowered: &LoweredProblem, layout: &Layout) -> Vec<String> {
    let hidden = lowered.hidden.iter().map(|it| it.place(model).name.clone());
    let states: Vec<String> =
        model.states.iter().map(|it| it.place.name.clone()).chain(hidden).collect();
    let mut names: Vec<String> = (0..layout.t).map(|_| "tau".into()).collect();
    names.extend(several(&states, layout.x));
    let controls: Vec<String> = model.controls.iter().map(|it| it.place.name.clone()).collect();
    names.extend(several(&controls, layout.u));
    names.extend(model.params.iter().map(|it| it.place.name.clone()));
    names.extend(model.frees.iter().map(|it| it.place.name.clone()));
    names.extend(model.switches().iter().map(|it| format!("sigma({})", it.place.name)));
    names.resize(layout.parameters().end, "sigma(abs)".into());
    let is_of_surfaces = layout.s == model.surfaces.len();
    let selector = |index: usize| match is_of_surfaces {
        true => selector_name(model, index),
        false => format!("row[{}]", index + 1),
    };
    names.extend((0..layout.s).map(selector));
    names
}

/// The names once, at both ends, or with two derivatives.
fn several(names: &[String], count: usize) -> Vec<String> {
    let suffixes: &[&str] = match count.checked_div(names.len()) {
        Some(2) => &["(start)", "(end)"],
        Some(3) => &["", "'", "''"],
        _ => &[""],
    };
    let all = suffixes.iter().flat_map(|end| names.iter().map(move |it| format!("{it}{end}")));
    all.take(count).collect()
}

fn functions(model: &Model, lowered: &LoweredProblem) -> String {
    let mut text = String::new();
    for function in std::iter::once(&lowered.flow).chain(lowered.functions()) {
        let names = input_names(model, lowered, &function.layout);
        text += &format!("# {}\n", function.name);
        text += &print(&lowered.graph, &labelled(function), &|input| names[input as usize].clone());
        text += "\n";
    }
    text
}

fn labelled(function: &VectorFunction) -> Vec<(String, ExprId)> {
    let label = |(at, id): (usize, &ExprId)| match &*function.origins[at].label {
        "" => (format!("{}[{}]", function.name, at + 1), *id),
        label => (label.to_string(), *id),
    };
    function.outputs.iter().enumerate().map(label).collect()
}

pub(super) fn differentiated(lowered: &LoweredProblem) -> (Graph, Vec<Differentiated>) {
    let mut graph = lowered.graph.clone();
    let functions = lowered.functions().into_iter().cloned().collect::<Vec<_>>();
    let functions =
        functions.into_iter().map(|function| differentiate(&mut graph, function)).collect();
    (graph, functions)
}

fn with_derivatives(model: &Model, lowered: &LoweredProblem) -> String {
    let (graph, functions) = differentiated(lowered);
    let mut text = String::new();
    for Differentiated { function, jacobian, hessian, .. } in &functions {
        let names = input_names(model, lowered, &function.layout);
        let rows: Vec<String> = labelled(function).into_iter().map(|row| row.0).collect();
        let mut roots = labelled(function);
        for (&(row, column), &id) in jacobian.0.entries.iter().zip(&jacobian.1) {
            roots.push((format!("d({})/d({})", rows[row as usize], names[column as usize]), id));
        }
        for (&(row, column), &id) in hessian.0.entries.iter().zip(&hessian.1) {
            roots
                .push((format!("d2L/d({})d({})", names[row as usize], names[column as usize]), id));
        }
        text += &format!(
            "# {}\n{}\n",
            function.name,
            print(&graph, &roots, &|input| names[input as usize].clone())
        );
    }
    text
}
