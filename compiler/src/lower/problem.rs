//! A [`Problem`]: compiled functions with the names, bounds and numbers of the model.

use super::boundary::is_fixed;
use super::by_parameters::{has_kinks, is_autonomous, last_time};
use super::objective::Hidden;
use super::{LoweredProblem, origin};
use crate::model::guess::fixed_by_a_row;
use crate::model::numbers::Numbers;
use crate::model::{Model, Place, Switch, Symbol};
use fdcc_runtime::problem::{
    Bounds, Function, Layout, Method, Origin, Parameter, Problem, StartGuess, Surface, Unknown,
    Variable,
};
use std::sync::Arc;

/// Puts together what the runtime needs. `functions` are those of [`LoweredProblem::functions`],
/// compiled: seven, then one for each sum over rows.
pub fn problem(
    model: &Model,
    lowered: &LoweredProblem,
    numbers: &Numbers,
    functions: Vec<Arc<dyn Function>>,
) -> Problem {
    let Some((first, terms)) = functions.split_first_chunk::<7>() else {
        unreachable!("a problem has seven functions at least")
    };
    let [dynamics, path, boundary, guess, interval, switching, report] = first.clone();
    let measurements = lowered.measured.iter().zip(terms);
    let measurements = measurements.map(|(it, term)| it.with_rows(model, numbers, term));
    let parameters = parameters(model, lowered.flow.layout.p, numbers);
    let first_sigma = model.params.len() + model.frees.len();
    let layout: Layout = lowered.flow.layout;
    Problem {
        name: model.name.clone(),
        layout,
        states: states(model, &lowered.hidden, numbers),
        controls: controls(model, numbers),
        unknowns: unknowns(model, numbers),
        surfaces: switches(model, first_sigma),
        parameters,
        dynamics,
        running_cost: lowered.running_cost,
        path,
        path_bounds: model.path.iter().map(|row| numbers.bounds(model, row.range)).collect(),
        half_open: model.half_open.clone(),
        boundary,
        boundary_bounds: lowered
            .boundary_rows
            .iter()
            .map(|row| row_bounds(lowered, numbers, model, row))
            .collect(),
        sense: model.sense,
        has_objective: model.objective.is_some(),
        start: starts(model, lowered, numbers),
        start_guesses: start_guesses(model, lowered.hidden.len()),
        guess,
        interval,
        switching,
        is_autonomous: is_autonomous(lowered) && lowered.measured.is_empty(),
        has_kinks: has_kinks(lowered),
        last_time: last_time(model, lowered).filter(|_| lowered.measured.is_empty()),
        measurements: measurements.collect(),
        report_names: model.report.iter().map(|report| report.place.name.clone()).collect(),
        report,
        method: model.method.clone(),
    }
}

/// Start rows were made after the model, so their bounds may be numbers of the graph of the lowered
/// problem alone.
fn row_bounds(
    lowered: &LoweredProblem,
    numbers: &Numbers,
    model: &Model,
    row: &super::boundary::Condition,
) -> Bounds {
    let value = |id| lowered.graph.as_number(id).unwrap_or_else(|| numbers.value(model, id));
    Bounds { lower: value(row.range.lower), upper: value(row.range.upper) }
}

/// The states of the model, then the integrals `hidden`.
pub(super) fn states(model: &Model, hidden: &[Hidden], numbers: &Numbers) -> Vec<Variable> {
    let declared = model.states.iter().map(|state| Variable {
        name: state.place.name.clone(),
        bounds: numbers.bounds(model, state.range),
        unit: model.unit_size(&state.place.name),
        origin: origin(&state.place),
        hidden: false,
    });
    let hidden = hidden.iter().map(|it| it.place(model)).map(|place| Variable {
        name: place.name.clone(),
        bounds: Bounds::FREE,
        unit: 1.0,
        origin: origin(place),
        hidden: true,
    });
    declared.chain(hidden).collect()
}

pub(super) fn controls(model: &Model, numbers: &Numbers) -> Vec<Variable> {
    let variable = |control: &crate::model::Control| Variable {
        name: control.place.name.clone(),
        bounds: numbers.bounds(model, control.range),
        unit: model.unit_size(&control.place.name),
        origin: origin(&control.place),
        hidden: false,
    };
    model.controls.iter().map(variable).collect()
}

pub(super) fn parameters(model: &Model, count: usize, numbers: &Numbers) -> Vec<Parameter> {
    let parameter = |place: &Place, symbol| Parameter {
        name: place.name.clone(),
        value: numbers.of(symbol),
        unit: model.unit_size(&place.name),
        origin: origin(place),
    };
    let params =
        model.params.iter().enumerate().map(|(at, it)| parameter(&it.place, Symbol::Param(at)));
    let frees =
        model.frees.iter().enumerate().map(|(at, it)| parameter(&it.place, Symbol::Free(at)));
    let mut all: Vec<Parameter> = params.chain(frees).collect();
    let width = width(&model.method);
    for switch in model.switches() {
        let name = format!("sigma({})", switch.place.name);
        let unit = model.unit_size(&switch.place.name);
        all.push(Parameter { name, value: width, unit, origin: origin(switch.place) });
    }
    if all.len() < count {
        let (name, origin) = ("sigma(abs)".into(), Origin::default());
        all.push(Parameter { name, value: width, unit: 1.0, origin });
    }
    all
}

/// The width that the method names; the runtime may choose another for surfaces.
fn width(method: &Method) -> f64 {
    method.sigma.or(method.continuation.last().copied()).unwrap_or(1.0)
}

pub(crate) fn unknowns(model: &Model, numbers: &Numbers) -> Vec<Unknown> {
    let unknown = |(at, free): (usize, &crate::model::Free)| Unknown {
        parameter: model.params.len() + at,
        bounds: numbers.bounds(model, free.range),
    };
    model.frees.iter().enumerate().map(unknown).collect()
}

/// What has a width: each surface, and each `Dir` as a whole.
fn switches(model: &Model, first_sigma: usize) -> Vec<Surface> {
    let surface = |(at, switch): (usize, Switch)| Surface {
        name: switch.place.name.clone(),
        origin: origin(switch.place),
        sigma: first_sigma + at,
    };
    model.switches().into_iter().enumerate().map(surface).collect()
}

/// Every surface, also those that are the components of a `Dir`.
pub(super) fn surfaces(model: &Model, first_sigma: usize) -> Vec<Surface> {
    let switches = model.switches().into_iter().enumerate();
    let each = switches.flat_map(|(at, switch)| switch.surfaces.map(move |surface| (surface, at)));
    let surface = |(surface, at): (usize, usize)| Surface {
        name: model.surfaces[surface].place.name.clone(),
        origin: origin(&model.surfaces[surface].place),
        sigma: first_sigma + at,
    };
    each.map(surface).collect()
}

fn start_guesses(model: &Model, hidden: usize) -> Vec<StartGuess> {
    let mut graph = model.graph.clone();
    let mut of = |(index, state): (usize, &crate::model::State)| {
        let mut is_given = |symbol| fixed_by_a_row(model, &mut graph, symbol).is_some();
        let is_known = state.guess.is_some() || state.start.is_some();
        if is_known || is_given(Symbol::AtStart(index)) {
            StartGuess::Known
        } else if is_given(Symbol::AtEnd(index)) {
            StartGuess::BeforeEnd
        } else {
            StartGuess::Unknown
        }
    };
    let declared: Vec<StartGuess> = model.states.iter().enumerate().map(&mut of).collect();
    declared.into_iter().chain(vec![StartGuess::Known; hidden]).collect()
}

fn starts(model: &Model, lowered: &LoweredProblem, numbers: &Numbers) -> Vec<Option<f64>> {
    let fixed = |state: &crate::model::State| {
        let start = state.start.filter(|&start| is_fixed(model, &lowered.graph, start))?;
        Some(numbers.value(model, start))
    };
    let declared = model.states.iter().map(fixed);
    declared.chain(lowered.hidden.iter().map(|_| Some(0.0))).collect()
}
