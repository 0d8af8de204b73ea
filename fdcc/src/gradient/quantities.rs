//! What to differentiate by, under the names of the model.

use fdcc_compiler::{Model, closest};
use fdcc_runtime::problem::Parameter;
use fdcc_runtime::sensitivity::Quantity;
use fdcc_runtime::simulate::{Controls, System};

/// What a derivative is taken by, under one name.
#[derive(Clone, Debug)]
pub struct By {
    /// As it was asked for.
    pub name: String,
    /// One number; for a control, one for each row.
    pub quantities: Vec<Quantity>,
    /// Whether it is a control.
    pub is_control: bool,
}

/// Everything that a model can be differentiated by on its own: parameters, unknowns, starts that
/// are free.
pub fn everything(system: &System, model: &Model) -> Vec<By> {
    let is_own = |it: &Parameter| !is_width(it) && !is_computed(&it.name, model);
    let parameters = system.parameters.iter().enumerate().filter(|(_, it)| is_own(it));
    let parameters = parameters.map(|(at, it)| single(it.name.clone(), Quantity::Parameter(at)));
    let open = model.states.iter().enumerate().filter(|(_, state)| state.start_range.is_some());
    let open =
        open.map(|(at, state)| single(format!("{}(start)", state.place.name), Quantity::Start(at)));
    parameters.chain(open).collect()
}

/// What a name asks for: `mu`, `x(start)`, all parts of `pos(start)`, or a control.
pub fn named(
    name: &str,
    system: &System,
    controls: &Controls,
    model: &Model,
) -> Result<Vec<By>, String> {
    if let Some(state) = name.strip_suffix("(start)").map(str::trim) {
        return starts(name, state, system);
    }
    let parameters = system.parameters.iter().filter(|it| !is_width(it));
    if let Some(at) = parameters.clone().position(|it| it.name == name) {
        if is_computed(name, model) {
            let value = system.parameters[at].value;
            return Err(format!(
                "`{name}` is computed from other parameters; `--set {name}={value}` makes it one \
                 of its own"
            ));
        }
        return Ok(vec![single(name.into(), Quantity::Parameter(at))]);
    }
    let parts = parts(name, system.controls.iter().map(|control| control.name.as_str()));
    if !parts.is_empty() {
        return parts.into_iter().map(|at| control(at, system, controls)).collect();
    }
    let is_state = |state: &str| {
        state == name || state.strip_prefix(name).is_some_and(|rest| rest.starts_with('.'))
    };
    if system.states.iter().any(|state| is_state(&state.name)) {
        return Err(format!("`{name}` is a state; write `{name}(start)` for its start"));
    }
    let known = parameters
        .map(|it| it.name.as_str())
        .chain(system.controls.iter().map(|it| it.name.as_str()));
    Err(unknown("parameter, unknown or control", name, known.collect()))
}

fn starts(name: &str, state: &str, system: &System) -> Result<Vec<By>, String> {
    let shown = system.states.iter().filter(|state| !state.hidden).map(|state| state.name.as_str());
    let found = parts(state, shown.clone());
    if found.is_empty() {
        return Err(format!("`{name}`: {}", unknown("state", state, shown.collect())));
    }
    let start =
        |at: usize| single(format!("{}(start)", system.states[at].name), Quantity::Start(at));
    Ok(found.into_iter().map(start).collect())
}

fn control(at: usize, system: &System, controls: &Controls) -> Result<By, String> {
    let name = system.controls[at].name.clone();
    let Controls::Held { rows, .. } = controls else {
        return Err(format!(
            "`{name}` follows its guess; `--control FILE` gives it values to differentiate by"
        ));
    };
    let quantities = (0..rows.len()).map(|row| Quantity::Control { row, control: at }).collect();
    Ok(By { name, quantities, is_control: true })
}

/// The places of a name, or of all parts of a vector of that name.
fn parts<'n>(name: &str, names: impl Iterator<Item = &'n str>) -> Vec<usize> {
    let fits = |other: &str| {
        other.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    names.enumerate().filter(|(_, other)| fits(other)).map(|(at, _)| at).collect()
}

fn unknown(what: &str, name: &str, known: Vec<&str>) -> String {
    match closest(name, known.iter().copied()) {
        Some(near) => format!("there is no {what} `{name}`; did you mean `{near}`?"),
        None if known.is_empty() => format!("there is no {what} `{name}`; the model has none"),
        None => format!("there is no {what} `{name}`; there is {}", known.join(", ")),
    }
}

fn single(name: String, quantity: Quantity) -> By {
    By { name, quantities: vec![quantity], is_control: false }
}

/// Whether the formula of a parameter stands wherever the parameter does, so that nothing depends
/// on the parameter itself.
pub fn is_computed(name: &str, model: &Model) -> bool {
    let value =
        model.params.iter().find(|param| param.place.name == name).and_then(|param| param.value);
    value.is_some_and(|value| model.graph.as_number(value).is_none())
}

/// Smoothing widths stand behind the parameters and unknowns.
fn is_width(parameter: &Parameter) -> bool {
    parameter.name.starts_with("sigma(")
}
