//! What links say of the state with which a phase begins.
//!
//! A phase that begins on a surface asks for `psi = 0` there. Where the phase before it ends on the
//! same surface and a link hands the state over, or a link or an `end` condition says it in other
//! ways, that would be said twice, and the Jacobian of the chain would lose rank.

use super::limits::{bounded_states, rates};
use super::{Arc, Mode, PhaseOfModes, between_jumps};
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ById, ExprId, Graph};
use crate::model::phases::Symbols;
use crate::model::{Link, Model, Symbol};

/// The start of a phase as links have it.
pub(super) struct Linked {
    pub graph: Graph,
    /// Those of the whole.
    pub symbols: Vec<Symbol>,
    /// What each state is at the first time, where a link hands it over.
    states: Vec<Option<ExprId>>,
    /// The first time.
    time: ExprId,
    /// What is 0 where other phases end.
    zeros: Vec<ExprId>,
}

impl Linked {
    /// Of one of the phases of a model, each of which is divided into phases of given modes.
    pub fn new(model: &Model, structures: &[&[PhaseOfModes]], phase: usize) -> Self {
        let own = &model.phases[phase].model;
        let mut linked = Linked {
            graph: model.graph.clone(),
            symbols: model.symbols.clone(),
            states: vec![None; own.states.len()],
            time: model.graph.clone().number(0.0),
            zeros: Vec::new(),
        };
        linked.time = linked.read((&own.graph, &own.symbols), own.interval[0], &mut |_, _| None);
        for link in &model.links {
            linked.take_states(model, link, phase);
        }
        for (other, structure) in structures.iter().enumerate().filter(|it| it.0 != phase) {
            linked.take_zeros(model, other, structure.last().expect("each phase has a structure"));
        }
        linked
    }

    /// A value of the phase at the first time, over what links read; what they do not hand over is
    /// an end of the phase itself.
    pub fn at_start(&mut self, model: &Model, phase: usize, value: ExprId) -> ExprId {
        let own = &model.phases[phase].model;
        let (states, time) = (self.states.clone(), self.time);
        self.read((&own.graph, &own.symbols), value, &mut |linked, symbol| match symbol {
            Symbol::Time => Some(time),
            Symbol::State(at) if states[at].is_some() => states[at],
            Symbol::Param(_) | Symbol::Free(_) => None,
            other => {
                own.input_of(other).map(|it| linked.input(Symbol::OfPhase { phase, input: it }))
            }
        })
    }

    /// A value of another phase at its last time.
    pub fn at_end(&mut self, model: &Model, phase: usize, value: (&Graph, ExprId)) -> ExprId {
        let own = &model.phases[phase].model;
        let time = self.read((&own.graph, &own.symbols), own.interval[1], &mut |_, _| None);
        self.read((value.0, &own.symbols), value.1, &mut |linked, symbol| {
            let symbol = match symbol {
                Symbol::Time => return Some(time),
                Symbol::State(at) | Symbol::AtEnd(at) => Symbol::AtEnd(at),
                Symbol::Param(_) | Symbol::Free(_) => return None,
                other => other,
            };
            let input = own.input_of(symbol)?;
            Some(linked.input(Symbol::OfPhase { phase, input }))
        })
    }

    /// Whether a value of the phase is 0 at the first time whatever is chosen.
    pub fn is_zero(&mut self, own: (&Graph, &[Symbol]), value: ExprId) -> bool {
        let (states, time) = (self.states.clone(), self.time);
        let mut is_known = true;
        let value = self.read(own, value, &mut |linked, symbol| match symbol {
            Symbol::Time => Some(time),
            Symbol::State(at) if states[at].is_some() => states[at],
            Symbol::Param(_) | Symbol::Free(_) => None,
            _ => {
                is_known = false;
                Some(linked.graph.number(0.0))
            }
        });
        let opposite = self.graph.neg(value);
        let is_zero = self.graph.as_number(value) == Some(0.0);
        is_known && (is_zero || self.zeros.iter().any(|it| *it == value || *it == opposite))
    }

    /// An expression of a phase, some of whose symbols have another meaning.
    fn read(
        &mut self,
        (graph, meanings): (&Graph, &[Symbol]),
        value: ExprId,
        meaning: &mut dyn FnMut(&mut Self, Symbol) -> Option<ExprId>,
    ) -> ExprId {
        let inputs = graph.inputs_of(&[value]).into_iter();
        let places: Vec<(u32, ExprId)> = inputs
            .map(|input| {
                let symbol = meanings[input as usize];
                let other = meaning(self, symbol);
                (input, other.unwrap_or_else(|| self.input(symbol)))
            })
            .collect();
        let place = |input: u32| places[places.partition_point(|it| it.0 < input)].1;
        let copy =
            self.graph.import(graph, &[value], &mut ById::default(), &mut |_, input| place(input));
        copy[0]
    }

    fn input(&mut self, symbol: Symbol) -> ExprId {
        let Linked { graph, symbols, .. } = self;
        let input = Symbols { graph, symbols }.input(symbol);
        self.graph.input(input)
    }

    /// The states that are functions of other ends: `x_first - r(x_last) = 0`.
    fn take_states(&mut self, model: &Model, link: &Link, phase: usize) {
        let is_exact = |row: &&crate::model::Constraint| row.range.lower == row.range.upper;
        for row in link.rows.iter().filter(is_exact) {
            let gap = self.graph.sub(row.value, row.range.lower);
            let started = |at: &u32| match self.symbols[*at as usize] {
                Symbol::OfPhase { phase: own, input } if own == phase => {
                    Some((*at, model.phases[phase].model.symbols[input as usize]))
                }
                _ => None,
            };
            let read: Vec<(u32, Symbol)> =
                self.graph.inputs_of(&[gap]).iter().filter_map(started).collect();
            let [(input, Symbol::AtStart(state))] = read[..] else { continue };
            let slope = derivative(&mut self.graph, gap, input);
            let zero = self.graph.number(0.0);
            let rest = self.graph.substitute(&[gap], &|at| (at == input).then_some(zero))[0];
            self.states[state] = match self.graph.as_number(slope) {
                Some(1.0) => Some(self.graph.neg(rest)),
                Some(-1.0) => Some(rest),
                _ => continue,
            };
        }
    }

    /// What is 0 at the last time of a phase: surfaces that are held, bounds that are kept, and
    /// what its conditions say.
    fn take_zeros(&mut self, model: &Model, phase: usize, last: &PhaseOfModes) {
        let own = &between_jumps(&model.phases[phase].model);
        let mut graph = own.graph.clone();
        let mut zeros = Vec::new();
        for (switch, _) in own.switches().iter().zip(&last.modes).filter(|it| *it.1 == Mode::Held) {
            zeros.extend(own.surfaces[switch.surfaces.clone()].iter().map(|it| it.psi));
        }
        let states = bounded_states(own).into_iter().map(|at| {
            let input = own.input_of(Symbol::State(at)).expect("each state is a symbol");
            (own.graph.clone().input(input), own.states[at].range)
        });
        let limits = states.chain(own.path.iter().map(|row| (row.value, row.range)));
        for ((value, range), arc) in limits.zip(&last.contacts) {
            let bound = match arc {
                Arc::Lower => range.lower,
                Arc::Upper => range.upper,
                Arc::Free => continue,
            };
            let gap = graph.sub(value, bound);
            zeros.extend(rates(own, &mut graph, gap).into_iter().flat_map(|it| {
                let count = it.len() - 1;
                it.into_iter().take(count)
            }));
        }
        for row in own.boundary.iter().filter(|it| it.range.lower == it.range.upper) {
            zeros.push(graph.sub(row.value, row.range.lower));
        }
        for zero in zeros {
            let known = self.at_end(model, phase, (&graph, zero));
            self.zeros.push(known);
        }
    }
}
