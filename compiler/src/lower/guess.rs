//! The guess of states and controls over normalised time.
//!
//! Where the model is silent: a state runs straight from its start to its end, as far as conditions
//! such as `end x == 1` give them; a control stays in the middle of its bounds, unless they are so
//! wide that they say nothing of its size.

use super::inputs::{Sizes, of_curve};
use super::origin;
use crate::graph::{ExprId, Graph};
use crate::model::{Model, Range, State, Symbol};
use crate::program::{Order, VectorFunction};
use fdcc_runtime::problem::Origin;

/// Lowers all guesses; hidden states are guessed to be 0.
pub(crate) fn lower(model: &Model, graph: &mut Graph, sizes: &Sizes) -> VectorFunction {
    let layout = sizes.curve();
    let inputs = of_curve(model, graph, &layout);
    let zero = graph.number(0.0);
    let mut outputs = vec![zero; sizes.states];
    let mut origins: Vec<Origin> = model.states.iter().map(|state| origin(&state.place)).collect();
    origins.resize(sizes.states, Origin::default());
    for (index, state) in model.states.iter().enumerate() {
        outputs[index] = match state.guess {
            Some(guess) => inputs.apply(graph, &[guess])[0],
            None => {
                let ends = ends(model, graph, index, state);
                let ends = inputs.apply(graph, &ends);
                let tau = graph.input(0);
                line(graph, tau, [ends[0], ends[1]])
            }
        };
    }
    for control in &model.controls {
        let value = control
            .guess
            .unwrap_or_else(|| middle(graph, control.range, model.unit_size(&control.place.name)));
        outputs.push(inputs.apply(graph, &[value])[0]);
        origins.push(origin(&control.place));
    }
    VectorFunction {
        name: "guess".into(),
        layout,
        outputs,
        origins,
        by: Vec::new(),
        order: Order::Second,
    }
}

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

/// The guess of all states at the start, over the parameters alone.
pub(crate) fn at_start(model: &Model, graph: &mut Graph, sizes: &Sizes) -> Vec<ExprId> {
    let states = &lower(model, graph, sizes).outputs[..sizes.states];
    let zero = graph.number(0.0);
    let parameters: Vec<ExprId> = (0..sizes.parameters).map(|at| graph.input(at as u32)).collect();
    graph.substitute(states, &|input| {
        input.checked_sub(1).map_or(Some(zero), |at| Some(parameters[at as usize]))
    })
}

/// The guess of all states over the symbols of the model: as written, or straight from start to
/// end.
pub(crate) fn straight_guesses(model: &Model, graph: &mut Graph) -> Vec<ExprId> {
    let time = model.input_of(Symbol::Time).expect("time is a symbol");
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
fn line(graph: &mut Graph, tau: ExprId, [a, b]: [ExprId; 2]) -> ExprId {
    let rise = graph.sub(b, a);
    let risen = graph.mul(tau, rise);
    graph.add(a, risen)
}

/// Where a state begins and ends, as far as that is known.
fn ends(model: &Model, graph: &mut Graph, index: usize, state: &State) -> [ExprId; 2] {
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
pub(super) fn between(lower: f64, upper: f64, unit: f64) -> f64 {
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
