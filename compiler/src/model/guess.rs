//! The guess of states and controls.
//!
//! Where the model is silent: a state runs straight from its start to its end, as far as conditions
//! such as `end x == 1` give them; a control stays in the middle of its bounds, unless they are so
//! wide that they say nothing of its size.

use super::{Model, Range, State, Symbol};
use crate::expressions::graph::{ExprId, Graph};

/// The guess of all states and controls over real time, parameters and unknowns, and the input that
/// each stands for.
pub(crate) fn over_time(
    model: &Model,
    graph: &mut Graph,
    first: f64,
    duration: f64,
) -> (Vec<ExprId>, Vec<u32>) {
    let now = match model.input_of(Symbol::Time) {
        Some(time) => graph.input(time),
        None => graph.number(first),
    };
    let start = graph.number(first);
    let passed = graph.sub(now, start);
    let tau = graph.scale(1.0 / duration, passed);
    let mut guessed = (Vec::new(), Vec::new());
    for (index, state) in model.states.iter().enumerate() {
        let value = state.guess.unwrap_or_else(|| {
            let ends = ends(model, graph, index, state);
            line(graph, tau, ends)
        });
        guessed.0.push(value);
        guessed.1.extend(model.input_of(Symbol::State(index)));
    }
    for (index, control) in model.controls.iter().enumerate() {
        guessed.0.push(
            control.guess.unwrap_or_else(|| {
                middle(graph, control.range, model.unit_size(&control.place.name))
            }),
        );
        guessed.1.extend(model.input_of(Symbol::Control(index)));
    }
    guessed
}

/// The guess of all states over the symbols of the model: as written, or straight from start to
/// end.
pub(crate) fn straight_guesses(model: &Model, graph: &mut Graph) -> Vec<ExprId> {
    // Where there is no state there may be no time.
    let Some(time) = model.input_of(Symbol::Time) else { return Vec::new() };
    let [now, first, last] = [graph.input(time), model.interval[0], model.interval[1]];
    let (passed, duration) = (graph.sub(now, first), graph.sub(last, first));
    let tau = graph.div(passed, duration);
    let mut guesses = Vec::new();
    for (index, state) in model.states.iter().enumerate() {
        guesses.push(state.guess.unwrap_or_else(|| {
            let ends = ends(model, graph, index, state);
            line(graph, tau, ends)
        }));
    }
    guesses
}

/// `a + tau (b - a)`.
pub(crate) fn line(graph: &mut Graph, tau: ExprId, [a, b]: [ExprId; 2]) -> ExprId {
    let rise = graph.sub(b, a);
    let risen = graph.mul(tau, rise);
    graph.add(a, risen)
}

/// Where a state begins and ends, as far as that is known.
pub(crate) fn ends(model: &Model, graph: &mut Graph, index: usize, state: &State) -> [ExprId; 2] {
    let start = state.start.or_else(|| fixed_by_a_row(model, graph, Symbol::AtStart(index)));
    let end = fixed_by_a_row(model, graph, Symbol::AtEnd(index));
    match (start, end) {
        (Some(start), Some(end)) => [start, end],
        (Some(only), None) | (None, Some(only)) => [only, only],
        (None, None) => {
            let unit = model.unit_size(&state.place.name);
            let middle = middle(graph, state.start_range.unwrap_or(state.range), unit);
            [middle, middle]
        }
    }
}

/// The value in a condition such as `end x == 1`.
pub(crate) fn fixed_by_a_row(model: &Model, graph: &mut Graph, symbol: Symbol) -> Option<ExprId> {
    let input = model.input_of(symbol)?;
    let symbol = graph.input(input);
    let row =
        model.boundary.iter().find(|row| row.value == symbol && row.range.lower == row.range.upper);
    row.map(|row| row.range.upper)
}

/// Bounds that are further apart than so many units are no statement about a size.
const WIDE: f64 = 1e4;

/// Where something is that only its bounds are known of: halfway between them, or one unit inside
/// them and as near to 0 as that allows where they are wide.
pub(crate) fn between(lower: f64, upper: f64, unit: f64) -> f64 {
    if upper - lower > WIDE * unit {
        0.0_f64.max(lower + unit).min(upper - unit)
    } else {
        0.5 * (lower + upper)
    }
}

/// [`between`] bounds, or as near to 0 as the only one allows.
pub(crate) fn middle(graph: &mut Graph, range: Range, unit: f64) -> ExprId {
    if let (Some(lower), Some(upper)) = (graph.as_number(range.lower), graph.as_number(range.upper))
        && (upper - lower).is_finite()
    {
        return graph.number(between(lower, upper, unit));
    }
    let infinite = |graph: &Graph, bound| graph.as_number(bound).is_some_and(f64::is_infinite);
    let zero = graph.number(0.0);
    match (infinite(graph, range.lower), infinite(graph, range.upper)) {
        (true, true) => zero,
        (false, true) => graph.max(range.lower, zero),
        (true, false) => graph.min(range.upper, zero),
        (false, false) => {
            let sum = graph.add(range.lower, range.upper);
            graph.scale(0.5, sum)
        }
    }
}
