//! FDC0410: starts, ends, bounds and path conditions that exclude each other at the start or at the
//! end.
//!
//! Every symbol has an interval: its bounds, a start value, a parameter's value. Conditions are
//! taken in turn. One whose value cannot lie where it must, by interval arithmetic or by its sign
//! over what is known by then, contradicts what has made it known; any other one narrows what its
//! unknowns can be, and so, in turn, do those above it that share an unknown.

use crate::check::facts::Facts;
use crate::expressions::graph::ExprId;
use crate::expressions::interval::{Interval, Signs, Tape, signs};
use crate::model::{Constraint, Place, Range, Symbol};
use crate::resolve::elaborator::Elaborator;
use fdcc_grammar::{Code, Diagnostic, Span};
use std::collections::HashMap;

/// Rounding does not count.
const TOLERANCE: f64 = 1e-9;

/// Nobody reads the contradictions of so many conditions.
const MOST_ROWS: usize = 500;

/// Narrowing that goes on for so long converges slowly: `x == y/2` and `y == x/2`.
const MOST_STEPS: usize = 4_000;

/// An interval that shrinks by less, relative to its size, tells nothing new.
const PROGRESS: f64 = 1e-3;

/// Reports each condition that cannot hold together with what stands above it.
pub(crate) fn check(facts: &mut Facts<'_, '_>, found: &mut Vec<Diagnostic>) {
    let rows = rows(facts.meaning);
    let mut known = Known::new(facts.meaning);
    for row in rows.into_iter().take(MOST_ROWS) {
        if let Some(others) = known.contradiction(facts.meaning, &row) {
            found.push(told(&row, &others));
        } else {
            known.learn(facts.meaning, &row);
        }
    }
}

/// A condition at one of the ends.
struct Row {
    /// Its value there, and where that must lie.
    constraint: Constraint,
    /// In the words of a message.
    point: &'static str,
    /// Whether it says the same at all times, also of controls.
    is_timeless: bool,
}

impl Row {
    fn new(constraint: Constraint, at_end: bool) -> Row {
        let point = if at_end { "the end" } else { "the start" };
        Row { constraint, point, is_timeless: false }
    }
}

/// Starts that are formulas, conditions at the ends, then path conditions at the start and at the
/// end; conditions at times between them.
fn rows(meaning: &mut Elaborator<'_>) -> Vec<Row> {
    let mut all = starts(meaning);
    let boundary = meaning.model.boundary.iter().zip(&meaning.at_end);
    all.extend(boundary.map(|(row, at_end)| Row::new(row.clone(), *at_end)));
    for at_end in [false, true] {
        let path = meaning.model.path.clone();
        let moved = meaning.move_to_end(path.iter().map(|row| row.value).collect(), at_end);
        all.extend(path.into_iter().zip(moved).map(|(row, value)| {
            let is_timeless = value == row.value;
            Row { is_timeless, ..Row::new(Constraint { value, ..row }, at_end) }
        }));
    }
    let at_times = meaning.model.at_times.iter().flat_map(|it| &it.rows).cloned();
    all.extend(at_times.map(|row| Row { point: "that time", ..Row::new(row, false) }));
    all
}

/// `start a` with an unknown `a`; a number is known beforehand.
fn starts(meaning: &mut Elaborator<'_>) -> Vec<Row> {
    let zero = meaning.graph.number(0.0);
    let mut all = Vec::new();
    for at in 0..meaning.model.states.len() {
        let state = &meaning.model.states[at];
        let Some(given) = state.start.filter(|&it| !unknowns(meaning, it).is_empty()) else {
            continue;
        };
        let name = format!("start {}", state.place.name);
        let place = Place { name, span: state.place.span };
        let value = meaning.graph.sub(meaning.at_ends[0][at], given);
        let range = Range { lower: zero, upper: zero };
        all.push(Row::new(Constraint { place, value, range }, false));
    }
    all
}

/// What is known about every symbol and every condition's value.
struct Known {
    /// For each symbol.
    domain: Vec<Interval>,
    /// What says so.
    because: Vec<Vec<Span>>,
    /// Whether it is another number at another time.
    varies: Vec<bool>,
    /// Where values that are no symbols must lie, and what says so.
    values: HashMap<ExprId, (Interval, Span)>,
    /// The conditions so far: their values, where these lie, and their places.
    rows: Vec<Learned>,
    /// The conditions that read each symbol.
    readers: HashMap<u32, Vec<usize>>,
    /// How often a condition may still narrow something.
    steps: usize,
}

/// A condition that is known to hold.
struct Learned {
    tape: Tape,
    allowed: Interval,
    span: Span,
    is_timeless: bool,
}

impl Known {
    fn new(meaning: &Elaborator<'_>) -> Self {
        let all = meaning.symbols.iter().map(|symbol| of_symbol(meaning, *symbol));
        let (domain, because) = all.unzip();
        let varies = |it: &Symbol| {
            matches!(it, Symbol::Time | Symbol::State(_) | Symbol::Control(_) | Symbol::Selector(_))
        };
        let varies = meaning.symbols.iter().map(varies).collect();
        let (values, rows, readers) = Default::default();
        Known { domain, because, varies, values, rows, readers, steps: MOST_STEPS }
    }

    /// What excludes a condition.
    fn contradiction(&self, meaning: &mut Elaborator<'_>, row: &Row) -> Option<Vec<Span>> {
        let Constraint { value, range, .. } = row.constraint;
        let allowed = interval(meaning, range);
        if let Some((before, span)) = self.values.get(&value)
            && are_apart(*before, allowed)
        {
            return Some(vec![*span]);
        }
        let mut tape = Tape::new(&meaning.graph, &[value]);
        let inputs: Vec<u32> = tape.inputs().collect();
        let possible = tape.evaluate(&self.domain)[0];
        if has_no_value(possible) {
            return None;
        }
        let spans = || inputs.iter().flat_map(|&at| self.because[at as usize].clone()).collect();
        (are_apart(possible, allowed) || self.has_other_sign(meaning, value, allowed)).then(spans)
    }

    /// Whether a value stays on one side of an end of where it must lie, which it never reaches.
    fn has_other_sign(
        &self,
        meaning: &mut Elaborator<'_>,
        value: ExprId,
        allowed: Interval,
    ) -> bool {
        let mut beyond = |end: f64, wanted: Signs| {
            let end = meaning.graph.number(end);
            let beyond = meaning.graph.sub(value, end);
            signs(&meaning.graph, beyond, &self.domain).excludes(wanted)
        };
        match allowed {
            _ if allowed.lower == allowed.upper => beyond(allowed.lower, Signs::ZERO),
            _ => {
                let at_least = Signs::ZERO.or(Signs::POSITIVE);
                let at_most = Signs::ZERO.or(Signs::NEGATIVE);
                allowed.lower.is_finite() && beyond(allowed.lower, at_least)
                    || allowed.upper.is_finite() && beyond(allowed.upper, at_most)
            }
        }
    }

    fn learn(&mut self, meaning: &Elaborator<'_>, row: &Row) {
        let Constraint { value, range, place } = &row.constraint;
        let (allowed, span) = (interval(meaning, *range), place.span);
        let tape = Tape::new(&meaning.graph, &[*value]);
        let is_timeless = row.is_timeless || !tape.inputs().any(|it| self.varies[it as usize]);
        if is_timeless {
            let known = self.values.entry(*value).or_insert((Interval::ALL, span));
            *known = (known.0.intersect(allowed), span);
        }
        for input in tape.inputs() {
            self.readers.entry(input).or_default().push(self.rows.len());
        }
        self.rows.push(Learned { tape, allowed, span, is_timeless });
        let mut pending = vec![self.rows.len() - 1];
        while let Some(next) = pending.pop().filter(|_| self.steps > 0) {
            self.steps -= 1;
            for input in self.narrow(next) {
                let readers = self.readers[&input].iter().filter(|it| **it != next);
                pending.extend(readers);
            }
        }
    }

    /// Narrows what a condition reads; which of it became narrower.
    fn narrow(&mut self, row: usize) -> Vec<u32> {
        let Learned { tape, allowed, span, is_timeless } = &mut self.rows[row];
        let (span, is_timeless) = (*span, *is_timeless);
        let mut inputs = tape.narrowed(&self.domain, *allowed);
        inputs.retain(|(at, _)| is_timeless || !self.varies[*at as usize]);
        let why = |at: &u32| self.because[*at as usize].clone();
        let reasons: Vec<Vec<Span>> = inputs.iter().map(|(at, _)| why(at)).collect();
        let mut narrower = Vec::new();
        for (number, (input, inner)) in inputs.iter().enumerate() {
            let at = *input as usize;
            let inner = self.domain[at].intersect(*inner);
            if inner.is_empty() || !is_progress(self.domain[at], inner) {
                continue;
            }
            self.domain[at] = inner;
            narrower.push(*input);
            let others = reasons.iter().enumerate().filter(|it| it.0 != number);
            for span in std::iter::once(&span).chain(others.flat_map(|it| it.1)) {
                if !self.because[at].contains(span) {
                    self.because[at].push(*span);
                }
            }
        }
        narrower
    }
}

/// Whether an interval is narrower than another by more than rounding and slow convergence.
fn is_progress(before: Interval, after: Interval) -> bool {
    let size = |it: Interval| it.upper - it.lower;
    match size(before).is_finite() {
        true => size(before) - size(after) > PROGRESS * size(before),
        false => before != after,
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

/// Whether nothing is known of a value: at time 0 `x/t` is `0/0` and `log(t)` no number, and a path
/// condition holds from the next point of the grid on only.
fn has_no_value(it: Interval) -> bool {
    let is_beyond = |end: f64| end > 0.5 * f64::MAX;
    it.is_empty() || is_beyond(it.lower) || is_beyond(-it.upper)
}

/// Whether two intervals have nothing in common, not even up to rounding.
fn are_apart(a: Interval, b: Interval) -> bool {
    let gap = (a.lower - b.upper).max(b.lower - a.upper);
    let size = [a.lower, a.upper, b.lower, b.upper].into_iter().filter(|it| it.is_finite());
    !a.is_empty() && gap > TOLERANCE * size.fold(1.0, |most: f64, it| most.max(it.abs()))
}

/// What an expression reads that has no value yet.
fn unknowns(meaning: &Elaborator<'_>, id: ExprId) -> Vec<u32> {
    let is_fixed = |input: &u32| matches!(meaning.symbols[*input as usize], Symbol::Param(_));
    meaning.graph.inputs_of(&[id]).into_iter().filter(|input| !is_fixed(input)).collect()
}

fn told(row: &Row, others: &[Span]) -> Diagnostic {
    let Place { name, span } = &row.constraint.place;
    let message = format!("`{name}` cannot hold at {}", row.point);
    let mut found = Diagnostic::new(Code::Contradiction, message, *span, "excluded");
    let mut told = vec![*span];
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
