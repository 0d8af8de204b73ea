//! FDC0409: a guess outside the bounds of what it guesses.

use super::Preflight;
use super::layer::short;
use crate::expressions::graph::ExprId;
use crate::model::{Place, Range, Symbol};
use crate::syntax::text;
use crate::units;
use fdcc_grammar::ast::{Interval, ItemKind};
use fdcc_grammar::{Code, Diagnostic, Span};

/// Rounding does not count.
const TOLERANCE: f64 = 1e-9;

/// Reports each variable whose guess leaves its bounds, once.
pub(super) fn check(preflight: &Preflight<'_>, found: &mut Vec<Diagnostic>) {
    let model = preflight.model;
    let states = model.states.iter().enumerate().filter(|(_, it)| it.guess.is_some());
    let states = states.map(|(at, it)| (Symbol::State(at), &it.place, it.range));
    let controls = model.controls.iter().enumerate().filter(|(_, it)| it.guess.is_some());
    let controls = controls.map(|(at, it)| (Symbol::Control(at), &it.place, it.range));
    let frees = model.frees.iter().enumerate().filter(|(_, it)| it.guess.is_some());
    let frees = frees.map(|(at, it)| (Symbol::Free(at), &it.place, it.range));
    for (symbol, place, range) in states.chain(controls).chain(frees) {
        found.extend(outside(preflight, symbol, place, range));
    }
}

fn outside(
    preflight: &Preflight<'_>,
    symbol: Symbol,
    place: &Place,
    range: Range,
) -> Option<Diagnostic> {
    let input = preflight.model.input_of(symbol)?;
    let values = || preflight.points.iter().map(|inputs| inputs[input as usize]);
    let bound = |bound: ExprId| preflight.numbers.value(preflight.model, bound);
    let (lower, upper) = (bound(range.lower), bound(range.upper));
    let (least, most) =
        (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let beyond = |value: f64, limit: f64| TOLERANCE * (1.0 + limit.abs()) < value - limit;
    let scale = preflight.unit(&place.name).map_or(1.0, |unit| units::scale(unit, &mut Vec::new()));
    let shown = |value: f64| text::number(short(value / scale));
    let (reached, limit) = match () {
        _ if beyond(-least, -lower) => {
            (format!("falls to {}", shown(least)), format!("at least {}", shown(lower)))
        }
        _ if beyond(most, upper) => {
            (format!("rises to {}", shown(most)), format!("at most {}", shown(upper)))
        }
        _ => return None,
    };
    let (guess, bounds) = places(preflight, &place.name)?;
    let is_number = matches!(symbol, Symbol::Free(_));
    let reached = if is_number {
        reached.replace("falls to", "is").replace("rises to", "is")
    } else {
        reached
    };
    let message = format!("the guess of `{}` is outside its bounds", place.name);
    let found = Diagnostic::new(Code::GuessOutside, message, guess, format!("{reached} here"));
    Some(found.label(bounds, format!("but it is {limit}")).help(
        "the solver moves a guess into the bounds before it begins, and what it begins with is no \
         longer what is written; guess a value inside, or widen the bounds",
    ))
}

/// Where a variable is guessed, and where it has its bounds.
fn places(preflight: &Preflight<'_>, name: &str) -> Option<(Span, Span)> {
    let span = |bounds: &Option<Interval>| bounds.as_ref().map(|bounds| bounds.span);
    let whole = name.split(['.', '[']).next()?;
    let bindings = preflight.tree.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Guess { bindings } => Some(bindings),
        _ => None,
    });
    let binding =
        bindings.flatten().find(|binding| binding.name.name == whole).map(|it| it.value.span);
    let (own, bounds) = match &preflight.declaration(name)?.kind {
        ItemKind::State { bounds, .. } => (None, span(bounds)?),
        ItemKind::Control { bounds, guess, .. } | ItemKind::Free { bounds, guess, .. } => {
            (guess.as_ref().map(|guess| guess.span), span(bounds)?)
        }
        _ => return None,
    };
    Some((binding.or(own)?, bounds))
}
