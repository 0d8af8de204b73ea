//! One phase of time, and what the symbols of the model are in it.

use super::MultiPhase;
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Model, Symbol};

/// What the symbols of a model are in a phase; nothing where they stay what they are.
pub(super) struct Phase {
    /// At a time of the phase.
    inside: Vec<Option<ExprId>>,
    /// At its last time.
    at_end: Vec<Option<ExprId>>,
    /// All states at its start.
    pub starts: Vec<ExprId>,
    /// All states at its end.
    pub ends: Vec<ExprId>,
}

/// The input that is a symbol, a new one if it has none yet.
pub(super) fn input(graph: &mut Graph, symbols: &mut Vec<Symbol>, symbol: Symbol) -> ExprId {
    let at = symbols.iter().position(|known| *known == symbol).unwrap_or_else(|| {
        symbols.push(symbol);
        symbols.len() - 1
    });
    graph.input(at as u32)
}

impl Phase {
    /// All phases of these durations.
    pub fn all(
        model: &Model,
        graph: &mut Graph,
        symbols: &mut Vec<Symbol>,
        durations: &[ExprId],
    ) -> Vec<Phase> {
        let mut begin = model.interval[0];
        let mut phases = Vec::new();
        for (j, &duration) in durations.iter().enumerate() {
            let end = graph.add(begin, duration);
            phases.push(Phase::new(model, graph, symbols, j, [begin, duration, end]));
            begin = end;
        }
        phases
    }

    fn new(
        model: &Model,
        graph: &mut Graph,
        symbols: &mut Vec<Symbol>,
        j: usize,
        [begin, duration, end]: [ExprId; 3],
    ) -> Phase {
        let sizes = [model.states.len(), model.controls.len(), model.surfaces.len()];
        let mut of = |symbol| input(graph, symbols, symbol);
        let tau = of(Symbol::Time);
        let inside = model.symbols.iter().map(|symbol| match *symbol {
            Symbol::State(at) => Some(of(Symbol::State(at + j * sizes[0]))),
            Symbol::Control(at) => Some(of(Symbol::Control(at + j * sizes[1]))),
            Symbol::Selector(at) if at < sizes[2] => Some(of(Symbol::Selector(at + j * sizes[2]))),
            _ => None,
        });
        let mut inside: Vec<Option<ExprId>> = inside.collect();
        let all =
            |of: &mut dyn FnMut(usize) -> Symbol| (0..sizes[0]).map(of).collect::<Vec<Symbol>>();
        let starts = all(&mut |at| Symbol::AtStart(at + j * sizes[0]));
        let ends = all(&mut |at| Symbol::AtEnd(at + j * sizes[0]));
        let [starts, ends] =
            [starts, ends].map(|it| it.into_iter().map(&mut of).collect::<Vec<ExprId>>());
        let passed = graph.mul(tau, duration);
        let now = graph.add(begin, passed);
        let mut at_end = vec![None; inside.len()];
        for (at, symbol) in model.symbols.iter().enumerate() {
            match *symbol {
                Symbol::Time => (inside[at], at_end[at]) = (Some(now), Some(end)),
                Symbol::State(index) => at_end[at] = Some(ends[index]),
                _ => {}
            }
        }
        Phase { inside, at_end, starts, ends }
    }
}

impl MultiPhase<'_> {
    /// A signal in a phase.
    pub(super) fn in_phase(&mut self, j: usize, value: ExprId) -> ExprId {
        let inside = &self.phases[j].inside;
        self.graph.substitute(&[value], &|at| inside.get(at as usize).copied().flatten())[0]
    }

    /// A function of time and state at the end of a phase.
    pub(super) fn at_end(&mut self, j: usize, value: ExprId) -> ExprId {
        let at_end = &self.phases[j].at_end;
        self.graph.substitute(&[value], &|at| at_end.get(at as usize).copied().flatten())[0]
    }

    /// What is said of the whole time: it ends where the last phase does.
    pub(super) fn of_whole(&mut self, value: ExprId) -> ExprId {
        let (symbols, last) = (&self.model.symbols, &self.phases[self.phases.len() - 1].ends);
        self.graph.substitute(&[value], &|at| match symbols.get(at as usize) {
            Some(Symbol::AtEnd(index)) => Some(last[*index]),
            _ => None,
        })[0]
    }
}
