//! The times of `at TIME: CONDITION`: which they are, in which order, and where they may not be.

use super::numbers::{Numbers, numbers};
use crate::expressions::graph::{ExprId, Graph};
use crate::expressions::interval::{Interval, Tape};
use crate::model::{AtTime, Model, Symbol};
use fdcc_grammar::{Code, Diagnostic};
use std::collections::{BTreeMap, HashMap};

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
        let mut places = Places::within(ROUNDING * (last - first).abs());
        let mut all: Vec<Instant> = Vec::new();
        for it in &self.at_times {
            let guess = numbers.value(self, it.time);
            let given = self.is_given(it.time).then_some(guess);
            match places.find(it.time, given) {
                Some(known) => all[known].conditions.push(it),
                None => {
                    places.add(it.time, given, all.len());
                    all.push(Instant { time: it.time, guess, conditions: vec![it] });
                }
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

    /// Where every input may lie that is the same at any time.
    pub(crate) fn timeless(&self, numbers: &Numbers) -> Vec<Interval> {
        let one = |symbol: &Symbol| match *symbol {
            Symbol::Free(at) => {
                let bounds = numbers.bounds(self, self.frees[at].range);
                Interval::new(bounds.lower, bounds.upper)
            }
            symbol @ Symbol::Param(_) => Interval::point(numbers.of(symbol)),
            _ => Interval::ALL,
        };
        self.symbols.iter().map(one).collect()
    }

    /// Conditions at times that are never inside of the horizon, and those whose order nothing
    /// tells.
    pub(crate) fn misplaced_times(&self, numbers: &Numbers) -> Vec<Diagnostic> {
        let instants = self.instants(numbers);
        if instants.is_empty() {
            return Vec::new();
        }
        let mut differences = Differences::new(self, numbers);
        let mut found: Vec<Diagnostic> =
            instants.iter().filter_map(|it| self.outside(numbers, &mut differences, it)).collect();
        if found.is_empty() {
            found.extend(instants.windows(2).filter_map(|it| open_order(&mut differences, it)));
        }
        found
    }

    /// Whether the bounds of the unknowns say in which order all times are.
    pub fn has_order_of_times(&self) -> bool {
        numbers(self).is_ok_and(|numbers| {
            let instants = self.instants(&numbers);
            let mut differences = Differences::new(self, &numbers);
            instants.windows(2).all(|it| open_order(&mut differences, it).is_none())
        })
    }

    fn outside(
        &self,
        numbers: &Numbers,
        differences: &mut Differences,
        instant: &Instant,
    ) -> Option<Diagnostic> {
        let passed = differences.between([instant.time, self.interval[0]]);
        let left = differences.between([self.interval[1], instant.time]);
        let room = ROUNDING * (passed.upper + left.upper).abs();
        let (word, end) = match () {
            () if passed.upper <= room => ("start", "begins"),
            () if left.upper <= room => ("end", "ends"),
            () => return None,
        };
        let at = if word == "start" { 0 } else { 1 };
        let place = &instant.conditions[0].place;
        let shown = |time: f64| self.time_in_words(time);
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
}

fn open_order(differences: &mut Differences, pair: &[Instant]) -> Option<Diagnostic> {
    let passed = differences.between([pair[1].time, pair[0].time]);
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

/// Where differences of times may lie, as far as the bounds of the unknowns tell.
struct Differences {
    graph: Graph,
    domain: Vec<Interval>,
}

impl Differences {
    fn new(model: &Model, numbers: &Numbers) -> Self {
        Differences { graph: model.graph.clone(), domain: model.timeless(numbers) }
    }

    fn between(&mut self, times: [ExprId; 2]) -> Interval {
        between_times(&mut self.graph, &self.domain, times)
    }
}

/// Where the difference of two times, the later one first, may lie.
pub(crate) fn between_times(
    graph: &mut Graph,
    domain: &[Interval],
    [later, earlier]: [ExprId; 2],
) -> Interval {
    let difference = graph.sub(later, earlier);
    Tape::new(graph, &[difference]).evaluate(domain)[0]
}

/// Which of some times is another one: the same expression, or nearly the same number.
struct Places {
    room: f64,
    by_time: HashMap<ExprId, usize>,
    by_number: BTreeMap<i64, (f64, usize)>,
}

impl Places {
    /// Numbers that differ by no more than `room` are one.
    fn within(room: f64) -> Self {
        Places { room, by_time: HashMap::new(), by_number: BTreeMap::new() }
    }

    fn find(&self, time: ExprId, number: Option<f64>) -> Option<usize> {
        self.by_time.get(&time).copied().or_else(|| {
            let number = number.filter(|it| it.is_finite() && self.room.is_finite())?;
            let near = self.by_number.range(key(number - self.room)..=key(number + self.room));
            let near = near.filter(|it| (it.1.0 - number).abs() <= self.room);
            near.map(|it| it.1.1).min()
        })
    }

    fn add(&mut self, time: ExprId, number: Option<f64>, place: usize) {
        self.by_time.entry(time).or_insert(place);
        if let Some(number) = number {
            self.by_number.entry(key(number)).or_insert((number, place));
        }
    }
}

/// Whole numbers in the order of `f64::total_cmp`.
fn key(number: f64) -> i64 {
    let bits = number.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}
