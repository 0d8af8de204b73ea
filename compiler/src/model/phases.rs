//! Phases: parts of the motion with a time of their own, and what ties them together.
//!
//! Each phase is a whole model. Parameters and unknowns of all phases and of what stands outside
//! are in the lists of each, at the same places; what belongs to one phase is called `PHASE.NAME`
//! there. The graph of the whole reads what it needs of a phase by [`Symbol::OfPhase`].

use super::{Constraint, Model, Place, Range, Symbol};
use crate::expressions::graph::{ById, ExprId, Graph};
use fdcc_runtime::problem::End;

/// A part of the motion.
#[derive(Clone)]
pub struct Phase {
    /// Its declaration.
    pub place: Place,
    /// What holds in it, with its part of the objective and all conditions that read no other
    /// phase.
    pub model: Model,
    /// So many of its path conditions, the first ones, hold at its first point, too: none where a
    /// jump of the state puts it on the surface that they are about.
    pub hold_at_first: usize,
}

/// Conditions between phases, over the symbols of the whole.
#[derive(Clone, Debug)]
pub struct Link {
    /// The ends that it reads.
    pub ends: Vec<End>,
    /// A part of the objective.
    pub objective: Option<ExprId>,
    /// What must hold.
    pub rows: Vec<Constraint>,
}

/// A graph with what its inputs stand for.
pub(crate) struct Symbols<'g> {
    pub graph: &'g mut Graph,
    pub symbols: &'g mut Vec<Symbol>,
}

impl Symbols<'_> {
    /// The input that is a symbol, a new one if there is none.
    pub fn input(&mut self, symbol: Symbol) -> u32 {
        let known = self.symbols.iter().position(|known| *known == symbol);
        let at = known.unwrap_or_else(|| {
            self.symbols.push(symbol);
            self.symbols.len() - 1
        });
        at as u32
    }

    /// Copies expressions of the whole that read no other phase than the one whose symbols these
    /// are. States, controls and surfaces that are declared outside of all phases have the same
    /// numbers in each.
    pub fn take(&mut self, from: &Graph, meanings: &[Symbol], roots: &[ExprId]) -> Vec<ExprId> {
        let inputs = from.inputs_of(roots).into_iter();
        let places: Vec<(u32, u32)> = inputs
            .map(|at| match meanings[at as usize] {
                Symbol::OfPhase { input, .. } => (at, input),
                symbol => (at, self.input(symbol)),
            })
            .collect();
        let place = |at| places[places.partition_point(|it| it.0 < at)].1;
        self.graph
            .import(from, roots, &mut ById::default(), &mut |graph, at| graph.input(place(at)))
    }
}

impl Symbols<'_> {
    /// Copies expressions of a phase, these being the symbols of the whole. `known` is what has
    /// been copied of it.
    pub fn take_of(
        &mut self,
        phase: usize,
        (from, meanings): (&Graph, &[Symbol]),
        roots: &[ExprId],
        known: &mut ById<ExprId>,
    ) -> Vec<ExprId> {
        let Symbols { graph, symbols } = self;
        graph.import(from, roots, known, &mut |graph, input| {
            let meaning = meanings[input as usize];
            let is_shared = matches!(meaning, Symbol::Param(_) | Symbol::Free(_));
            let symbol = if is_shared { meaning } else { Symbol::OfPhase { phase, input } };
            let input = Symbols { graph, symbols }.input(symbol);
            graph.input(input)
        })
    }
}

impl Model {
    /// The symbols of the graph, to be added to.
    pub(crate) fn symbols_mut(&mut self) -> Symbols<'_> {
        Symbols { graph: &mut self.graph, symbols: &mut self.symbols }
    }

    /// Whether something is minimised, in a phase or a link as well.
    pub(crate) fn has_objective(&self) -> bool {
        self.objective.is_some()
            || self.phases.iter().any(|it| it.model.objective.is_some())
            || self.links.iter().any(|it| it.objective.is_some())
    }

    /// Gives a phase the parameters and unknowns of the whole.
    pub(crate) fn share_parameters(&self, phase: &mut Model) {
        let mut own = phase.symbols_mut();
        (0..self.params.len()).for_each(|at| _ = own.input(Symbol::Param(at)));
        (0..self.frees.len()).for_each(|at| _ = own.input(Symbol::Free(at)));
        let mut take = |id: ExprId| own.take(&self.graph, &self.symbols, &[id])[0];
        let mut params = self.params.clone();
        for param in &mut params {
            param.range = moved(param.range, &mut take);
            param.value = param.value.map(&mut take);
        }
        let mut frees = self.frees.clone();
        for free in &mut frees {
            free.range = moved(free.range, &mut take);
            free.guess = free.guess.map(&mut take);
        }
        (phase.params, phase.frees) = (params, frees);
        phase.param_order.clone_from(&self.param_order);
    }
}

/// Both bounds, copied.
pub(crate) fn moved(range: Range, take: &mut dyn FnMut(ExprId) -> ExprId) -> Range {
    Range { lower: take(range.lower), upper: take(range.upper) }
}
