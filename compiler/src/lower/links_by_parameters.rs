//! The links differentiated by the parameters of the model, and the numbers that these give.

use super::by_parameters::by_first;
use super::function::{Order, VectorFunction};
use super::links::{LoweredLink, links};
use super::{LoweredProblem, inputs};
use crate::expressions::graph::{ById, ExprId, Graph};
use crate::model::{Model, Range, Symbol};
use fdcc_runtime::problem::{Layout, Origin};

/// The functions of all links differentiated by the parameters; then what these give, as in
/// [`ChainByParameters`](fdcc_runtime::problem::ChainByParameters).
pub(crate) fn links_by_parameters(
    model: &Model,
    phases: &[&LoweredProblem],
) -> (Graph, Vec<VectorFunction>) {
    let (mut graph, links) = links(model, phases);
    let mut functions: Vec<VectorFunction> =
        links.iter().map(|link| by_first(model, link.function.clone())).collect();
    functions.push(by_first(model, given(model, &links, &mut graph)));
    (graph, functions)
}

/// Parameters over others, and bounds of unknowns and links.
fn given(model: &Model, links: &[LoweredLink], graph: &mut Graph) -> VectorFunction {
    let zero = graph.number(0.0);
    let layout = Layout { p: model.params.len() + model.frees.len(), ..Layout::default() };
    let values = model.params.iter().map(|param| param.value.unwrap_or(zero));
    let unknowns = model.frees.iter().flat_map(|it| ends(it.range));
    let outputs: Vec<ExprId> = values.chain(unknowns).collect();
    let inputs = inputs::of_parameters(model, graph, &layout);
    let mut outputs = inputs.apply(graph, &outputs);
    for link in links {
        let bounds: Vec<ExprId> = link.rows.iter().flat_map(|row| ends(row.range)).collect();
        outputs.extend(match link.of_phase {
            None => inputs.apply(graph, &bounds),
            Some(phase) => imported(&model.phases[phase].model, &bounds, graph),
        });
    }
    let origins = vec![Origin::default(); outputs.len()];
    let (by, order) = (Vec::new(), Order::First);
    VectorFunction { name: "given".into(), layout, outputs, origins, by, order }
}

fn ends(range: Range) -> [ExprId; 2] {
    [range.lower, range.upper]
}

/// Values of a phase over parameters and unknowns, which come first in all functions.
fn imported(phase: &Model, values: &[ExprId], graph: &mut Graph) -> Vec<ExprId> {
    let place = |symbol: Symbol| match symbol {
        Symbol::Param(at) => at,
        Symbol::Free(at) => phase.params.len() + at,
        _ => unreachable!("bounds read nothing else"),
    };
    let mut input =
        |graph: &mut Graph, at: u32| graph.input(place(phase.symbols[at as usize]) as u32);
    graph.import(&phase.graph, values, &mut ById::default(), &mut input)
}
