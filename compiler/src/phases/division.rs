//! Time divided into phases, whose models have the same symbols: what links read of them.

use super::shares::Shares;
use crate::expressions::graph::{ExprId, Graph};
use crate::model::{Constraint, Free, Link, Model, Phase, Place, Range, Sum, Symbol};
use fdcc_runtime::problem::End;

/// Phases that are called by the model and their number.
pub(super) fn numbered(name: &str, models: impl Iterator<Item = Model>) -> Vec<Phase> {
    let phase = |(j, model): (usize, Model)| Phase {
        place: Place { name: format!("{name} {}", j + 1), ..Place::default() },
        model,
        hold_at_first: 0,
    };
    models.enumerate().map(phase).collect()
}

/// Gives a model all symbols that phases or links read.
pub(super) fn add_symbols(model: &mut Model) {
    model.symbols_mut().input(Symbol::Time);
    for at in 0..model.states.len() {
        let mut symbols = model.symbols_mut();
        symbols.input(Symbol::AtStart(at));
        symbols.input(Symbol::AtEnd(at));
    }
    for at in 0..model.controls.len() {
        let mut symbols = model.symbols_mut();
        symbols.input(Symbol::ControlAtStart(at));
        symbols.input(Symbol::ControlAtEnd(at));
    }
}

/// Makes the times at which a new phase begins unknowns of the model, between its first and last
/// time, and gives it all symbols that phases or links read.
pub(super) fn divide(model: &mut Model, between: Vec<Place>) -> Vec<ExprId> {
    add_symbols(model);
    let first = model.frees.len();
    let of = |model: &mut Model, symbol| {
        let input = model.symbols_mut().input(symbol);
        model.graph.input(input)
    };
    let [begin, end] = model.interval;
    let unbounded = [f64::NEG_INFINITY, f64::INFINITY].map(|it| model.graph.number(it));
    let (mut times, count) = (vec![begin], between.len());
    for (j, place) in between.into_iter().enumerate() {
        times.push(of(model, Symbol::Free(first + j)));
        let duration = model.graph.sub(end, begin);
        let passed = model.graph.scale((j + 1) as f64 / (count + 1) as f64, duration);
        let guess = Some(model.graph.add(begin, passed));
        let range = Range { lower: unbounded[0], upper: unbounded[1] };
        model.frees.push(Free { place, range, guess });
    }
    times.push(end);
    times
}

/// A model over the whole time, and the times at which its phases begin and end.
pub(super) struct Division<'m> {
    /// What holds in each phase before anything is changed in it; it has all symbols that phases
    /// and links read, and the times as unknowns.
    pub model: &'m Model,
    pub graph: Graph,
    /// What the inputs of the graph are: those of a phase, then what links read of phases.
    pub symbols: Vec<Symbol>,
    /// When phases begin; and the last time.
    pub times: Vec<ExprId>,
}

impl<'m> Division<'m> {
    pub fn new(model: &'m Model, times: Vec<ExprId>) -> Self {
        Division { model, graph: model.graph.clone(), symbols: model.symbols.clone(), times }
    }

    /// The number of the last phase.
    pub fn last(&self) -> usize {
        self.times.len() - 2
    }

    /// The sums over rows: those before and behind the time of a phase belong to its neighbours.
    pub fn sums(&self, j: usize) -> Vec<Sum> {
        let shared = |sum: &Sum| {
            let [before, behind] = sum.is_shared;
            Sum { is_shared: [before || j > 0, behind || j < self.last()], ..sum.clone() }
        };
        self.model.sums.iter().map(shared).collect()
    }

    pub fn input_of_state(&self, state: usize) -> u32 {
        self.model.input_of(Symbol::State(state)).expect("each state is a symbol")
    }

    pub fn not_below(&mut self) -> Range {
        Range { lower: self.graph.number(0.0), upper: self.graph.number(f64::INFINITY) }
    }

    pub fn not_above(&mut self) -> Range {
        Range { lower: self.graph.number(f64::NEG_INFINITY), upper: self.graph.number(0.0) }
    }

    pub fn exactly_zero(&mut self) -> Range {
        let zero = self.graph.number(0.0);
        Range { lower: zero, upper: zero }
    }

    /// The conditions at the ends of the whole time, and what is minimised of these.
    pub fn link_of_whole(&mut self, shares: &Shares, boundary: &[Constraint]) -> Option<Link> {
        let rows: Vec<Constraint> = (boundary.iter())
            .map(|row| Constraint { value: self.of_whole(row.value), ..row.clone() })
            .collect();
        let objective = shares.linked.map(|value| self.of_whole(value));
        let last = self.last();
        let between = if shares.integrals.is_empty() { 0..0 } else { 0..last };
        let ends = std::iter::once(End::First(0))
            .chain(between.map(End::Last))
            .chain(std::iter::once(End::Last(last)))
            .collect();
        (objective.is_some() || !rows.is_empty()).then_some(Link { ends, objective, rows })
    }

    /// A symbol of a phase, as links read it.
    pub fn of_phase(&mut self, phase: usize, symbol: Symbol) -> ExprId {
        let input = self.model.input_of(symbol).expect("a phase has all symbols that links read");
        let symbol = Symbol::OfPhase { phase, input };
        let at = self.symbols.iter().position(|known| *known == symbol).unwrap_or_else(|| {
            self.symbols.push(symbol);
            self.symbols.len() - 1
        });
        self.graph.input(at as u32)
    }

    /// A function of time, state and control at the end of a phase.
    pub fn at_end(&mut self, j: usize, value: ExprId) -> ExprId {
        self.with_symbols(value, &mut |own, symbol| match symbol {
            Symbol::Time => Some(own.times[j + 1]),
            Symbol::State(at) => Some(own.of_phase(j, Symbol::AtEnd(at))),
            Symbol::Control(at) => Some(own.of_phase(j, Symbol::ControlAtEnd(at))),
            _ => None,
        })
    }

    /// A function of time, state and control at the beginning of a phase.
    pub fn at_start(&mut self, j: usize, value: ExprId) -> ExprId {
        self.with_symbols(value, &mut |own, symbol| match symbol {
            Symbol::Time => Some(own.times[j]),
            Symbol::State(at) => Some(own.of_phase(j, Symbol::AtStart(at))),
            Symbol::Control(at) => Some(own.of_phase(j, Symbol::ControlAtStart(at))),
            _ => None,
        })
    }

    /// A value in the first phase at its first time, of its own start.
    pub fn at_own_start(&mut self, value: ExprId) -> ExprId {
        let model = self.model;
        self.with_symbols(value, &mut |own, symbol| match symbol {
            Symbol::Time => Some(own.times[0]),
            Symbol::State(at) => {
                let input = model.input_of(Symbol::AtStart(at)).expect("it was added");
                Some(own.graph.input(input))
            }
            _ => None,
        })
    }

    /// A value in the last phase at its last time, of its own end.
    pub fn at_own_end(&mut self, value: ExprId) -> ExprId {
        let model = self.model;
        self.with_symbols(value, &mut |own, symbol| match symbol {
            Symbol::Time => Some(own.times[own.times.len() - 1]),
            Symbol::State(at) => {
                let input = model.input_of(Symbol::AtEnd(at)).expect("it was added");
                Some(own.graph.input(input))
            }
            _ => None,
        })
    }

    /// What is said of the whole time: it begins with the first phase, ends with the last, and
    /// integrals add up.
    pub fn of_whole(&mut self, value: ExprId) -> ExprId {
        let last = self.last();
        self.with_symbols(value, &mut |own, symbol| match symbol {
            Symbol::AtStart(_) => Some(own.of_phase(0, symbol)),
            Symbol::AtEnd(_) | Symbol::ControlAtEnd(_) => Some(own.of_phase(last, symbol)),
            Symbol::Integral(_) => {
                let all: Vec<ExprId> = (0..=last).map(|j| own.of_phase(j, symbol)).collect();
                Some(own.graph.sum(&all))
            }
            _ => None,
        })
    }

    /// Gives those symbols that an expression reads another meaning for which there is one.
    pub fn with_symbols(
        &mut self,
        value: ExprId,
        meaning: &mut dyn FnMut(&mut Self, Symbol) -> Option<ExprId>,
    ) -> ExprId {
        let mut replaced = Vec::new();
        for input in self.graph.inputs_of(&[value]) {
            let symbol = self.symbols[input as usize];
            replaced.extend(meaning(self, symbol).map(|it| (input, it)));
        }
        let other = |input: u32| replaced.iter().find(|it| it.0 == input).map(|it| it.1);
        self.graph.substitute(&[value], &other)[0]
    }
}
