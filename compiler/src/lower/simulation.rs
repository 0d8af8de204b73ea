//! The functions of the true system, in real time and with selectors as inputs.
//!
//! ```text
//! flow      f(t, x, u, p, s), then the integrands      guards    psi(t, x, p)
//! resets    r(t, x, p), one block for each jump        controls  their guess over normalised time
//! objective M(x(start), x(end), p)                     interval  t0, tf
//! ```
//!
//! Every integral of the model is one more state, so the objective is a function of both ends.

use super::guess::fixed_by_a_row;
use super::inputs::{self, Inputs, Sizes};
use super::problem::{controls, parameters, states, surfaces};
use super::{Numbers, guess, origin};
use crate::graph::{ExprId, Graph};
use crate::model::{Ball, Jump, Model, Symbol};
use crate::program::VectorFunction;
use fdcc_grammar::ast::Direction;
use fdcc_runtime::problem::{Function, Layout, Origin};
use fdcc_runtime::simulate;
use std::sync::Arc;

/// The functions of a system, still expressions: flow, guards, resets, objective, guess.
pub(crate) struct Simulated {
    /// In this order.
    pub functions: Vec<VectorFunction>,
    layout: Layout,
    hidden: Vec<usize>,
}

/// Lowers a model for simulation.
pub(crate) fn simulation(model: &Model) -> (Graph, Simulated) {
    let mut graph = model.graph.clone();
    let hidden: Vec<usize> = (0..model.integrals.len()).collect();
    let sizes = Sizes::new(model, hidden.len());
    let layout = sizes.flow();
    let functions = vec![
        flow(model, &mut graph, &sizes),
        guards(model, &mut graph, &sizes),
        resets(model, &mut graph, &sizes),
        objective(model, &mut graph, &sizes, &hidden),
        guess::lower(model, &mut graph, &sizes),
    ];
    (graph, Simulated { functions, layout, hidden })
}

fn flow(model: &Model, graph: &mut Graph, sizes: &Sizes) -> VectorFunction {
    let layout = sizes.flow();
    let inputs = inputs::of_flow(model, graph, &layout);
    let rates = model.states.iter().map(|state| (state.rate, origin(&state.equation)));
    let integrals = model.integrals.iter().map(|integral| (integral.integrand, origin(&integral.place)));
    let by = layout.states().chain(layout.selectors()).collect();
    function(graph, &inputs, "flow", layout, rates.chain(integrals), by)
}

fn guards(model: &Model, graph: &mut Graph, sizes: &Sizes) -> VectorFunction {
    let layout = sizes.flow();
    let inputs = inputs::of_flow(model, graph, &layout);
    let psis = model.surfaces.iter().map(|surface| (surface.psi, origin(&surface.place)));
    let by = (0..layout.states().end).collect();
    function(graph, &inputs, "guards", layout, psis, by)
}

/// What a jump does not name stays as it is.
fn resets(model: &Model, graph: &mut Graph, sizes: &Sizes) -> VectorFunction {
    let layout = sizes.flow();
    let inputs = inputs::of_flow(model, graph, &layout);
    let same: Vec<ExprId> = layout.states().map(|at| graph.input(at as u32)).collect();
    let mut outputs = Vec::new();
    for jump in &model.jumps {
        let values: Vec<ExprId> = jump.resets.iter().map(|reset| reset.1).collect();
        let mut after = same.clone();
        for (value, reset) in inputs.apply(graph, &values).into_iter().zip(&jump.resets) {
            after[reset.0] = value;
        }
        outputs.extend(after);
    }
    let origins = model.jumps.iter().flat_map(|jump| vec![origin(&jump.place); layout.x]).collect();
    let by = (0..layout.states().end).map(|at| at as u32).collect();
    VectorFunction { name: "resets".into(), layout, outputs, origins, by }
}

fn objective(model: &Model, graph: &mut Graph, sizes: &Sizes, hidden: &[usize]) -> VectorFunction {
    let layout = sizes.ends();
    let inputs = inputs::at_ends(model, graph, &layout, hidden);
    let value = model.objective.as_ref().map(|(place, value)| (*value, origin(place)));
    function(graph, &inputs, "objective", layout, value.into_iter(), Vec::new())
}

fn function(
    graph: &mut Graph,
    inputs: &Inputs,
    name: &str,
    layout: Layout,
    outputs: impl Iterator<Item = (ExprId, Origin)>,
    by: Vec<usize>,
) -> VectorFunction {
    let (outputs, origins): (Vec<ExprId>, Vec<Origin>) = outputs.unzip();
    let outputs = inputs.apply(graph, &outputs);
    let by = by.into_iter().map(|at| at as u32).collect();
    VectorFunction { name: name.into(), layout, outputs, origins, by }
}

/// Puts together what the simulator needs. `functions` are those of [`Simulated`], compiled.
pub(crate) fn system(
    model: &Model,
    simulated: &Simulated,
    numbers: &Numbers,
    functions: Vec<Arc<dyn Function>>,
) -> simulate::System {
    let [flow, guards, resets, objective, guess]: [Arc<dyn Function>; 5] =
        functions.try_into().unwrap_or_else(|_| unreachable!("a system has five functions"));
    let first_sigma = model.params.len() + model.frees.len();
    let mut system = simulate::System {
        name: model.name.clone(),
        layout: simulated.layout,
        states: states(model, &simulated.hidden, numbers),
        controls: controls(model, numbers),
        parameters: parameters(model, simulated.layout.p, numbers),
        surfaces: surfaces(model, first_sigma),
        balls: model.balls.iter().map(ball).collect(),
        jumps: model.jumps.iter().map(|jump| lowered(model, numbers, jump)).collect(),
        interval: model.interval.map(|end| numbers.value(model, end)),
        start: Vec::new(),
        flow,
        guards,
        resets,
        objective,
        guess,
    };
    system.start = starts(model, numbers, &system);
    system
}

fn ball(ball: &Ball) -> simulate::Ball {
    simulate::Ball { name: ball.place.name.clone(), surfaces: ball.surfaces.clone() }
}

fn lowered(model: &Model, numbers: &Numbers, jump: &Jump) -> simulate::Jump {
    simulate::Jump {
        name: jump.place.name.clone(),
        origin: origin(&jump.place),
        surface: jump.surface,
        is_falling: jump.direction == Direction::Falling,
        at_most: jump.at_most.map(|limit| numbers.value(model, limit)),
        then_hold: jump.then_hold,
        resets: jump.resets.iter().map(|reset| reset.0).collect(),
    }
}

/// What is declared, else what a condition such as `start x == 1` gives, else the guess; 0 for integrals.
fn starts(model: &Model, numbers: &Numbers, system: &simulate::System) -> Vec<f64> {
    let mut graph = model.graph.clone();
    let mut starts = system.guessed(0.0);
    starts.truncate(system.layout.x);
    for (index, state) in model.states.iter().enumerate() {
        let row = || fixed_by_a_row(model, &mut graph, Symbol::AtStart(index));
        if let Some(value) = state.start.or_else(row) {
            starts[index] = numbers.value(model, value);
        }
    }
    starts
}
