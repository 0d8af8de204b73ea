//! What a model expects of its solution, as a function that can be evaluated once there is one.
//!
//! Inputs `[x(start), x(end) | p, integrals, simulated]`; three outputs for each expectation: left
//! side, right side, tolerance.

use super::inputs::{self, Sizes};
use super::{Objective, objective, origin};
use crate::graph::{ExprId, Graph};
use crate::model::{Comparison, Model, Simulated, Symbol};
use crate::program::{Order, VectorFunction};
use fdcc_runtime::problem::{Function, Layout, Origin};
use std::sync::Arc;

/// One expectation.
#[derive(Clone, Debug)]
pub struct Expected {
    /// The text and its place.
    pub origin: Origin,
    /// How the sides compare.
    pub comparison: Comparison,
    /// Which of [`Expectations::simulated`] it reads.
    pub simulated: Vec<usize>,
}

/// All expectations of a model, compiled.
pub struct Expectations {
    /// In the order of the text.
    pub list: Vec<Expected>,
    /// What only a simulation can tell.
    pub simulated: Vec<Simulated>,
    /// Over `[x(start), x(end) | p, integrals, simulated]`, the states of
    /// [`Problem`](fdcc_runtime::problem::Problem) with the hidden ones; values only.
    pub function: Arc<dyn Function>,
    /// The integrands over normalised time `[tau | x | u | p]`, times the duration; values only.
    pub integrands: Arc<dyn Function>,
}

/// Compiles the expectations.
pub fn expectations(model: &Model) -> Expectations {
    let mut graph = model.graph.clone();
    let Objective { hidden, .. } = objective::split(model, &mut graph);
    let sizes = Sizes::new(model, hidden.len());
    let mut list = Vec::new();
    let mut values: Vec<ExprId> = Vec::new();
    for expectation in &model.expectations {
        values.extend(expectation.values);
        list.push(Expected {
            origin: origin(&expectation.place),
            comparison: expectation.comparison,
            simulated: simulated_in(model, &graph, &expectation.values),
        });
    }
    let needed = objective::integrals_in(model, &graph, &values);
    let over_grid = inputs::over_grid(model, &mut graph, &sizes);
    let integrands: Vec<ExprId> = needed.iter().map(|&at| model.integrals[at].integrand).collect();
    let integrands = over_grid.apply(&mut graph, &integrands);
    let integrands = integrands.iter().map(|&it| graph.mul(over_grid.duration, it)).collect();
    let more = needed.len() + model.simulated.len();
    let layout = Layout { p: sizes.parameters + more, ..sizes.ends() };
    let mut at_ends = inputs::at_ends(model, &mut graph, &layout, &[]);
    let integrals = needed.iter().map(|&at| Symbol::Integral(at));
    let simulated = (0..model.simulated.len()).map(Symbol::Simulated);
    for (position, symbol) in integrals.chain(simulated).enumerate() {
        let place = graph.input((layout.parameters().end - more + position) as u32);
        at_ends.replace(model, symbol, place);
    }
    let values = at_ends.apply(&mut graph, &values);
    let functions = [
        values_only("expectations", layout, values),
        values_only("integrands", sizes.grid(), integrands),
    ];
    let compiled = crate::machine_code(graph, functions.to_vec());
    let [function, integrands] =
        <[_; 2]>::try_from(compiled).unwrap_or_else(|_| unreachable!("two functions were given"));
    Expectations { list, simulated: model.simulated.clone(), function, integrands }
}

fn simulated_in(model: &Model, graph: &Graph, roots: &[ExprId]) -> Vec<usize> {
    let inputs = graph.inputs_of(roots);
    let simulated = |input: u32| match model.symbols[input as usize] {
        Symbol::Simulated(index) => Some(index),
        _ => None,
    };
    inputs.into_iter().filter_map(simulated).collect()
}

fn values_only(name: &str, layout: Layout, outputs: Vec<ExprId>) -> VectorFunction {
    let origins = vec![Origin::default(); outputs.len()];
    VectorFunction {
        name: name.into(),
        layout,
        outputs,
        origins,
        by: Vec::new(),
        order: Order::Second,
    }
}
