//! What a model expects of its solution, as a function that can be evaluated once there is one.
//!
//! Inputs `[x(start), x(end) | p, integrals]`; three outputs for each expectation: left side, right side, tolerance.

use super::inputs::{self, Sizes};
use super::{Objective, objective, origin};
use crate::graph::ExprId;
use crate::model::{Comparison, Model, Symbol};
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
    /// The first of its three outputs; `None` if only a simulation can tell.
    pub output: Option<usize>,
}

/// All expectations of a model, compiled.
pub struct Expectations {
    /// In the order of the text.
    pub list: Vec<Expected>,
    /// Over `[x(start), x(end) | p, integrals]`, the states of [`Problem`](fdcc_runtime::problem::Problem) with
    /// the hidden ones; values only.
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
        let output = expectation.values.is_some().then_some(values.len());
        values.extend(expectation.values.iter().flatten());
        list.push(Expected {
            origin: origin(&expectation.place),
            comparison: expectation.comparison,
            output,
        });
    }
    let needed = objective::integrals_in(model, &graph, &values);
    let over_grid = inputs::over_grid(model, &mut graph, &sizes);
    let integrands: Vec<ExprId> = needed.iter().map(|&at| model.integrals[at].integrand).collect();
    let integrands = over_grid.apply(&mut graph, &integrands);
    let integrands = integrands.iter().map(|&it| graph.mul(over_grid.duration, it)).collect();
    let layout = Layout { p: sizes.parameters + needed.len(), ..sizes.ends() };
    let mut at_ends = inputs::at_ends(model, &mut graph, &layout, &[]);
    for (position, &at) in needed.iter().enumerate() {
        let place = graph.input((layout.parameters().end - needed.len() + position) as u32);
        at_ends.replace(model, Symbol::Integral(at), place);
    }
    let values = at_ends.apply(&mut graph, &values);
    let functions =
        [values_only("expectations", layout, values), values_only("integrands", sizes.grid(), integrands)];
    let compiled = crate::machine_code(graph, functions.to_vec());
    let [function, integrands] =
        <[_; 2]>::try_from(compiled).unwrap_or_else(|_| unreachable!("two functions were given"));
    Expectations { list, function, integrands }
}

fn values_only(name: &str, layout: Layout, outputs: Vec<ExprId>) -> VectorFunction {
    let origins = vec![Origin::default(); outputs.len()];
    VectorFunction { name: name.into(), layout, outputs, origins, by: Vec::new(), order: Order::Second }
}
