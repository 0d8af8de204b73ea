//! The functions of a problem once more, differentiated by the parameters, and the numbers that
//! parameters give.

use super::function::{Order, VectorFunction};
use super::inputs::{self, Sizes};
use super::{LoweredProblem, boundary};
use crate::expressions::graph::builtins::Builtin;
use crate::expressions::graph::{Expr, ExprId, Graph};
use crate::model::{Model, Range, Symbol};
use fdcc_runtime::problem::{Layout, Origin};

/// Right side, path constraints, both ends, and what is given, in the order of
/// [`ByParameters`](fdcc_runtime::problem::ByParameters); then the sums over rows.
pub(crate) fn by_parameters(model: &Model, lowered: &mut LoweredProblem) -> Vec<VectorFunction> {
    let given = given(model, lowered);
    let first = [&lowered.dynamics, &lowered.path, &lowered.boundary, &given];
    let sums = lowered.measured.iter().map(|it| &it.term);
    first.into_iter().chain(sums).map(|it| by_first(model, it.clone())).collect()
}

/// The parameters are the first entries of `p`.
pub(super) fn by_first(model: &Model, function: VectorFunction) -> VectorFunction {
    let first = function.layout.parameters().start;
    let by = (first..first + model.params.len()).map(|at| at as u32).collect();
    VectorFunction { by, order: Order::First, ..function }
}

fn given(model: &Model, lowered: &mut LoweredProblem) -> VectorFunction {
    let sizes = Sizes::new(model, lowered.hidden.len());
    let layout = Layout { p: sizes.parameters, ..Layout::default() };
    let outputs = outputs(model, &lowered.boundary_rows, lowered.hidden.len(), &mut lowered.graph);
    let inputs = inputs::of_parameters(model, &mut lowered.graph, &layout);
    let outputs = inputs.apply(&mut lowered.graph, &outputs);
    let origins = vec![Origin::default(); outputs.len()];
    VectorFunction {
        name: "given".into(),
        layout,
        outputs,
        origins,
        by: Vec::new(),
        order: Order::First,
    }
}

/// Expressions over the symbols of the model.
fn outputs(
    model: &Model,
    ends: &[boundary::Condition],
    hidden: usize,
    graph: &mut Graph,
) -> Vec<ExprId> {
    let zero = graph.number(0.0);
    let mut outputs: Vec<ExprId> = Vec::new();
    outputs.extend(model.params.iter().map(|param| param.value.unwrap_or(zero)));
    let start = |state: &crate::model::State| {
        state.start.filter(|&start| boundary::is_fixed(model, graph, start)).unwrap_or(zero)
    };
    outputs.extend(model.states.iter().map(start));
    outputs.extend(std::iter::repeat_n(zero, hidden));
    let free = Range { lower: zero, upper: zero };
    let ranges = (model.states.iter().map(|it| it.range))
        .chain(std::iter::repeat_n(free, hidden))
        .chain(model.controls.iter().map(|it| it.range))
        .chain(model.frees.iter().map(|it| it.range))
        .chain(model.path.iter().map(|it| it.range))
        .chain(ends.iter().map(|it| it.range));
    outputs.extend(ranges.flat_map(|range| [range.lower, range.upper]));
    outputs
}

/// Whether neither the right side nor a path constraint depends on the time but through states and
/// controls.
pub(crate) fn is_autonomous(lowered: &LoweredProblem) -> bool {
    let outputs = [&lowered.dynamics, &lowered.path].map(|it| it.outputs.clone()).concat();
    !lowered.graph.inputs_of(&outputs).contains(&0)
}

/// Whether right side, path constraints or ends have kinks of `abs`, `min` and `max`, or knots of
/// pieces.
pub(crate) fn has_kinks(lowered: &LoweredProblem) -> bool {
    let functions = [&lowered.dynamics, &lowered.path, &lowered.boundary];
    let outputs = functions.map(|it| it.outputs.clone()).concat();
    let is_kink = |id: &ExprId| match lowered.graph.expr(*id) {
        Expr::Call(builtin, _) => {
            matches!(builtin, Builtin::Abs | Builtin::Min | Builtin::Max | Builtin::SelectLe)
        }
        _ => false,
    };
    lowered.graph.reachable(&outputs).iter().any(is_kink)
}

/// The unknown that is the last time, and nothing else: no right side, path constraint or first
/// time depends on it.
pub(crate) fn last_time(model: &Model, lowered: &LoweredProblem) -> Option<usize> {
    let Expr::Input(last) = *model.graph.expr(model.interval[1]) else { return None };
    let Symbol::Free(unknown) = model.symbols[last as usize] else { return None };
    let place = lowered.flow.layout.parameters().start + model.params.len() + unknown;
    let flow_and_path = [&lowered.flow, &lowered.path].map(|it| it.outputs.clone()).concat();
    let is_elsewhere = lowered.graph.inputs_of(&flow_and_path).contains(&(place as u32));
    let starts_with_it = model.graph.inputs_of(&model.interval[..1]).contains(&last);
    (!is_elsewhere && !starts_with_it).then_some(unknown)
}
