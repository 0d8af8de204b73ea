//! The numbers of a model once its parameters have values: bounds, starts, guesses of the unknowns.

use super::guess::between;
use crate::expressions::graph::{ExprId, evaluate};
use crate::model::{Model, Range, Symbol};
use crate::syntax::text;
use fdcc_grammar::{Code, Diagnostic, Span};
use fdcc_runtime::problem::Bounds;
use std::collections::HashMap;

/// Values for all parameters and unknowns.
#[derive(Clone, Debug)]
pub struct Numbers {
    /// One for each input of the model's graph; NaN for what is no number.
    inputs: Vec<f64>,
    /// Which input is which symbol.
    places: HashMap<Symbol, usize>,
}

/// Computes parameters in their order, then the guesses of the unknowns. Says which parameters have
/// no value, and which widths those of the command line leave no room.
pub fn numbers(model: &Model) -> Result<Numbers, Vec<Diagnostic>> {
    let missing = model.params.iter().filter(|param| param.value.is_none());
    let missing: Vec<Diagnostic> =
        missing.map(|param| missing_value(&param.place.name, param.place.span)).collect();
    if !missing.is_empty() {
        return Err(missing);
    }
    let mut numbers = Numbers::of_nothing(model);
    for &index in &model.param_order {
        numbers.compute_param(model, index);
    }
    numbers.guess_unknowns(model);
    let widths = model.widths.iter().map(|&(place, width)| (place, numbers.value(model, width)));
    let gone: Vec<Diagnostic> =
        widths.filter(|it| it.1 <= 0.0).map(|(place, width)| no_width(place, width)).collect();
    if gone.is_empty() { Ok(numbers) } else { Err(gone) }
}

impl Numbers {
    /// Nothing has a value yet.
    pub(crate) fn of_nothing(model: &Model) -> Self {
        let places = model.symbols.iter().enumerate().rev();
        let places = places.map(|(at, symbol)| (*symbol, at)).collect();
        Numbers { inputs: vec![f64::NAN; model.symbols.len()], places }
    }

    /// The value of a parameter, once those that it is made of have theirs.
    pub(crate) fn compute_param(&mut self, model: &Model, index: usize) -> f64 {
        let value = model.params[index].value.map_or(f64::NAN, |value| self.value(model, value));
        self.set(Symbol::Param(index), value);
        value
    }

    /// The value of an expression over parameters and unknowns.
    pub fn value(&self, model: &Model, id: ExprId) -> f64 {
        match model.graph.as_number(id) {
            Some(value) => value,
            None => evaluate(&model.graph, &[id], &self.inputs, &[])[0],
        }
    }

    /// Bounds as numbers.
    pub fn bounds(&self, model: &Model, range: Range) -> Bounds {
        Bounds { lower: self.value(model, range.lower), upper: self.value(model, range.upper) }
    }

    /// One for each symbol of the model.
    pub(crate) fn inputs(&self) -> &[f64] {
        &self.inputs
    }

    /// The value of a parameter or unknown.
    pub fn of(&self, symbol: Symbol) -> f64 {
        self.places.get(&symbol).map_or(f64::NAN, |&input| self.inputs[input])
    }

    fn set(&mut self, symbol: Symbol, value: f64) {
        if let Some(&input) = self.places.get(&symbol) {
            self.inputs[input] = value;
        }
    }

    /// Unknowns without a guess are in the middle of their bounds, or 1. A guess may use other
    /// unknowns, so the guesses are computed until nothing changes.
    fn guess_unknowns(&mut self, model: &Model) {
        for (index, free) in model.frees.iter().enumerate() {
            let bounds = self.bounds(model, free.range);
            let finite = bounds.lower.is_finite() && bounds.upper.is_finite();
            let value = if finite {
                between(bounds.lower, bounds.upper, model.unit_size(&free.place.name))
            } else {
                1.0_f64.max(bounds.lower).min(bounds.upper)
            };
            self.set(Symbol::Free(index), value);
        }
        for _ in 0..model.frees.len() {
            let before = self.inputs.clone();
            for (index, free) in model.frees.iter().enumerate() {
                if let Some(guess) = free.guess {
                    let value = self.value(model, guess);
                    self.set(Symbol::Free(index), value);
                }
            }
            if before.iter().zip(&self.inputs).all(|(a, b)| a.to_bits() == b.to_bits()) {
                break;
            }
        }
    }
}

/// The finding, also for a run that gave no value.
pub(crate) fn missing_value(name: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::NoValue,
        format!("parameter `{name}` has no value"),
        span,
        "how large is it?",
    )
    .help(format!("write `param {name} = 1`, or give it for one run: `--set {name}=1`"))
}

/// The width of a `blend` that is not above 0.
pub(crate) fn no_width(width: Span, size: f64) -> Diagnostic {
    let message = format!("a width of {} rounds nothing", text::number(size));
    Diagnostic::new(Code::NotAllowedHere, message, width, "must be above 0").help(
        "write over which width each knot is to be rounded, in the unit of its guard, for \
               example 0.05",
    )
}
