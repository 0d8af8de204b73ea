//! FDC0410: starts, ends, bounds and path conditions that exclude each other at the start or at the
//! end.
//!
//! Every symbol has an interval: its bounds, a start value, a parameter's value. Conditions are
//! taken in turn. One whose value cannot lie where it must, by interval arithmetic over what is
//! known by then, contradicts what has made it known; any other one that is affine in a single
//! unknown makes more known.

use crate::check::facts::Facts;
use crate::expressions::graph::derivative::derivative;
use crate::expressions::graph::{ExprId, evaluate};
use crate::expressions::interval::{Interval, Tape};
use crate::model::{Constraint, Range, Symbol};
use crate::resolve::elaborator::Elaborator;
use fdcc_grammar::{Code, Diagnostic, Span};
use std::collections::HashMap;

/// Rounding does not count.
const TOLERANCE: f64 = 1e-9;

/// Nobody reads the contradictions of so many conditions.
const MOST_ROWS: usize = 500;

/// Reports each condition that cannot hold together with what stands above it.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let rows = rows(facts.meaning);
    let mut known = Known::new(facts.meaning);
    for (row, point) in rows.into_iter().take(MOST_ROWS) {
        if let Some(others) = known.contradiction(facts.meaning, &row) {
            found.push(told(&row, point, &others));
        } else {
            known.learn(facts.meaning, &row);
        }
    }
}

/// Conditions at the ends, then path conditions at the start and at the end.
fn rows(meaning: &mut Elaborator<'_>) -> Vec<(Constraint, &'static str)> {
    let at_end = meaning.at_end.clone();
    let point = |is_end: bool| if is_end { "the end" } else { "the start" };
    let boundary = meaning.model.boundary.clone().into_iter();
    let mut all: Vec<(Constraint, &'static str)> =
        boundary.zip(at_end).map(|(row, end)| (row, point(end))).collect();
    for end in [false, true] {
        let path = meaning.model.path.clone();
        let moved = meaning.move_to_end(path.iter().map(|row| row.value).collect(), end);
        all.extend(
            path.into_iter()
                .zip(moved)
                .map(|(row, value)| (Constraint { value, ..row }, point(end))),
        );
    }
    all
}

/// What is known about every symbol and every condition's value.
struct Known {
    /// For each symbol.
    domain: Vec<Interval>,
    /// What says so.
    because: Vec<Vec<Span>>,
    /// Where values that are no symbols must lie, and what says so.
    values: HashMap<ExprId, (Interval, Span)>,
}

impl Known {
    fn new(meaning: &Elaborator<'_>) -> Self {
        let all = meaning.symbols.iter().map(|symbol| of_symbol(meaning, *symbol));
        let (domain, because) = all.unzip();
        Known { domain, because, values: HashMap::new() }
    }

    /// What excludes a condition.
    fn contradiction(&self, meaning: &Elaborator<'_>, row: &Constraint) -> Option<Vec<Span>> {
        let allowed = interval(meaning, row.range);
        if let Some((before, span)) = self.values.get(&row.value)
            && are_apart(*before, allowed)
        {
            return Some(vec![*span]);
        }
        let mut tape = Tape::new(&meaning.graph, &[row.value]);
        let inputs: Vec<u32> = tape.inputs().collect();
        let possible = tape.evaluate(&self.domain)[0];
        let spans = || inputs.iter().flat_map(|&at| self.because[at as usize].clone()).collect();
        are_apart(possible, allowed).then(spans)
    }

    fn learn(&mut self, meaning: &mut Elaborator<'_>, row: &Constraint) {
        let allowed = interval(meaning, row.range);
        let known = self.values.entry(row.value).or_insert((Interval::ALL, row.place.span));
        *known = (known.0.intersect(allowed), row.place.span);
        let Some((input, inner)) = affine(meaning, row.value, allowed) else { return };
        let narrower = self.domain[input as usize].intersect(inner);
        if !narrower.is_empty() && narrower != self.domain[input as usize] {
            self.domain[input as usize] = narrower;
            self.because[input as usize].push(row.place.span);
        }
    }
}

/// The bounds of a symbol, and what says so.
fn of_symbol(meaning: &Elaborator<'_>, symbol: Symbol) -> (Interval, Vec<Span>) {
    let model = &meaning.model;
    let (range, place, start) = match symbol {
        Symbol::Param(at) => {
            return (point(meaning.param_values[at]), vec![model.params[at].place.span]);
        }
        Symbol::Selector(_) => return (Interval::new(-1.0, 1.0), Vec::new()),
        Symbol::Free(at) => (model.frees[at].range, &model.frees[at].place, None),
        Symbol::Control(at) => (model.controls[at].range, &model.controls[at].place, None),
        Symbol::State(at) | Symbol::AtEnd(at) => {
            (model.states[at].range, &model.states[at].place, None)
        }
        Symbol::AtStart(at) => (model.states[at].range, &model.states[at].place, Some(at)),
        _ => return (Interval::ALL, Vec::new()),
    };
    let own = interval(meaning, range);
    let own = start.map_or(own, |at| {
        let state = &model.states[at];
        let given = state.start.map_or(Interval::ALL, |it| point(meaning.numeric(it)));
        let free = state.start_range.map_or(Interval::ALL, |it| interval(meaning, it));
        let start = given.intersect(free);
        // A start outside of its bounds is told as such.
        Some(own.intersect(start)).filter(|it| !it.is_empty()).unwrap_or(start)
    });
    (if own.is_empty() { Interval::ALL } else { own }, vec![place.span])
}

/// A number; anything if it is not known.
fn point(value: f64) -> Interval {
    if value.is_finite() { Interval::point(value) } else { Interval::ALL }
}

fn interval(meaning: &Elaborator<'_>, range: Range) -> Interval {
    let [lower, upper] = [range.lower, range.upper].map(|end| meaning.numeric(end));
    let lower = if lower.is_nan() { f64::NEG_INFINITY } else { lower };
    let upper = if upper.is_nan() { f64::INFINITY } else { upper };
    if lower <= upper { Interval::new(lower, upper) } else { Interval::ALL }
}

/// Whether two intervals have nothing in common, not even up to rounding.
fn are_apart(a: Interval, b: Interval) -> bool {
    let gap = (a.lower - b.upper).max(b.lower - a.upper);
    let size = [a.lower, a.upper, b.lower, b.upper].into_iter().filter(|it| it.is_finite());
    !a.is_empty() && gap > TOLERANCE * size.fold(1.0, |most: f64, it| most.max(it.abs()))
}

/// The only unknown of an expression that is affine in it, and where it lies if the expression lies
/// in an interval.
fn affine(
    meaning: &mut Elaborator<'_>,
    value: ExprId,
    allowed: Interval,
) -> Option<(u32, Interval)> {
    let [input] = unknowns(meaning, value)[..] else { return None };
    let slope = derivative(&mut meaning.graph, value, input);
    if !unknowns(meaning, slope).is_empty() {
        return None;
    }
    let slope = meaning.numeric(slope);
    let mut inputs: Vec<f64> =
        meaning.symbols.iter().map(|symbol| of_param(meaning, *symbol)).collect();
    inputs[input as usize] = 0.0;
    let offset = evaluate(&meaning.graph, &[value], &inputs, &[])[0];
    let ends = [allowed.lower, allowed.upper].map(|end| (end - offset) / slope);
    let is_known = slope != 0.0 && ends.iter().all(|end| !end.is_nan());
    is_known.then(|| (input, Interval::new(ends[0].min(ends[1]), ends[0].max(ends[1]))))
}

/// What an expression reads that has no value yet.
fn unknowns(meaning: &Elaborator<'_>, id: ExprId) -> Vec<u32> {
    let is_fixed = |input: &u32| matches!(meaning.symbols[*input as usize], Symbol::Param(_));
    meaning.graph.inputs_of(&[id]).into_iter().filter(|input| !is_fixed(input)).collect()
}

fn of_param(meaning: &Elaborator<'_>, symbol: Symbol) -> f64 {
    match symbol {
        Symbol::Param(at) => meaning.param_values[at],
        _ => f64::NAN,
    }
}

fn told(row: &Constraint, point: &str, others: &[Span]) -> Diagnostic {
    let name = &row.place.name;
    let message = format!("`{name}` cannot hold at {point}");
    let mut found = Diagnostic::new(Code::Contradiction, message, row.place.span, "excluded");
    let mut told = vec![row.place.span];
    for span in others {
        if !told.contains(span) {
            told.push(*span);
            found = found.label(*span, "by this");
        }
    }
    found.help(
        "no trajectory satisfies both: change a value, widen the bounds, or leave one \
                condition out",
    )
}
