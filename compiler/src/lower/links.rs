//! Links between phases, as functions of the ends that they read.
//!
//! Inputs `[x | p]`: the states, hidden ones included, then the controls of each end in turn;
//! parameters and unknowns. Output 0 is a part of the objective.

use super::first_points;
use super::function::{Order, VectorFunction};
use super::objective::Hidden;
use super::{LoweredProblem, origin};
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Constraint, Link, Model, Symbol};
use fdcc_runtime::problem::{End, Layout, Origin};

/// A link, still expressions.
pub(crate) struct LoweredLink {
    /// What it sees.
    pub ends: Vec<End>,
    /// Its part of the objective, then its rows.
    pub function: VectorFunction,
    /// The rows, with their bounds.
    pub rows: Vec<Constraint>,
    /// The phase in whose graph the bounds are, if it is not that of the whole.
    pub of_phase: Option<usize>,
}

/// All links of a model whose phases have been lowered, over a copy of its graph.
pub(crate) fn links(model: &Model, phases: &[&LoweredProblem]) -> (Graph, Vec<LoweredLink>) {
    let mut graph = model.graph.clone();
    let hidden: Vec<&[Hidden]> = phases.iter().map(|phase| phase.hidden.as_slice()).collect();
    let is_told = |link: &&Link| link.objective.is_some() || !link.rows.is_empty();
    let told = model.links.iter().filter(is_told);
    let mut links: Vec<LoweredLink> =
        told.map(|link| lower(model, &mut graph, &hidden, link)).collect();
    links.extend(first_points::links(model, phases, &mut graph));
    (graph, links)
}

fn lower(model: &Model, graph: &mut Graph, hidden: &[&[Hidden]], link: &Link) -> LoweredLink {
    let zero = graph.number(0.0);
    let objective = link.objective.map_or(zero, |value| graph.scale(model.sense, value));
    let rows = link.rows.iter().map(|row| row.value);
    let outputs: Vec<ExprId> = std::iter::once(objective).chain(rows).collect();
    let places = Places::new(model, hidden, &link.ends);
    let outputs = places.apply(graph, &outputs);
    let layout = places.layout;
    let unknowns = layout.parameters().skip(model.params.len());
    let function = VectorFunction {
        name: "link".into(),
        layout,
        outputs,
        origins: origins(model, link),
        by: layout.states().chain(unknowns).map(|at| at as u32).collect(),
        order: Order::Second,
    };
    LoweredLink { ends: link.ends.clone(), function, rows: link.rows.clone(), of_phase: None }
}

fn origins(model: &Model, link: &Link) -> Vec<Origin> {
    let objective = model.objective.as_ref().map_or(Origin::default(), |it| origin(&it.0));
    std::iter::once(objective).chain(link.rows.iter().map(|row| origin(&row.place))).collect()
}

/// Where the symbols of the whole stand among the inputs of a function of ends.
pub(super) struct Places<'m> {
    model: &'m Model,
    /// The integrals of each phase that are states.
    hidden: &'m [&'m [Hidden]],
    /// Each end with the place of its first state.
    ends: Vec<(End, usize)>,
    /// The sizes of the inputs.
    pub layout: Layout,
    /// Where the integrals and sums of each phase begin among the parameters, if they are no
    /// states.
    totals: Vec<usize>,
}

impl<'m> Places<'m> {
    pub fn new(model: &'m Model, hidden: &'m [&'m [Hidden]], ends: &[End]) -> Self {
        let mut x = 0;
        let mut placed = Vec::new();
        for &end in ends {
            placed.push((end, x));
            let phase = &model.phases[end.phase()].model;
            x += phase.states.len() + hidden[end.phase()].len() + phase.controls.len();
        }
        let p = model.params.len() + model.frees.len();
        let layout = Layout { x, p, ..Layout::default() };
        Places { model, hidden, ends: placed, layout, totals: Vec::new() }
    }

    /// Puts all integrals of each phase behind the parameters, and then all its sums over rows.
    pub fn with_totals(&mut self) {
        for phase in &self.model.phases {
            self.totals.push(self.layout.parameters().end);
            self.layout.p += phase.model.integrals.len() + phase.model.sums.len();
        }
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
        let (hidden, model) = (self.hidden[phase], &self.model.phases[phase].model);
        let states = model.states.len();
        let (end, place) = match model.symbols[input as usize] {
            Symbol::AtStart(at) => (End::First(phase), at),
            Symbol::AtEnd(at) => (End::Last(phase), at),
            Symbol::ControlAtStart(at) => (End::First(phase), states + hidden.len() + at),
            Symbol::ControlAtEnd(at) => (End::Last(phase), states + hidden.len() + at),
            Symbol::Sum(at) if !self.totals.is_empty() => {
                return Some(self.totals[phase] + model.integrals.len() + at);
            }
            Symbol::Integral(at) if !self.totals.is_empty() => {
                return Some(self.totals[phase] + at);
            }
            Symbol::Integral(at) => (
                End::Last(phase),
                states + hidden.iter().position(|it| *it == Hidden::Integral(at))?,
            ),
            _ => return None,
        };
        self.ends.iter().find(|it| it.0 == end).map(|it| it.1 + place)
    }

    /// Replaces the symbols in some expressions. Others may be of phases that are divided now.
    pub fn apply(&self, graph: &mut Graph, outputs: &[ExprId]) -> Vec<ExprId> {
        let mut places = vec![None; self.model.symbols.len()];
        for input in graph.inputs_of(outputs) {
            let place = self.place(self.model.symbols[input as usize]);
            places[input as usize] = place.map(|at| graph.input(at as u32));
        }
        graph.substitute(outputs, &|symbol| places[symbol as usize])
    }
}
