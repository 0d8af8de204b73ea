//! What ties each phase to the next, and what is written of the ends of the whole time.

use super::MultiPhase;
use super::shares::Shares;
use crate::expressions::graph::ExprId;
use crate::model::{Constraint, Link, Place, Range, Symbol};
use fdcc_runtime::problem::End;

impl MultiPhase<'_> {
    /// `psi = 0` and the resets at a jump, and that the phases beside it have durations.
    pub(super) fn link(&mut self, j: usize) -> Link {
        let jump = self.jump(j);
        let zero = self.graph.number(0.0);
        let row = |name: String, value| Constraint {
            place: Place { name, span: jump.place.span },
            value,
            range: Range { lower: zero, upper: zero },
        };
        let psi = self.at_end(j, self.whole.surfaces[jump.surface].psi);
        let mut rows = vec![row(jump.place.name.clone(), psi)];
        rows.extend(self.direction(j));
        rows.push(self.duration(j, "before"));
        if j + 1 == self.sequence.len() {
            rows.push(self.duration(j + 1, "after"));
        }
        for (index, state) in self.model.states.iter().enumerate() {
            let reset = jump.resets.iter().find(|it| it.0 == index).map(|it| it.1);
            let before = match reset {
                Some(value) => self.at_end(j, value),
                None => self.of_phase(j, Symbol::AtEnd(index)),
            };
            let start = self.of_phase(j + 1, Symbol::AtStart(index));
            let gap = match self.at_rest(j + 1, index) {
                Some(approach) => approach,
                None => self.graph.sub(start, before),
            };
            rows.push(row(format!("{} after {}", state.place.name, jump.place.name), gap));
        }
        Link { ends: vec![End::Last(j), End::First(j + 1)], objective: None, rows }
    }

    /// That a phase does not end before it begins; it is told by the jump before or after it.
    fn duration(&mut self, j: usize, word: &str) -> Constraint {
        let place = &self.jump(j.min(self.sequence.len() - 1)).place;
        Constraint {
            place: Place { name: format!("time {word} {}", place.name), span: place.span },
            value: self.graph.sub(self.times[j + 1], self.times[j]),
            range: self.not_below(),
        }
    }

    /// What is written of the ends of the whole time.
    pub(super) fn link_of_whole(&mut self, shares: &Shares) -> Option<Link> {
        let rows: Vec<Constraint> = (self.model.boundary.iter())
            .map(|row| Constraint { value: self.of_whole(row.value), ..row.clone() })
            .collect();
        let objective = shares.linked.map(|value| self.of_whole(value));
        let last = self.sequence.len();
        let between = if shares.integrals.is_empty() { 0..0 } else { 0..last };
        let ends = std::iter::once(End::First(0))
            .chain(between.map(End::Last))
            .chain(std::iter::once(End::Last(last)))
            .collect();
        (objective.is_some() || !rows.is_empty()).then_some(Link { ends, objective, rows })
    }

    /// A symbol of a phase, as links read it.
    pub(super) fn of_phase(&mut self, phase: usize, symbol: Symbol) -> ExprId {
        let input = self.model.input_of(symbol).expect("a phase has all symbols that links read");
        let symbol = Symbol::OfPhase { phase, input };
        let at = self.symbols.iter().position(|known| *known == symbol).unwrap_or_else(|| {
            self.symbols.push(symbol);
            self.symbols.len() - 1
        });
        self.graph.input(at as u32)
    }

    /// A function of time, state and control at the end of a phase.
    pub(super) fn at_end(&mut self, j: usize, value: ExprId) -> ExprId {
        self.with_symbols(value, &mut |own, symbol| match symbol {
            Symbol::Time => Some(own.times[j + 1]),
            Symbol::State(at) => Some(own.of_phase(j, Symbol::AtEnd(at))),
            Symbol::Control(at) => Some(own.of_phase(j, Symbol::ControlAtEnd(at))),
            _ => None,
        })
    }

    /// What is said of the whole time: it begins with the first phase, ends with the last, and
    /// integrals add up.
    pub(super) fn of_whole(&mut self, value: ExprId) -> ExprId {
        let last = self.sequence.len();
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
    fn with_symbols(
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
