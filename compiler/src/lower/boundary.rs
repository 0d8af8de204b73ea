//! Mayer objective and conditions at the ends, as one function of `[x(start), x(end) | p]`.

use super::function::{Order, VectorFunction};
use super::inputs::{Sizes, at_ends, solved_for};
use super::objective::Objective;
use super::{origin, smoothed};
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Model, Place, Range, State, Sum, Symbol};

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
    if model.has_free_ends() {
        for sum in objective.sums() {
            conditions.extend(within_time(model, graph, &model.sums[sum]));
        }
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

/// All rows of a sum are within the time: the model has states nowhere else. Those that belong to
/// other phases are within the time of these.
fn within_time(model: &Model, graph: &mut Graph, sum: &Sum) -> Vec<Condition> {
    let [zero, infinity] = [0.0, f64::INFINITY].map(|it| graph.number(it));
    let times = row_times(model, graph, sum);
    let [first, last] = model.interval;
    let (mut earliest, mut latest) = (times[0], times[0]);
    for &time in &times[1..] {
        earliest = graph.min(earliest, time);
        latest = graph.max(latest, time);
    }
    let table = &model.tables[sum.table];
    let condition = |words: &str, value| Condition {
        value,
        place: Place { name: format!("{words} row of {}", table.name), span: sum.place.span },
        range: Range { lower: zero, upper: infinity },
    };
    let [before, behind] = [graph.sub(earliest, first), graph.sub(last, latest)];
    let all = [condition("first", before), condition("last", behind)].into_iter();
    let own = all.zip(sum.is_shared).filter(|it| !it.1).map(|it| it.0);
    own.filter(|it| graph.as_number(it.value).is_none()).collect()
}

/// The time of each row, over parameters.
fn row_times(model: &Model, graph: &mut Graph, sum: &Sum) -> Vec<ExprId> {
    let table = &model.tables[sum.table];
    let time = |row: usize| {
        let columns: Vec<ExprId> =
            table.columns.iter().map(|column| graph.number(column[row])).collect();
        let value = |input: u32| match model.symbols[input as usize] {
            Symbol::Column(_, column) => Some(columns[column]),
            _ => None,
        };
        graph.substitute(&[sum.time], &value)[0]
    };
    (0..table.rows()).map(time).collect()
}

/// Whether a value is a number once the parameters are known.
pub(crate) fn is_fixed(model: &Model, graph: &Graph, value: ExprId) -> bool {
    let inputs = graph.inputs_of(&[value]);
    inputs.into_iter().all(|input| matches!(model.symbols[input as usize], Symbol::Param(_)))
}
