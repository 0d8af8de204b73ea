//! Phases that are simulated one after the other: each begins where the links put it.
//!
//! A link is a row `x_first - r(x_last, u_last, p)`, bounded by 0 on both sides. With everything
//! known but one state at the first time of a phase, the row says what that is.

use crate::expressions::graph::evaluate;
use crate::model::numbers::numbers;
use crate::model::{Constraint, Model, Symbol};
use fdcc_grammar::Diagnostic;

/// How a phase went: its states and controls at its first and at its last time.
pub struct Ends<'e> {
    /// In the order of the phase; what is left out is unknown.
    pub states: [&'e [f64]; 2],
    /// The same.
    pub controls: [&'e [f64]; 2],
}

/// A model with phases, some of which have ended.
pub struct Course<'m> {
    whole: &'m Model,
    /// One for each symbol of the whole; not a number while it is unknown.
    inputs: Vec<f64>,
}

impl<'m> Course<'m> {
    /// Nothing has happened yet.
    ///
    /// # Errors
    ///
    /// A parameter without a value.
    pub fn new(whole: &'m Model) -> Result<Self, Vec<Diagnostic>> {
        Ok(Course { whole, inputs: numbers(whole)?.inputs().to_vec() })
    }

    /// A phase with its open states where the links from phases that have ended put them.
    pub fn phase(&self, at: usize) -> Model {
        let mut own = self.whole.phases[at].model.clone();
        for state in 0..own.states.len() {
            if let Some(start) =
                self.handed_over(at, state).filter(|_| own.states[state].start.is_none())
            {
                own.states[state].start = Some(own.graph.number(start));
            }
        }
        own
    }

    /// What a phase was at its ends.
    pub fn ended(&mut self, at: usize, ends: &Ends) {
        let own = &self.whole.phases[at].model;
        let all = self.whole.symbols.iter().zip(&mut self.inputs);
        for (symbol, value) in all {
            let Symbol::OfPhase { phase, input } = *symbol else { continue };
            let found = match own.symbols.get(input as usize).filter(|_| phase == at) {
                Some(Symbol::AtStart(state)) => ends.states[0].get(*state),
                Some(Symbol::AtEnd(state)) => ends.states[1].get(*state),
                Some(Symbol::ControlAtStart(control)) => ends.controls[0].get(*control),
                Some(Symbol::ControlAtEnd(control)) => ends.controls[1].get(*control),
                _ => None,
            };
            *value = found.copied().unwrap_or(*value);
        }
    }

    /// What the links add to the objective; not a number where that needs more than ends.
    pub fn objective_of_links(&self) -> f64 {
        let parts = self.whole.links.iter().filter_map(|it| it.objective);
        let value = |part| evaluate(&self.whole.graph, &[part], &self.inputs, &[])[0];
        parts.map(value).sum()
    }

    /// The state of a phase at its first time, by a link that reads no other that is unknown.
    fn handed_over(&self, phase: usize, state: usize) -> Option<f64> {
        let own = &self.whole.phases[phase].model;
        let wanted = Symbol::OfPhase { phase, input: own.input_of(Symbol::AtStart(state))? };
        let wanted = self.whole.input_of(wanted)?;
        let rows = self.whole.links.iter().flat_map(|link| &link.rows);
        rows.filter_map(|row| self.solved(row, wanted)).next()
    }

    /// The value of an input with which a row, which is linear in it, is at its bound.
    fn solved(&self, row: &Constraint, wanted: u32) -> Option<f64> {
        let graph = &self.whole.graph;
        let reads = graph.inputs_of(&[row.value]);
        if !reads.contains(&wanted) {
            return None;
        }
        let mut inputs = self.inputs.clone();
        let mut value = |at: f64| {
            inputs[wanted as usize] = at;
            evaluate(graph, &[row.value, row.range.lower], &inputs, &[])
        };
        let [none, one] = [value(0.0), value(1.0)];
        let found = (none[1] - none[0]) / (one[0] - none[0]);
        Some(found).filter(|it| it.is_finite())
    }
}
