//! Mayer objective and conditions at the ends, as one function of `[x(start), x(end) | p]`.

use super::function::{Order, VectorFunction};
use super::inputs::{Sizes, at_ends, solved_for};
use super::objective::Objective;
use super::{origin, smoothed};
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Model, Place, Range, State, Symbol};

/// A row of the function but the first.
pub(crate) struct Condition {
    value: ExprId,
    place: Place,
    /// Bounds over parameters.
    pub range: Range,
}

/// Lowers the objective's value at the ends and all conditions there.
pub(crate) fn lower(
    model: &Model,
    graph: &mut Graph,
    sizes: &Sizes,
    objective: &Objective,
) -> (VectorFunction, Vec<Condition>) {
    let written = model.boundary.iter().map(|row| Condition {
        value: row.value,
        place: row.place.clone(),
        range: row.range,
    });
    let mut conditions: Vec<Condition> = written.collect();
    for (index, state) in model.states.iter().enumerate() {
        conditions.extend(start(model, graph, index, state));
    }
    let layout = sizes.ends();
    let inputs = at_ends(model, graph, &layout, &objective.hidden);
    let outputs: Vec<ExprId> =
        std::iter::once(objective.mayer).chain(conditions.iter().map(|it| it.value)).collect();
    let outputs = inputs.apply(graph, &outputs);
    let outputs = smoothed(model, graph, &outputs, sizes, &layout);
    let origins = std::iter::once(objective.origin.clone())
        .chain(conditions.iter().map(|it| origin(&it.place)))
        .collect();
    let by = solved_for(model, &layout);
    (
        VectorFunction {
            name: "boundary".into(),
            layout,
            outputs,
            origins,
            by,
            order: Order::Second,
        },
        conditions,
    )
}

/// The row for a start that the optimiser has a say in.
fn start(model: &Model, graph: &mut Graph, index: usize, state: &State) -> Option<Condition> {
    let input = model.input_of(Symbol::AtStart(index))?;
    let at_start = graph.input(input);
    let place = Place { name: format!("start {}", state.place.name), span: state.place.span };
    match (state.start, state.start_range) {
        (Some(value), _) if !is_fixed(model, graph, value) => {
            let zero = graph.number(0.0);
            let value = graph.sub(at_start, value);
            Some(Condition { value, place, range: Range { lower: zero, upper: zero } })
        }
        (None, Some(range)) => Some(Condition { value: at_start, place, range }),
        _ => None,
    }
}

/// Whether a value is a number once the parameters are known.
pub(crate) fn is_fixed(model: &Model, graph: &Graph, value: ExprId) -> bool {
    let inputs = graph.inputs_of(&[value]);
    inputs.into_iter().all(|input| matches!(model.symbols[input as usize], Symbol::Param(_)))
}
