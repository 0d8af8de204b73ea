//! Declarations: each name gets its symbols, then definitions, bounds and starts their values.

use crate::expressions::graph::ExprId;
use crate::model::{Control, Definition, Free, Param, Place, Range, State, Symbol};
use crate::resolve::elaborator::context::Context;
use crate::resolve::elaborator::value::{Parts, Reads, Traits, Value};
use crate::resolve::elaborator::{Elaborator, Role};
use crate::syntax::{order, scope};
use fdcc_grammar::ast::{Expr, Ident, Interval, ItemKind, Start};

impl<'a> Elaborator<'a> {
    /// Symbols for all names, then the values of all definitions.
    pub fn declare_all(&mut self) {
        for at in 0..self.scope.declarations.len() {
            self.declare(at);
        }
        for state in 0..self.model.states.len() {
            let ends =
                [Symbol::AtStart(state), Symbol::AtEnd(state)].map(|symbol| self.symbol(symbol));
            self.at_ends[0].push(ends[0]);
            self.at_ends[1].push(ends[1]);
        }
        let outer = [self.model.params.len(), self.model.frees.len()];
        self.adopt_phases();
        let order = order::order(&self.scope, &mut self.diagnostics);
        self.circular = order.circular;
        for at in order.sequence {
            self.here.owner = Some(at);
            self.define(at);
        }
        self.here.owner = None;
        for at in 0..self.scope.declarations.len() {
            self.bound(at);
        }
        self.adopt_values(outer);
    }

    /// The symbols of a name.
    fn declare(&mut self, at: usize) {
        let declaration = self.scope.declarations[at];
        let place = place(declaration.name);
        match &declaration.item.kind {
            ItemKind::Time { .. } => {
                let part = self.symbol(Symbol::Time);
                self.time = self.time.or(Some(self.symbols.len() as u32 - 1));
                self.values[at] = Value::symbols(Parts::Scalar(part), Reads::TIME, at);
            }
            ItemKind::Param { .. } => {
                let part = self.symbol(Symbol::Param(self.model.params.len()));
                let range = self.everything();
                self.model.params.push(Param { place, value: None, range });
                self.param_values.push(f64::NAN);
                self.values[at] = Value::symbols(Parts::Scalar(part), Reads::PARAM, at);
            }
            ItemKind::Free { .. } => {
                let part = self.symbol(Symbol::Free(self.model.frees.len()));
                let range = self.everything();
                self.model.frees.push(Free { place, range, guess: None });
                self.values[at] = Value::symbols(Parts::Scalar(part), Reads::FREE, at);
            }
            ItemKind::State { parts, .. } => self.declare_states(at, parts),
            ItemKind::Control { parts, .. } => self.declare_controls(at, parts),
            ItemKind::Surface { .. } => {
                let surface = self.add_surface(place, None);
                self.surface_of.insert(at, surface);
            }
            _ => {}
        }
    }

    fn declare_states(&mut self, at: usize, parts: &'a [Ident]) {
        scope::distinct(parts, &mut self.diagnostics);
        let range = self.everything();
        let rate = range.lower;
        let mut list = Vec::new();
        for place in places(self.scope.declarations[at].name, parts) {
            list.push(self.symbol(Symbol::State(self.model.states.len())));
            let equation = Place { name: format!("{}'", place.name), span: place.span };
            self.model.states.push(State {
                place,
                range,
                start: None,
                start_range: None,
                rate,
                equation,
                guess: None,
            });
        }
        self.values[at] = Value::symbols(Parts::from_list(&list), Reads::STATE, at);
    }

    fn declare_controls(&mut self, at: usize, parts: &'a [Ident]) {
        scope::distinct(parts, &mut self.diagnostics);
        let range = self.everything();
        let mut list = Vec::new();
        for place in places(self.scope.declarations[at].name, parts) {
            list.push(self.symbol(Symbol::Control(self.model.controls.len())));
            self.model.controls.push(Control { place, range, guess: None });
        }
        self.values[at] = Value::symbols(Parts::from_list(&list), Reads::CONTROL, at);
    }

    /// No bounds.
    pub(super) fn everything(&mut self) -> Range {
        Range {
            lower: self.graph.number(f64::NEG_INFINITY),
            upper: self.graph.number(f64::INFINITY),
        }
    }

    /// The value of a definition; all that it mentions has been defined.
    fn define(&mut self, at: usize) {
        let item = self.scope.declarations[at].item;
        match &item.kind {
            ItemKind::Const { value, .. } => {
                let value = self.evaluate_for(Role::Number("a constant"), Context::NUMBER, value);
                self.keep_definition(at, &[], &value.parts);
                self.values[at] = value;
            }
            ItemKind::Let { value, .. } => {
                let value = self.evaluate_in(Context::DEFINITION, value);
                self.define_as(at, value);
            }
            ItemKind::Signal { value, .. } => self.define_signal(at, value),
            ItemKind::Param { value: Some(value), .. } => self.define_param(at, value),
            ItemKind::Surface { value, name } => self.define_surface(at, name, value),
            ItemKind::Time { interval, .. } => self.time_interval(interval),
            ItemKind::Fn { name: _, arguments, body } => self.examine(at, arguments, body),
            _ => {}
        }
    }

    /// Gives a definition its value.
    pub(super) fn define_as(&mut self, at: usize, value: Value) {
        self.keep_definition(at, &[], &value.parts);
        self.values[at] = value;
        self.name_parts(at);
    }

    /// Notes what the components of a definition are called.
    fn name_parts(&mut self, at: usize) {
        let value = &self.values[at];
        let name = &self.scope.declarations[at].name.name;
        let parts = value.parts.as_slice().iter().enumerate();
        let named = parts.map(|(part, &id)| (self.component(name, value, part), id));
        let named: Vec<(String, ExprId)> = named.collect();
        self.model.names.extend(named);
    }

    /// For those who ask about it by name.
    fn keep_definition(&mut self, at: usize, arguments: &[Ident], parts: &Parts) {
        let name = self.scope.declarations[at].name.name.clone();
        let arguments = arguments.iter().map(|it| it.name.clone()).collect();
        self.model.definitions.push(Definition {
            name,
            arguments,
            parts: parts.as_slice().to_vec(),
        });
    }

    fn define_param(&mut self, at: usize, value: &'a Expr) {
        let value_of = self.evaluate_for(Role::Number("a parameter"), Context::NUMBER, value);
        let Some(part) = self.expect_number(&value_of, value.span) else { return };
        let Some(index) = self.index_of(at) else { return };
        self.param_values[index] = self.numeric(part);
        self.model.params[index].value = Some(part);
        self.model.param_order.push(index);
    }

    fn define_surface(&mut self, at: usize, name: &'a Ident, value: &'a Expr) {
        let value_of = self.evaluate_in(Context::SURFACE, value);
        self.note(Role::Surface(name), &value_of);
        let part = self.expect_number(&value_of, value.span);
        if let Some(&surface) = self.surface_of.get(&at) {
            self.surfaces[surface].psi = part;
        }
        self.values[at] = value_of;
    }

    /// Looks at a function by itself, so that mistakes are told even if nobody calls it.
    fn examine(&mut self, at: usize, arguments: &'a [Ident], body: &'a Expr) {
        scope::distinct(arguments, &mut self.diagnostics);
        while self.arguments.len() < arguments.len() {
            let argument = self.symbol(Symbol::Argument(self.arguments.len()));
            self.arguments.push(argument);
        }
        if self.circular[at] {
            return;
        }
        let values = self.arguments[..arguments.len()]
            .iter()
            .map(|&part| Value::scalar(part, Traits::default()));
        let values = values.collect();
        self.here.examining = true;
        let value = self.apply(at, arguments, body, values);
        self.here.examining = false;
        self.keep_definition(at, arguments, &value.parts);
    }

    /// Bounds, starts and guesses, which may use every definition.
    fn bound(&mut self, at: usize) {
        let item = self.scope.declarations[at].item;
        match &item.kind {
            ItemKind::Param { bounds: Some(bounds), .. } => {
                let range = self.ranges(Context::BOUND, bounds, 1)[0];
                if let Some(index) = self.index_of(at) {
                    self.model.params[index].range = range;
                }
            }
            ItemKind::Free { bounds, guess, .. } => {
                self.bound_free(at, bounds.as_ref(), guess.as_ref())
            }
            ItemKind::State { parts, bounds, start, .. } => {
                self.bound_state(at, parts.len().max(1), bounds.as_ref(), start.as_ref())
            }
            ItemKind::Control { parts, bounds, guess, .. } => {
                self.bound_control(at, parts.len().max(1), bounds.as_ref(), guess.as_ref())
            }
            _ => {}
        }
    }

    fn bound_free(&mut self, at: usize, bounds: Option<&'a Interval>, guess: Option<&'a Expr>) {
        let Some(index) = self.index_of(at) else { return };
        if let Some(bounds) = bounds {
            self.model.frees[index].range = self.ranges(Context::BOUND, bounds, 1)[0];
        }
        if let Some(guess) = guess {
            let value = self.evaluate_for(Role::Number("a guess"), Context::FREE_GUESS, guess);
            self.model.frees[index].guess = self.expect_number(&value, guess.span);
        }
    }

    fn bound_state(
        &mut self,
        at: usize,
        size: usize,
        bounds: Option<&'a Interval>,
        start: Option<&'a Start>,
    ) {
        let Some(first) = self.index_of(at) else { return };
        if let Some(bounds) = bounds {
            let ranges = self.ranges(Context::SIGNAL_BOUND, bounds, size);
            (0..size).for_each(|part| self.model.states[first + part].range = ranges[part]);
        }
        match start {
            Some(Start::Value(value)) => {
                let value_of =
                    self.evaluate_for(Role::Number("a start value"), Context::START, value);
                let parts = self.expect_parts(&value_of, size, value.span);
                let states = self.model.states[first..].iter_mut();
                states.zip(parts).for_each(|(state, part)| state.start = Some(part));
            }
            Some(Start::Free { bounds: Some(bounds), .. }) => {
                let ranges = self.ranges(Context::BOUND, bounds, size);
                (0..size).for_each(|part| {
                    self.model.states[first + part].start_range = Some(ranges[part])
                });
            }
            _ => {}
        }
    }

    fn bound_control(
        &mut self,
        at: usize,
        size: usize,
        bounds: Option<&'a Interval>,
        guess: Option<&'a Expr>,
    ) {
        let Some(first) = self.index_of(at) else { return };
        if let Some(bounds) = bounds {
            let ranges = self.ranges(Context::SIGNAL_BOUND, bounds, size);
            (0..size).for_each(|part| self.model.controls[first + part].range = ranges[part]);
        }
        if let Some(guess) = guess {
            let value = self.evaluate_for(Role::Number("a guess"), Context::GUESS, guess);
            let parts = self.expect_parts(&value, size, guess.span);
            self.model.controls[first..]
                .iter_mut()
                .zip(parts)
                .for_each(|(control, part)| control.guess = Some(part));
        }
    }

    /// The bounds of each component.
    fn ranges(&mut self, context: Context, interval: &'a Interval, size: usize) -> Vec<Range> {
        let [lower, upper] = [&interval.lower, &interval.upper].map(|expr| {
            let value = self.evaluate_for(Role::Number("a bound"), context, expr);
            let parts = self.expect_parts(&value, size, expr.span);
            parts.into_iter().map(|part| self.open(part)).collect::<Vec<ExprId>>()
        });
        let everything = self.everything();
        let pair = |part: usize| Range {
            lower: lower.get(part).copied().unwrap_or(everything.lower),
            upper: upper.get(part).copied().unwrap_or(everything.upper),
        };
        (0..size).map(pair).collect()
    }

    /// `-inf`, and `inf` in a unit, as numbers: who asks whether there is a bound looks for one.
    fn open(&mut self, bound: ExprId) -> ExprId {
        if self.graph.as_number(bound).is_some() || !self.graph.inputs_of(&[bound]).is_empty() {
            return bound;
        }
        let value = self.numeric(bound);
        if value.is_infinite() { self.graph.number(value) } else { bound }
    }

    /// The index of a declaration's first scalar among those of its kind.
    pub fn index_of(&self, at: usize) -> Option<usize> {
        self.index_of_value(&self.values[at])
    }

    /// The index of a value's first scalar, if that is one symbol.
    pub fn index_of_value(&self, value: &Value) -> Option<usize> {
        let first: ExprId = *value.parts.as_slice().first()?;
        let crate::expressions::graph::Expr::Input(input) = self.graph.expr(first) else {
            return None;
        };
        match self.symbols[*input as usize] {
            Symbol::State(index)
            | Symbol::Control(index)
            | Symbol::Param(index)
            | Symbol::Free(index) => Some(index),
            _ => None,
        }
    }
}

fn place(name: &Ident) -> Place {
    Place { name: name.name.clone(), span: name.span }
}

/// One place for each scalar: `pos.x` and `pos.y`, or the name itself.
fn places(name: &Ident, parts: &[Ident]) -> Vec<Place> {
    if parts.is_empty() {
        return vec![place(name)];
    }
    parts
        .iter()
        .map(|part| Place { name: format!("{}.{}", name.name, part.name), span: name.span })
        .collect()
}
