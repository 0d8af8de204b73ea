//! The times of `at TIME: CONDITION`: which they are, in which order, and where they may not be.

use super::numbers::{Numbers, numbers};
use crate::expressions::graph::{ExprId, Graph};
use crate::expressions::interval::{Interval, Tape};
use crate::model::{AtTime, Model, Symbol};
use crate::syntax::text;
use fdcc_grammar::{Code, Diagnostic};

/// Times that differ by less, relative to the duration, are one.
const ROUNDING: f64 = 1e-9;

/// A time at which conditions hold.
pub(crate) struct Instant<'m> {
    /// When it is, over parameters and unknowns.
    pub time: ExprId,
    /// The same with parameters as they are and unknowns as they are guessed.
    pub guess: f64,
    /// All that is said of it.
    pub conditions: Vec<&'m AtTime>,
}

impl Model {
    /// The times of all conditions between the ends, as they follow each other where unknowns are
    /// as they are guessed.
    pub(crate) fn instants(&self, numbers: &Numbers) -> Vec<Instant<'_>> {
        let [first, last] = self.interval.map(|end| numbers.value(self, end));
        let room = ROUNDING * (last - first).abs();
        let mut all: Vec<Instant> = Vec::new();
        for it in &self.at_times {
            let guess = numbers.value(self, it.time);
            let is_same = |other: &&mut Instant| {
                let both = [other.time, it.time];
                both[0] == both[1]
                    || both.iter().all(|time| self.is_given(*time))
                        && (other.guess - guess).abs() <= room
            };
            match all.iter_mut().find(is_same) {
                Some(known) => known.conditions.push(it),
                None => all.push(Instant { time: it.time, guess, conditions: vec![it] }),
            }
        }
        all.sort_by(|a, b| a.guess.total_cmp(&b.guess));
        all
    }

    /// Whether a time is a number once the parameters are known.
    pub(crate) fn is_given(&self, time: ExprId) -> bool {
        let inputs = self.graph.inputs_of(&[time]);
        inputs.iter().all(|at| matches!(self.symbols[*at as usize], Symbol::Param(_)))
    }

    /// Where the difference of two times, the later one first, may lie.
    pub(crate) fn between_times(
        &self,
        graph: &mut Graph,
        numbers: &Numbers,
        [later, earlier]: [ExprId; 2],
    ) -> Interval {
        let difference = graph.sub(later, earlier);
        let one = |symbol: &Symbol| match *symbol {
            Symbol::Free(at) => {
                let bounds = numbers.bounds(self, self.frees[at].range);
                Interval::new(bounds.lower, bounds.upper)
            }
            symbol @ Symbol::Param(_) => Interval::point(numbers.of(symbol)),
            _ => Interval::ALL,
        };
        let domain: Vec<Interval> = self.symbols.iter().map(one).collect();
        Tape::new(graph, &[difference]).evaluate(&domain)[0]
    }

    /// Conditions at times that are never inside of the horizon, and those whose order nothing
    /// tells.
    pub(crate) fn misplaced_times(&self, numbers: &Numbers) -> Vec<Diagnostic> {
        let instants = self.instants(numbers);
        let mut found: Vec<Diagnostic> =
            instants.iter().filter_map(|it| self.outside(numbers, it)).collect();
        if found.is_empty() {
            found.extend(instants.windows(2).filter_map(|pair| self.open_order(numbers, pair)));
        }
        found
    }

    /// Whether the bounds of the unknowns say in which order all times are.
    pub fn has_order_of_times(&self) -> bool {
        numbers(self).is_ok_and(|numbers| {
            let instants = self.instants(&numbers);
            instants.windows(2).all(|pair| self.open_order(&numbers, pair).is_none())
        })
    }

    fn outside(&self, numbers: &Numbers, instant: &Instant) -> Option<Diagnostic> {
        let mut graph = self.graph.clone();
        let mut difference = |pair| self.between_times(&mut graph, numbers, pair);
        let passed = difference([instant.time, self.interval[0]]);
        let left = difference([self.interval[1], instant.time]);
        let room = ROUNDING * (passed.upper + left.upper).abs();
        let (word, end) = match () {
            () if passed.upper <= room => ("start", "begins"),
            () if left.upper <= room => ("end", "ends"),
            () => return None,
        };
        let at = if word == "start" { 0 } else { 1 };
        let place = &instant.conditions[0].place;
        let shown = |time: f64| text::number((time * 1e9).round() / 1e9);
        let message = format!("`at {}` is not inside of the horizon", place.name);
        let label = match self.is_given(instant.time) && self.is_given(self.interval[at]) {
            true => {
                let horizon = shown(numbers.value(self, self.interval[at]));
                format!("{}; time {end} at {horizon}", shown(instant.guess))
            }
            false => format!("never {} time {end}", if at == 0 { "after" } else { "before" }),
        };
        let found = Diagnostic::new(Code::TimeOutside, message, place.span, label);
        Some(found.help(format!(
            "give it a time between the first and the last one; what holds at the {word} is \
             written `{word} ...`"
        )))
    }

    fn open_order(&self, numbers: &Numbers, pair: &[Instant]) -> Option<Diagnostic> {
        let times = [pair[1].time, pair[0].time];
        let passed = self.between_times(&mut self.graph.clone(), numbers, times);
        if passed.lower >= 0.0 {
            return None;
        }
        let [first, second] = [&pair[0], &pair[1]].map(|it| &it.conditions[0].place);
        let message = format!("`{}` is taken to be before `{}`", first.name, second.name);
        let label = "as they are guessed; their bounds allow both orders";
        let found = Diagnostic::new(Code::OrderOfTimes, message, second.span, label);
        Some(found.label(first.span, "before").help(
            "only this order is solved: give the unknown bounds that say so, or the other order by \
             other guesses",
        ))
    }
}
