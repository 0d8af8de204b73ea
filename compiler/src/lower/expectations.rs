//! What a model expects of its solution, as a function that can be evaluated once there is one.
//!
//! Inputs `[x(start), x(end) | p, integrals, sums, simulated]`; three outputs for each expectation:
//! left side, right side, tolerance.

use super::function::{Order, VectorFunction};
use super::inputs::{self, Sizes};
use super::links::Places;
use super::measured::{self, Measured};
use super::objective::{self, Hidden, Objective};
use super::{OverGrid, origin};
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Comparison, Model, Symbol};
use fdcc_runtime::problem::{End, Layout, Origin};

/// One expectation.
#[derive(Clone, Debug)]
pub struct Expected {
    /// The text and its place.
    pub origin: Origin,
    /// How the sides compare.
    pub comparison: Comparison,
    /// Which of [`Model::simulated`] it reads.
    pub simulated: Vec<usize>,
}

/// All expectations of a model, and the functions that tell whether they hold.
pub(crate) struct LoweredExpectations {
    /// In the order of the text.
    pub list: Vec<Expected>,
    /// The expressions.
    pub graph: Graph,
    /// The two sides with the tolerance of each expectation; and the integrands.
    pub functions: [VectorFunction; 2],
    /// The sums over rows, values only.
    pub sums: Vec<Measured>,
}

/// Lowers the expectations.
pub(crate) fn expectations(model: &Model) -> LoweredExpectations {
    let mut graph = model.graph.clone();
    let objective = objective::split(model, &mut graph);
    let sizes = Sizes::new(model, objective.hidden.len());
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
    let (mut needed, mut sums) = (Vec::new(), Vec::new());
    for it in objective::hidden_in(model, &graph, &values) {
        match it {
            Hidden::Integral(at) => needed.push(at),
            Hidden::Sum(at) => sums.push(at),
        }
    }
    let over_grid = inputs::over_grid(model, &mut graph, &sizes);
    let integrands: Vec<ExprId> = needed.iter().map(|&at| model.integrals[at].integrand).collect();
    let integrands = over_grid.apply(&mut graph, &integrands);
    let integrands = integrands.iter().map(|&it| graph.mul(over_grid.duration, it)).collect();
    let more = needed.len() + sums.len() + model.simulated.len();
    let layout = Layout { p: sizes.parameters + more, ..sizes.ends() };
    let mut at_ends = inputs::at_ends(model, &mut graph, &layout, &[]);
    let integrals = needed.iter().map(|&at| Symbol::Integral(at));
    let simulated = (0..model.simulated.len()).map(Symbol::Simulated);
    let added = sums.iter().map(|&at| Symbol::Sum(at));
    for (position, symbol) in integrals.chain(added).chain(simulated).enumerate() {
        let place = graph.input((layout.parameters().end - more + position) as u32);
        at_ends.replace(model, symbol, place);
    }
    let values = at_ends.apply(&mut graph, &values);
    let functions = [
        values_only("expectations", layout, values),
        values_only("integrands", sizes.grid(), integrands),
    ];
    let sums = alone(model, &mut graph, &sizes, objective, &sums);
    LoweredExpectations { list, graph, functions, sums }
}

/// Sums by themselves, over the states of the problem.
fn alone(
    model: &Model,
    graph: &mut Graph,
    sizes: &Sizes,
    objective: Objective,
    sums: &[usize],
) -> Vec<Measured> {
    let over_grid = OverGrid { model, sizes, inputs: inputs::over_grid(model, graph, sizes) };
    let dynamics = over_grid.dynamics(graph, &objective);
    let one = graph.number(1.0);
    let measured = sums.iter().map(|&sum| (sum, one)).collect();
    let asked = Objective { measured, ..objective };
    let mut all = measured::lower(model, graph, sizes, &asked, &dynamics);
    // Those that became states follow.
    all.truncate(sums.len());
    all.iter_mut().for_each(|it| it.term.by.clear());
    all
}

/// Expectations of a model with phases. Inputs `[x | p, integrals]`: `x` as in a
/// [`Link`](fdcc_runtime::problem::Link) to both ends of each phase, without hidden states; the
/// integrals of each phase and its sums over rows in turn.
pub(crate) fn expectations_of_phases(model: &Model) -> (Graph, VectorFunction, Vec<Expected>) {
    let mut graph = model.graph.clone();
    let ends: Vec<End> =
        (0..model.phases.len()).flat_map(|at| [End::First(at), End::Last(at)]).collect();
    let hidden: Vec<&[Hidden]> = vec![&[]; model.phases.len()];
    let mut places = Places::new(model, &hidden, &ends);
    places.with_totals();
    let values: Vec<ExprId> = model.expectations.iter().flat_map(|it| it.values).collect();
    let list = model.expectations.iter().map(|it| Expected {
        origin: origin(&it.place),
        comparison: it.comparison,
        simulated: Vec::new(),
    });
    let list = list.collect();
    let values = places.apply(&mut graph, &values);
    (graph, values_only("expectations", places.layout, values), list)
}

/// All sums over rows of a phase, values only.
pub(crate) fn sums(model: &Model) -> (Graph, Vec<Measured>) {
    let mut graph = model.graph.clone();
    let objective = objective::split(model, &mut graph);
    let sizes = Sizes::new(model, objective.hidden.len());
    let all: Vec<usize> = (0..model.sums.len()).collect();
    let sums = alone(model, &mut graph, &sizes, objective, &all);
    (graph, sums)
}

/// All integrands of a phase over normalised time, times its duration.
pub(crate) fn integrands(model: &Model) -> (Graph, VectorFunction) {
    let mut graph = model.graph.clone();
    let hidden = objective::split(model, &mut graph).hidden.len();
    let sizes = Sizes::new(model, hidden);
    let over_grid = inputs::over_grid(model, &mut graph, &sizes);
    let integrands: Vec<ExprId> = model.integrals.iter().map(|it| it.integrand).collect();
    let integrands = over_grid.apply(&mut graph, &integrands);
    let integrands = integrands.iter().map(|&it| graph.mul(over_grid.duration, it)).collect();
    (graph, values_only("integrands", sizes.grid(), integrands))
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
