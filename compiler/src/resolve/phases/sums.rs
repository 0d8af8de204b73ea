//! Sums over rows of measured data: each belongs to what it reads, the model or one of its phases;
//! one of states that stand outside of all phases has a part in each.

use crate::expressions::graph::{ById, ExprId};
use crate::model::{Sum, Symbol};
use crate::resolve::elaborator::Elaborator;
use fdcc_grammar::{Code, Diagnostic};

impl Elaborator<'_> {
    /// The value of a sum; nothing where it reads several phases.
    pub fn sum_over_rows(&mut self, sum: Sum) -> Option<ExprId> {
        let mut phases: Vec<usize> = Vec::new();
        for input in self.graph.inputs_of(&[sum.term]) {
            if let Symbol::OfPhase { phase, .. } = self.symbols[input as usize] {
                phases.push(phase);
            }
        }
        phases.sort_unstable();
        phases.dedup();
        match phases[..] {
            [] if self.phases.is_empty() => {
                let at = self.sum_like(sum);
                Some(self.known_symbol(Symbol::Sum(at)))
            }
            // What goes on through all phases: each has the rows of its time.
            [] => {
                let last = self.phases.len() - 1;
                let share = |phase| Sum { is_shared: [phase > 0, phase < last], ..sum.clone() };
                let shares: Vec<Sum> = (0..=last).map(share).collect();
                let terms = shares.into_iter().enumerate();
                let terms: Option<Vec<ExprId>> =
                    terms.map(|(phase, share)| self.sum_in(phase, share)).collect();
                Some(self.graph.sum(&terms?))
            }
            [phase] => self.sum_in(phase, sum),
            _ => {
                let message = "a row at the times of two phases";
                let label = "each phase has its own time";
                let found = Diagnostic::new(Code::NotAllowedHere, message, sum.place.span, label);
                self.diagnostics.push(found.help("write a sum for each phase and add them up"));
                None
            }
        }
    }

    /// The value of a sum of a phase.
    fn sum_in(&mut self, phase: usize, sum: Sum) -> Option<ExprId> {
        let at = self.sum_of_phase(phase, sum);
        let own = self.phases[phase].meaning.known_symbol(Symbol::Sum(at));
        self.import(phase, &[own]).pop()
    }

    /// A sum of the model, a new one if there is none like it.
    fn sum_like(&mut self, sum: Sum) -> usize {
        let is_it = |it: &Sum| (it.term, it.time, it.table) == (sum.term, sum.time, sum.table);
        self.model.sums.iter().position(is_it).unwrap_or_else(|| {
            self.model.sums.push(sum);
            self.model.sums.len() - 1
        })
    }

    /// The same of a phase, which may have the table at another place.
    fn sum_of_phase(&mut self, phase: usize, sum: Sum) -> usize {
        let Elaborator { phases, graph, symbols, model, .. } = self;
        let meaning = &mut phases[phase].meaning;
        let table = &model.tables[sum.table];
        let known = meaning.model.tables.iter().position(|it| it.is(table.place, &table.file));
        let at = known.unwrap_or_else(|| {
            meaning.model.tables.push(table.clone());
            meaning.model.tables.len() - 1
        });
        let mut places = ById::default();
        for input in graph.inputs_of(&[sum.term, sum.time]) {
            let place = match symbols[input as usize] {
                Symbol::OfPhase { input, .. } => meaning.graph.input(input),
                Symbol::Column(_, column) => meaning.known_symbol(Symbol::Column(at, column)),
                symbol => meaning.known_symbol(symbol),
            };
            places.insert(graph.input(input), place);
        }
        let roots = [sum.term, sum.time];
        let copy = meaning
            .graph
            .import(graph, &roots, &mut places, &mut |graph, input| graph.input(input));
        meaning.sum_like(Sum { table: at, term: copy[0], time: copy[1], ..sum })
    }
}
