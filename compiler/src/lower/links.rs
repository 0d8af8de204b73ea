//! Links between phases, as functions of the ends that they read.
//!
//! Inputs `[x | p]`: the states, hidden ones included, then the controls of each end in turn;
//! parameters and unknowns. Output 0 is a part of the objective.

use super::function::{Order, VectorFunction};
use super::objective::Hidden;
use super::{LoweredProblem, origin};
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Constraint, Model, Symbol};
use fdcc_runtime::problem::{End, Layout, Origin};

/// A link, still expressions.
pub(crate) struct LoweredLink {
    /// What it sees.
    pub ends: Vec<End>,
    /// Its part of the objective, then its rows.
    pub function: VectorFunction,
    /// The rows, with their bounds.
    pub rows: Vec<Constraint>,
}

/// All links of a model whose phases have been lowered, over a copy of its graph.
pub(crate) fn links(model: &Model, phases: &[&LoweredProblem]) -> (Graph, Vec<LoweredLink>) {
    let mut graph = model.graph.clone();
    let zero = graph.number(0.0);
    let mut all: Vec<(Vec<End>, Option<ExprId>, Vec<Constraint>)> =
        model.links.iter().map(|link| (link.ends.clone(), None, link.rows.clone())).collect();
    if let Some(objective) = model.linked_objective {
        let ends = model.ends_read(objective);
        match all.iter_mut().find(|link| link.0 == ends) {
            Some(link) => link.1 = Some(objective),
            None => all.push((ends, Some(objective), Vec::new())),
        }
    }
    all.retain(|link| link.1.is_some() || !link.2.is_empty());
    let links = all.into_iter().map(|(ends, objective, rows)| {
        let objective = objective.map_or(zero, |value| graph.scale(model.sense, value));
        let outputs: Vec<ExprId> =
            std::iter::once(objective).chain(rows.iter().map(|row| row.value)).collect();
        let places = Places::new(model, phases, &ends);
        let outputs = places.apply(&mut graph, &outputs);
        let function = places.function(outputs, origins(model, &rows));
        LoweredLink { ends, function, rows }
    });
    let links = links.collect();
    (graph, links)
}

fn origins(model: &Model, rows: &[Constraint]) -> Vec<Origin> {
    let objective = model.objective.as_ref().map_or(Origin::default(), |it| origin(&it.0));
    std::iter::once(objective).chain(rows.iter().map(|row| origin(&row.place))).collect()
}

/// Where the symbols of the whole stand among the inputs of a link.
struct Places<'m> {
    model: &'m Model,
    phases: &'m [&'m LoweredProblem],
    /// Each end with the place of its first state.
    ends: Vec<(End, usize)>,
    layout: Layout,
}

impl<'m> Places<'m> {
    fn new(model: &'m Model, phases: &'m [&'m LoweredProblem], ends: &[End]) -> Self {
        let mut x = 0;
        let mut placed = Vec::new();
        for &end in ends {
            placed.push((end, x));
            let layout = phases[end.phase()].flow.layout;
            x += layout.x + layout.u;
        }
        let p = model.params.len() + model.frees.len();
        Places { model, phases, ends: placed, layout: Layout { x, p, ..Layout::default() } }
    }

    fn place(&self, symbol: Symbol) -> Option<usize> {
        let first = self.layout.parameters().start;
        match symbol {
            Symbol::Param(at) => Some(first + at),
            Symbol::Free(at) => Some(first + self.model.params.len() + at),
            Symbol::OfPhase { phase, input } => self.place_in(phase, input),
            _ => None,
        }
    }

    fn place_in(&self, phase: usize, input: u32) -> Option<usize> {
        let lowered = self.phases[phase];
        let model = &self.model.phases[phase].model;
        let (end, place) = match model.symbols[input as usize] {
            Symbol::AtStart(at) => (End::First(phase), at),
            Symbol::AtEnd(at) => (End::Last(phase), at),
            Symbol::ControlAtEnd(at) => (End::Last(phase), lowered.flow.layout.x + at),
            Symbol::Integral(at) => {
                let hidden = lowered.hidden.iter().position(|it| *it == Hidden::Integral(at))?;
                (End::Last(phase), model.states.len() + hidden)
            }
            _ => return None,
        };
        self.ends.iter().find(|it| it.0 == end).map(|it| it.1 + place)
    }

    fn apply(&self, graph: &mut Graph, outputs: &[ExprId]) -> Vec<ExprId> {
        let places: Vec<Option<ExprId>> = self
            .model
            .symbols
            .iter()
            .map(|symbol| self.place(*symbol).map(|at| graph.input(at as u32)))
            .collect();
        graph.substitute(outputs, &|symbol| places[symbol as usize])
    }

    fn function(&self, outputs: Vec<ExprId>, origins: Vec<Origin>) -> VectorFunction {
        let layout = self.layout;
        let unknowns = layout.parameters().skip(self.model.params.len());
        VectorFunction {
            name: "link".into(),
            layout,
            outputs,
            origins,
            by: layout.states().chain(unknowns).map(|at| at as u32).collect(),
            order: Order::Second,
        }
    }
}
