//! The guess of states and controls over normalised time.

use super::function::{Order, VectorFunction};
use super::inputs::{Sizes, of_curve};
use super::origin;
use crate::expressions::graph::{ExprId, Graph};
use crate::model::Model;
use crate::model::guess::{ends, line, middle};
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

/// The guess of all states at the start, over the parameters alone.
pub(crate) fn at_start(model: &Model, graph: &mut Graph, sizes: &Sizes) -> Vec<ExprId> {
    let states = &lower(model, graph, sizes).outputs[..sizes.states];
    let zero = graph.number(0.0);
    let parameters: Vec<ExprId> = (0..sizes.parameters).map(|at| graph.input(at as u32)).collect();
    graph.substitute(states, &|input| {
        input.checked_sub(1).map_or(Some(zero), |at| Some(parameters[at as usize]))
    })
}
