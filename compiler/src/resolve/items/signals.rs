//! Quantities that are given from outside: what the text says of them, or values at points.

use crate::expressions::curve::broken_line;
use crate::expressions::graph::ExprId;
use crate::model::{Param, Place, Signal, Symbol};
use crate::resolve::elaborator::Elaborator;
use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::value::{Parts, Reads, Traits, Value};
use fdcc_grammar::ast::Expr;

/// What is added to the time at which signals have the values of the text, as a parameter. The
/// blanks keep it apart from all names.
const TIME: &str = "time of signals";

impl<'a> Elaborator<'a> {
    /// The value of a signal.
    pub fn define_signal(&mut self, at: usize, value: &'a Expr) {
        let value = self.evaluate_in(Context::GIVEN, value);
        let names: Vec<Place> = self.places_of(at, &value);
        let value = match self.intervals {
            Some(intervals) => self.at_points(&names, &value, intervals),
            None => {
                let signal = |place| Signal { place, points: Vec::new() };
                self.model.signals.extend(names.into_iter().map(signal));
                value
            }
        };
        self.define_as(at, value);
    }

    fn places_of(&self, at: usize, value: &Value) -> Vec<Place> {
        let name = self.scope.declarations[at].name;
        let place = |part| Place { name: self.component(&name.name, value, part), span: name.span };
        (0..value.parts.as_slice().len()).map(place).collect()
    }

    /// Straight lines between values at points of equal distance, each a parameter that has the
    /// value of the text as long as no other is given.
    fn at_points(&mut self, names: &[Place], value: &Value, intervals: usize) -> Value {
        let passed = self.passed(intervals);
        let mut parts = Vec::new();
        for (place, &written) in names.iter().zip(value.parts.as_slice()) {
            let points: Vec<usize> =
                (0..=intervals).map(|k| self.point(place, written, k, intervals)).collect();
            let inputs: Vec<ExprId> =
                points.iter().map(|it| self.known_symbol(Symbol::Param(*it))).collect();
            parts.push(broken_line(&mut self.graph, &inputs, passed));
            self.model.signals.push(Signal { place: place.clone(), points });
        }
        let traits = Traits { reads: Reads::TIME.or(Reads::PARAM), ..value.traits.clone() };
        Value { parts: Parts::from_list(&parts), traits, ..value.clone() }
    }

    /// How many of the intervals have passed.
    fn passed(&mut self, intervals: usize) -> ExprId {
        let [first, last] = self.interval;
        let duration = self.graph.sub(last, first);
        let time = self.known_symbol(Symbol::Time);
        let since = self.graph.sub(time, first);
        let part = self.graph.div(since, duration);
        self.graph.scale(intervals as f64, part)
    }

    /// The value at a point.
    fn point(&mut self, place: &Place, written: ExprId, k: usize, intervals: usize) -> usize {
        let [first, last] = self.interval;
        let duration = self.graph.sub(last, first);
        let passed = self.graph.scale(k as f64 / intervals as f64, duration);
        let shift = self.shift();
        let time = self.graph.sum(&[first, passed, shift]);
        let symbols = &self.symbols;
        let at = |input: u32| (symbols[input as usize] == Symbol::Time).then_some(time);
        let value = self.graph.substitute(&[written], &at)[0];
        self.parameter(Place { name: format!("{} {k}", place.name), span: place.span }, value)
    }

    /// By how much the time of the text is ahead.
    fn shift(&mut self) -> ExprId {
        let known = self.model.signal_time;
        let at = known.unwrap_or_else(|| {
            let zero = self.graph.number(0.0);
            self.parameter(Place { name: TIME.into(), ..Place::default() }, zero)
        });
        self.model.signal_time = Some(at);
        self.known_symbol(Symbol::Param(at))
    }

    /// A parameter without a declaration.
    fn parameter(&mut self, place: Place, value: ExprId) -> usize {
        let at = self.model.params.len();
        self.known_symbol(Symbol::Param(at));
        let range = self.everything();
        self.param_values.push(self.numeric(value));
        self.model.params.push(Param { place, value: Some(value), range });
        self.model.param_order.push(at);
        at
    }
}
