//! Parameters that are computed from others, written out: `param N = m*g` makes `dJ/dm` see `N`.
//!
//! A solve needs no derivatives by parameters, so only the functions for sensitivities are treated.

use super::function::VectorFunction;
use super::inputs;
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Model, Symbol};
use std::collections::HashMap;

/// Replaces computed parameters in a function by what they are computed from.
pub(super) fn write_out(model: &Model, graph: &mut Graph, function: &mut VectorFunction) {
    let first = function.layout.parameters().start;
    let inputs = inputs::of_parameters(model, graph, &function.layout);
    let mut derived: HashMap<u32, ExprId> = HashMap::new();
    for &index in &model.param_order {
        let Some(value) =
            model.params[index].value.filter(|&value| is_computed(model, graph, value))
        else {
            continue;
        };
        let value = inputs.apply(graph, &[value]);
        let written = graph.substitute(&value, &|input| derived.get(&input).copied())[0];
        derived.insert((first + index) as u32, written);
    }
    if !derived.is_empty() {
        function.outputs =
            graph.substitute(&function.outputs, &|input| derived.get(&input).copied());
    }
}

/// Whether a value depends on parameters.
pub(super) fn is_computed(model: &Model, graph: &Graph, value: ExprId) -> bool {
    let inputs = graph.inputs_of(&[value]);
    inputs.into_iter().any(|input| matches!(model.symbols[input as usize], Symbol::Param(_)))
}
