//! What is known about one thing that has a name, as text: for hover.
//!
//! Derivatives are exact, in the normal form and with the names of the model, as
//! for surfaces.

use super::text;
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, Graph, print};
use crate::model::numbers::{Numbers, numbers};
use crate::model::{Definition, Model, Place, Symbol};
use crate::surfaces::{Local, Order, Smoothness, View, of_expression};

/// What is known about a name.
#[derive(Clone, Debug, Default)]
pub struct SymbolInformation {
    /// Bounds and values, a line for each part: `v [m/s] in [-20, 20]`, `m = 2 kg`.
    pub values: Vec<String>,
    /// The right sides of its equations: `v' = F - mu*Sgn(slip)`.
    pub rates: Vec<String>,
    /// Its derivatives by all that it depends on: `d/dv = 2*c*v`.
    pub derivatives: Vec<String>,
    /// How smooth it is, the least smooth part of it.
    pub smoothness: Option<Smoothness>,
}

/// More derivatives than these nobody reads.
const MOST_DERIVATIVES: usize = 8;

/// What is known about a name; nothing if the model does not know it, or waits for a parameter.
pub fn symbol_information(model: &Model, name: &str) -> Option<SymbolInformation> {
    let numbers = numbers(model).ok()?;
    let mut information = SymbolInformation::default();
    declared(model, &numbers, name, &mut information);
    let defined = model.definitions.iter().find(|it| it.name == name).cloned();
    if let Some(definition) = defined.or_else(|| reported(model, name)) {
        look_at(model, &numbers, &definition, &mut information);
    }
    let is_known = !information.values.is_empty()
        || !information.derivatives.is_empty()
        || information.smoothness.is_some();
    is_known.then_some(information)
}

/// Whether a name is that of a vector or of one of its parts.
fn is_of(part: &str, name: &str) -> bool {
    part == name || part.strip_prefix(name).is_some_and(|rest| rest.starts_with(['.', '[']))
}

/// States, controls, unknowns and parameters.
fn declared(model: &Model, numbers: &Numbers, name: &str, information: &mut SymbolInformation) {
    let view = View::of_model(model, numbers);
    for state in model.states.iter().filter(|it| is_of(&it.place.name, name)) {
        information.values.push(text::ranged(model, numbers, &state.place, state.range));
        let mut local = Local::empty();
        let rate = local.import(&view, state.rate);
        information.rates.extend(
            local.text(&view, rate).map(|text| format!("{} = {text}", state.equation.name)),
        );
    }
    for control in model.controls.iter().filter(|it| is_of(&it.place.name, name)) {
        information.values.push(text::ranged(model, numbers, &control.place, control.range));
    }
    let at = |places: &[&Place]| places.iter().position(|place| place.name == name);
    let frees: Vec<&Place> = model.frees.iter().map(|it| &it.place).collect();
    let params: Vec<&Place> = model.params.iter().map(|it| &it.place).collect();
    information.values.extend(at(&frees).map(|at| text::free(model, numbers, at)));
    information.values.extend(at(&params).map(|at| text::param(model, numbers, at)));
}

fn reported(model: &Model, name: &str) -> Option<Definition> {
    let parts: Vec<ExprId> =
        model.report.iter().filter(|it| is_of(&it.place.name, name)).map(|it| it.value).collect();
    (!parts.is_empty()).then(|| Definition { name: name.into(), arguments: Vec::new(), parts })
}

/// The value of what is a number, the smoothness and the derivatives of what is none.
fn look_at(
    model: &Model,
    numbers: &Numbers,
    definition: &Definition,
    information: &mut SymbolInformation,
) {
    let view = View { arguments: &definition.arguments, ..View::of_model(model, numbers) };
    let fixed: Vec<f64> = definition.parts.iter().map(|part| view.number(*part)).collect();
    if definition.arguments.is_empty()
        && !fixed.is_empty()
        && fixed.iter().all(|value| value.is_finite())
    {
        let named = |(at, value): (usize, &f64)| match fixed.len() {
            1 => model.valued(&definition.name, *value),
            _ => model.valued(&format!("{}[{}]", definition.name, at + 1), *value),
        };
        information.values.extend(fixed.iter().enumerate().map(named));
        return;
    }
    let orders = definition.parts.iter().map(|part| of_expression(&view, &definition.name, *part));
    information.smoothness = orders.min_by_key(|it| it.order).map(|mut it| {
        it.knots.iter_mut().for_each(|knot| *knot = text::place(model, knot));
        it
    });
    if information.smoothness.as_ref().is_some_and(|it| it.order == Order::Jumps) {
        return;
    }
    information.derivatives = derivatives(&view, &definition.parts);
}

/// `d/dv = 2*c*v` by everything that may vary; of a vector all components together.
fn derivatives(view: &View<'_>, parts: &[ExprId]) -> Vec<String> {
    let mut local = Local::empty();
    let roots: Vec<ExprId> = parts.iter().map(|part| local.import(view, *part)).collect();
    let varies = |symbol: &Symbol| !matches!(symbol, Symbol::Param(_) | Symbol::Selector(_));
    let inputs: Vec<u32> =
        (0..local.symbols.len() as u32).filter(|at| varies(&local.symbols[*at as usize])).collect();
    let mut lines = Vec::new();
    for input in inputs.into_iter().take(MOST_DERIVATIVES) {
        let slopes: Vec<ExprId> =
            roots.iter().map(|root| slope(&mut local.graph, *root, input)).collect();
        let texts: Option<Vec<String>> =
            slopes.into_iter().map(|slope| written(&mut local, view, slope)).collect();
        let name = by(view, local.symbols[input as usize]);
        lines.push(match texts {
            Some(texts) if texts.len() == 1 => format!("d/d{name} = {}", texts[0]),
            Some(texts) => format!("d/d{name} = ({})", texts.join(", ")),
            None => format!("d/d{name} = ..."),
        });
    }
    lines
}

/// The derivative off the knots: piece by piece.
fn slope(graph: &mut Graph, expr: ExprId, input: u32) -> ExprId {
    match *graph.operands(expr) {
        [a, b, x, y] if graph.as_call(expr, Builtin::SelectLe).is_some() => {
            let [x, y] = [x, y].map(|piece| slope(graph, piece, input));
            graph.select_le(a, b, x, y)
        }
        _ => derivative(graph, expr, input),
    }
}

/// In the normal form, but for what is chosen piece by piece.
fn written(local: &mut Local, view: &View<'_>, expr: ExprId) -> Option<String> {
    let is_choice = |id: &ExprId| local.graph.as_call(*id, Builtin::SelectLe).is_some();
    if !local.graph.reachable(&[expr]).iter().any(is_choice) {
        return local.text(view, expr);
    }
    let name = |input: u32| view.name(local.symbols[input as usize]);
    let text = print(&local.graph, &[(String::new(), expr)], &name);
    let text = text.strip_prefix(" = ")?.trim_end();
    (!text.contains('\n')).then(|| text.to_owned())
}

fn by(view: &View<'_>, symbol: Symbol) -> String {
    match symbol {
        Symbol::AtStart(at) => format!("{}(start)", view.states[at].place.name),
        Symbol::AtEnd(at) => format!("{}(end)", view.states[at].place.name),
        _ => view.name(symbol),
    }
}
