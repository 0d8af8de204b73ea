//! Path conditions at the first point of a phase that follows another.
//!
//! A transcription has them at every grid point after the first: where a motion begins, it begins
//! as it does. A later phase begins where a link puts it, which may be beyond a condition. Those
//! that read a control hold on the first interval as they are.

use super::function::{Order, VectorFunction};
use super::links::LoweredLink;
use super::{LoweredProblem, origin};
use crate::expressions::graph::{ById, ExprId, Graph};
use crate::model::{Constraint, Model, Phase, Symbol};
use fdcc_runtime::problem::{End, Layout};

/// One link for each phase with such conditions.
pub(super) fn links(
    model: &Model,
    phases: &[&LoweredProblem],
    graph: &mut Graph,
) -> Vec<LoweredLink> {
    let is_linked =
        |phase: usize| model.links.iter().any(|it| it.ends.contains(&End::First(phase)));
    let asks = |phase: &usize| model.phases[*phase].hold_at_first > 0 && is_linked(*phase);
    let later = (1..phases.len()).filter(asks);
    later.filter_map(|phase| link(model, phase, phases[phase], graph)).collect()
}

fn link(
    model: &Model,
    phase: usize,
    lowered: &LoweredProblem,
    graph: &mut Graph,
) -> Option<LoweredLink> {
    let Phase { model: own, hold_at_first, .. } = &model.phases[phase];
    let rows: Vec<Constraint> =
        own.path.iter().take(*hold_at_first).filter(|row| is_of_state(own, row)).cloned().collect();
    if rows.is_empty() {
        return None;
    }
    let states = own.states.len() + lowered.hidden.len();
    let p = model.params.len() + model.frees.len();
    let layout = Layout { x: states + own.controls.len(), p, ..Layout::default() };
    let values: Vec<ExprId> = rows.iter().map(|row| row.value).collect();
    let outputs = at_first(own, &layout, &values, graph);
    let zero = graph.number(0.0);
    let unknowns = layout.parameters().skip(model.params.len());
    let origins = rows.iter().map(|row| origin(&row.place));
    let function = VectorFunction {
        name: "first point".into(),
        outputs: std::iter::once(zero).chain(outputs).collect(),
        origins: std::iter::once(Default::default()).chain(origins).collect(),
        by: layout.states().chain(unknowns).map(|at| at as u32).collect(),
        layout,
        order: Order::Second,
    };
    Some(LoweredLink { ends: vec![End::First(phase)], function, rows, of_phase: Some(phase) })
}

/// Whether a condition reads states, time, parameters and unknowns only.
fn is_of_state(model: &Model, row: &Constraint) -> bool {
    let is_state = |symbol: &Symbol| {
        let is_known = matches!(symbol, Symbol::Time | Symbol::Param(_) | Symbol::Free(_));
        is_known || matches!(symbol, Symbol::State(_))
    };
    let inputs = model.graph.inputs_of(&[row.value]);
    inputs.iter().all(|at| is_state(&model.symbols[*at as usize]))
}

/// Values in a phase at its first time, over the inputs of the link, copied to its graph.
fn at_first(model: &Model, layout: &Layout, values: &[ExprId], graph: &mut Graph) -> Vec<ExprId> {
    let mut own = model.graph.clone();
    let first = model.interval[0];
    let begun = |at: u32| (model.symbols[at as usize] == Symbol::Time).then_some(first);
    let values = own.substitute(values, &begun);
    let parameter = layout.parameters().start;
    let place = |symbol: Symbol| match symbol {
        Symbol::State(at) => at,
        Symbol::Param(at) => parameter + at,
        Symbol::Free(at) => parameter + model.params.len() + at,
        _ => unreachable!("others are not read"),
    };
    let mut input =
        |graph: &mut Graph, at: u32| graph.input(place(model.symbols[at as usize]) as u32);
    graph.import(&own, &values, &mut ById::default(), &mut input)
}
