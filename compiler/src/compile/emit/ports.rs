//! The inputs and outputs of functions in the words of the model.

use crate::generate::c::{Argument, Part};
use crate::lower::{LoweredLink, LoweredProblem, VectorFunction};
use crate::model::Model;
use fdcc_runtime::problem::{End, Layout};
use std::ops::Range;

/// Where there is no second range of positions.
const NONE: Range<usize> = 0..0;

/// The inputs of a function of one phase; `names` are those of all of them.
pub(super) fn arguments(
    function: &VectorFunction,
    names: &[String],
    model: &Model,
) -> Vec<Argument> {
    let layout = &function.layout;
    let states = layout.states();
    let mut all = vec![("t", [0..layout.t, NONE])];
    if function.name == "boundary" {
        let middle = states.start + states.len() / 2;
        all.extend([("x0", [states.start..middle, NONE]), ("xf", [middle..states.end, NONE])]);
    } else {
        all.push(("x", [states, NONE]));
    }
    all.push(("u", [layout.controls(), NONE]));
    all.extend(of_parameters(layout, model));
    all.push(("row", [layout.selectors(), NONE]));
    let argument = |(name, positions): (&str, [Range<usize>; 2])| {
        let labels = positions.iter().flat_map(|it| names[it.clone()].to_vec()).collect();
        argument(function, name.into(), positions, labels)
    };
    all.into_iter().map(argument).filter(|it| !it.labels.is_empty()).collect()
}

/// Unknowns; parameters with the widths behind them.
fn of_parameters(layout: &Layout, model: &Model) -> [(&'static str, [Range<usize>; 2]); 2] {
    let parameters = layout.parameters();
    let first = parameters.start + model.params.len();
    let last = first + model.frees.len();
    [("q", [first..last, NONE]), ("p", [parameters.start..first, last..parameters.end])]
}

fn argument(
    function: &VectorFunction,
    name: String,
    positions: [Range<usize>; 2],
    labels: Vec<String>,
) -> Argument {
    let is_by = |position: usize| function.by.contains(&(position as u32));
    let is_active = positions.iter().any(|it| it.clone().any(is_by));
    Argument { name, positions, is_active, labels }
}

/// The outputs of a function of one phase.
pub(super) fn results(function: &VectorFunction, lowered: &LoweredProblem) -> Vec<Part> {
    let count = function.outputs.len();
    match function.name.as_str() {
        "dynamics" => {
            let rates = count - usize::from(lowered.running_cost);
            let cost = part(function, "cost", rates..count);
            [part(function, "rate", 0..rates), cost].into_iter().filter(has_rows).collect()
        }
        "boundary" => cost_and_conditions(function),
        "path" => vec![part(function, "g", 0..count)],
        _ => vec![part(function, "value", 0..count)],
    }
}

/// Those of a function of ends.
pub(super) fn cost_and_conditions(function: &VectorFunction) -> Vec<Part> {
    let conditions = part(function, "g", 1..function.outputs.len());
    [part(function, "cost", 0..1), conditions].into_iter().filter(has_rows).collect()
}

fn has_rows(part: &Part) -> bool {
    !part.rows.is_empty()
}

fn part(function: &VectorFunction, name: &str, rows: Range<usize>) -> Part {
    let labels = function.origins[rows.clone()].iter().map(|it| it.label.to_string());
    let labels = labels.filter(|_| name != "cost").collect();
    Part { name: name.into(), rows, labels }
}

/// The inputs of a link: states and controls of each end that it sees, unknowns, parameters.
pub(super) fn of_ends(
    model: &Model,
    (phases, phase_names): (&[LoweredProblem], &[String]),
    link: &LoweredLink,
) -> Vec<Argument> {
    let function = &link.function;
    let mut all = Vec::new();
    let mut first = 0;
    for end in &link.ends {
        let labels = names_of_end(model, phases, *end);
        let phase = &phase_names[end.phase()];
        let name = match end {
            End::First(_) => format!("start_of_{phase}"),
            End::Last(_) => format!("end_of_{phase}"),
        };
        let positions = first..first + labels.len();
        first = positions.end;
        all.push(argument(function, name, [positions, NONE], labels));
    }
    let params = model.params.iter().map(|it| it.place.name.clone()).collect();
    let frees = model.frees.iter().map(|it| it.place.name.clone()).collect();
    let others = of_parameters(&function.layout, model).into_iter().zip([frees, params]);
    for ((name, positions), labels) in others {
        all.push(argument(function, name.into(), positions, labels));
    }
    all.retain(|it| !it.labels.is_empty());
    all
}

/// States, hidden ones included, then controls.
fn names_of_end(model: &Model, phases: &[LoweredProblem], end: End) -> Vec<String> {
    let own = &model.phases[end.phase()].model;
    let states = own.states.iter().map(|it| it.place.name.clone());
    let hidden = phases[end.phase()].hidden.iter().map(|it| it.place(own).name.clone());
    let controls = own.controls.iter().map(|it| it.place.name.clone());
    states.chain(hidden).chain(controls).collect()
}
