//! What to differentiate by, under the names of the model.

use fdcc_compiler::{Model, closest};
use fdcc_runtime::problem::Parameter;
use fdcc_runtime::sensitivity::Quantity;
use fdcc_runtime::simulate::{Controls, System};
use std::fmt;

/// What a derivative is taken by, under one name.
///
/// ```
/// let model = fdcc::Model::from_text("slide", "time t in [0, 2]
/// param mu = 2
/// state v start 1
/// surface slip = v
/// dynamics { v' in -mu * Sgn(slip) }
/// minimize integral(v)")?;
/// let system = model.system()?;
/// let by = fdcc::by_names(&["mu", "v(start)"], &system, &fdcc::Controls::Guess, &model);
/// let by = by.expect("the model has both");
/// assert!(by.len() == 2 && by[1].name == "v(start)" && by[1].quantities.len() == 1);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct By {
    /// As it was asked for.
    pub name: String,
    /// One number; for a control, one for each row.
    pub quantities: Vec<Quantity>,
    /// Whether it is a control.
    pub is_control: bool,
}

/// Why there is no derivative by a name.
///
/// ```
/// use fdcc::{Controls, Model, NotBy, by_names};
///
/// let model = Model::from_text("coast", "time t in [0, 1]
/// control u in [-1, 1]
/// state v start 1
/// dynamics { v' = u }
/// minimize v(end)^2")?;
/// let by = by_names(&["u"], &model.system()?, &Controls::Guess, &model);
/// assert_eq!(by.err(), Some(NotBy::Guessed("u".into())));
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum NotBy {
    /// The model has no parameter, no unknown and no free start; a given start has to be named.
    Nothing,
    /// A parameter that is computed from others, and its value: [`with`](crate::Model::with) that
    /// value it is one of its own.
    Computed(String, f64),
    /// A control that follows its guess: only one that is [held](Controls::Held) has values to
    /// differentiate by.
    Guessed(String),
    /// There is nothing of that name, but what there is.
    Unknown(String),
}

impl fmt::Display for NotBy {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            NotBy::Nothing => f.write_str("there is nothing to differentiate by"),
            NotBy::Computed(name, _) => {
                write!(f, "`{name}` is computed from other parameters")
            }
            NotBy::Guessed(name) => write!(f, "`{name}` follows its guess"),
            NotBy::Unknown(why) => f.write_str(why),
        }
    }
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
///
/// # Errors
///
/// A name that is none of these.
pub fn named(
    name: &str,
    system: &System,
    controls: &Controls,
    model: &Model,
) -> Result<Vec<By>, NotBy> {
    if let Some(state) = name.strip_suffix("(start)").map(str::trim) {
        return starts(name, state, system);
    }
    let parameters = system.parameters.iter().filter(|it| !is_width(it));
    if let Some(at) = parameters.clone().position(|it| it.name == name) {
        if is_computed(name, model) {
            let value = system.parameters[at].value;
            return Err(NotBy::Computed(name.into(), value));
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
        let why = format!("`{name}` is a state; write `{name}(start)` for its start");
        return Err(NotBy::Unknown(why));
    }
    let known = parameters
        .map(|it| it.name.as_str())
        .chain(system.controls.iter().map(|it| it.name.as_str()));
    Err(NotBy::Unknown(unknown("parameter, unknown or control", name, known.collect())))
}

fn starts(name: &str, state: &str, system: &System) -> Result<Vec<By>, NotBy> {
    let shown = system.states.iter().filter(|state| !state.hidden).map(|state| state.name.as_str());
    let found = parts(state, shown.clone());
    if found.is_empty() {
        let why = format!("`{name}`: {}", unknown("state", state, shown.collect()));
        return Err(NotBy::Unknown(why));
    }
    let start =
        |at: usize| single(format!("{}(start)", system.states[at].name), Quantity::Start(at));
    Ok(found.into_iter().map(start).collect())
}

fn control(at: usize, system: &System, controls: &Controls) -> Result<By, NotBy> {
    let name = system.controls[at].name.clone();
    if *controls == Controls::Guess {
        return Err(NotBy::Guessed(name));
    }
    let rows = 0..controls.rows().len();
    let quantities = rows.map(|row| Quantity::Control { row, control: at }).collect();
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
