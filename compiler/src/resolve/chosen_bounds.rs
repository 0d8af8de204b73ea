//! Bounds of signals that the optimiser chooses, `state x in [0, m]` with `free m`, are conditions
//! at all times.

use crate::expressions::graph::ExprId;
use crate::model::{Constraint, Model, Place, Range, Symbol};

impl Model {
    /// Makes path conditions of all bounds of states and controls that read an unknown.
    pub(crate) fn bounds_as_conditions(&mut self) {
        for at in 0..self.states.len() {
            let (place, range) = (self.states[at].place.clone(), self.states[at].range);
            self.states[at].range = self.fixed_part(Symbol::State(at), &place, range);
        }
        for at in 0..self.controls.len() {
            let (place, range) = (self.controls[at].place.clone(), self.controls[at].range);
            self.controls[at].range = self.fixed_part(Symbol::Control(at), &place, range);
        }
    }

    /// What is left of the bounds of a signal.
    fn fixed_part(&mut self, signal: Symbol, place: &Place, range: Range) -> Range {
        let open = [f64::NEG_INFINITY, f64::INFINITY].map(|it| self.graph.number(it));
        let Some(input) = self.input_of(signal) else { return range };
        let value = self.graph.input(input);
        let Range { mut lower, mut upper } = range;
        if self.is_chosen(lower) {
            self.keep_apart([lower, value], format!("lower bound of {}", place.name), place);
            lower = open[0];
        }
        if self.is_chosen(upper) {
            self.keep_apart([value, upper], format!("upper bound of {}", place.name), place);
            upper = open[1];
        }
        Range { lower, upper }
    }

    fn is_chosen(&self, bound: ExprId) -> bool {
        let inputs = self.graph.inputs_of(&[bound]);
        inputs.iter().any(|it| matches!(self.symbols[*it as usize], Symbol::Free(_)))
    }

    /// The first of two is never above the second.
    fn keep_apart(&mut self, [low, high]: [ExprId; 2], name: String, of: &Place) {
        let value = self.graph.sub(low, high);
        let [lower, upper] = [f64::NEG_INFINITY, 0.0].map(|it| self.graph.number(it));
        let place = Place { name, span: of.span };
        self.path.push(Constraint { place, value, range: Range { lower, upper } });
    }
}
