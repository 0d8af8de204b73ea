//! The least and the greatest value of each path condition along a simulation, between steps, too.
//!
//! A part of a step is done where intervals say that nothing in it is beyond what is known already.

use crate::simulate::field::Field;
use crate::simulate::field::tube::Tube;
use crate::simulate::interval::{scaled, size, times};
use crate::simulate::result::Extreme;
use crate::simulate::steps::Step;
use crate::simulate::system::Enclosure;
use crate::simulate::tuning::extremes::{EXACT, EXACT_OF_TERMS, MOST_PARTS};

/// The least, then the greatest value of each path condition so far; none if nobody asks.
pub(crate) struct Extremes(pub Vec<[Extreme; 2]>);

impl Extremes {
    pub fn new(conditions: usize) -> Self {
        let none = [f64::INFINITY, f64::NEG_INFINITY].map(|value| Extreme {
            value,
            time: f64::NAN,
            state: Vec::new(),
        });
        Extremes(vec![none; conditions])
    }

    /// Looks along a step, until a part of it.
    pub fn follow(&mut self, field: &Field, step: &Step, until: f64) {
        for (of, known) in field.system.enclosures.path.iter().zip(&mut self.0) {
            let tube = Tube::new(field);
            let mut search = Search { field, step, of, tube, rounding: 0.0 };
            if search.is_known(known, until) {
                continue;
            }
            search.rounding = search.terms() * EXACT_OF_TERMS;
            known
                .iter_mut()
                .zip([-1.0, 1.0])
                .for_each(|(known, side)| search.raise(known, side, until));
        }
    }
}

/// A condition along a step.
struct Search<'s, 'a> {
    field: &'s Field<'a>,
    step: &'s Step,
    of: &'s Enclosure,
    tube: Tube,
    /// Values that differ by less are the same, to the rounding of the terms that cancel.
    rounding: f64,
}

impl Search<'_, '_> {
    /// Whether no value is beyond those that are known, as one look tells.
    fn is_known(&mut self, [least, greatest]: &[Extreme; 2], until: f64) -> bool {
        let [low, high] = self.tube.bounds(self.field, self.step, [0.0, until], self.of)[0];
        low > high || low >= least.value && high <= greatest.value
    }

    /// The size of the terms at the start of the step: inputs times derivatives.
    fn terms(&mut self) -> f64 {
        self.value(0.0);
        let slopes = self.tube.ranges[1..].iter().zip(&self.of.by);
        let terms = slopes.map(|(slope, &input)| size(times(*slope, self.tube.inputs[input])));
        Some(terms.sum()).filter(|it: &f64| it.is_finite()).unwrap_or(0.0)
    }

    /// What is not above this is not beyond the known value.
    fn enough(&self, known: &Extreme, side: f64) -> f64 {
        side * known.value + self.rounding.max(EXACT * known.value.abs())
    }

    /// The value at a part of the step; not a number where there is none.
    fn value(&mut self, theta: f64) -> f64 {
        let [low, high] = self.tube.bounds(self.field, self.step, [theta; 2], self.of)[0];
        if low <= high { 0.5 * (low + high) } else { f64::NAN }
    }

    /// Finds what is beyond the known value: greater with `side` 1, less with -1. The part that
    /// may reach farthest is looked at first (branch and bound).
    fn raise(&mut self, known: &mut Extreme, side: f64, until: f64) {
        let mut parts = vec![self.part(side, 0.0, until)];
        for _ in 0..MOST_PARTS {
            let farthest = parts.iter().enumerate().max_by(|a, b| a.1.most.total_cmp(&b.1.most));
            let Some(at) = farthest.map(|it| it.0) else { return };
            let part = parts.swap_remove(at);
            if part.most <= self.enough(known, side) {
                return;
            }
            if !self.is_done(known, side, &part) {
                let middle = 0.5 * (part.from + part.to);
                parts.push(self.part(side, part.from, middle));
                parts.push(self.part(side, middle, part.to));
            }
        }
    }

    /// What intervals say about a part; nothing is beyond anything where there are no values.
    fn part(&mut self, side: f64, from: f64, to: f64) -> Part {
        let bounds = self.tube.bounds(self.field, self.step, [from, to], self.of);
        let is_empty = bounds[0][0] > bounds[0][1];
        let [[_, most], [falls, grows]] = bounds.map(|range| scaled(side, range));
        Part { from, to, most: if is_empty { f64::NEG_INFINITY } else { most }, falls, grows }
    }

    /// Notes values of a part. Whether nothing else in it is beyond them.
    fn is_done(&mut self, known: &mut Extreme, side: f64, part: &Part) -> bool {
        let &Part { from, to, falls, grows, .. } = part;
        let middle = 0.5 * (from + to);
        let values = [from, middle, to].map(|theta| self.seen(known, side, theta));
        // Two lines bound the values from above.
        let until_highest = (values[2] - values[0] - falls * (to - from)) / (grows - falls);
        falls >= 0.0
            || grows <= 0.0
            || values[0] + grows * until_highest <= self.enough(known, side)
            || to - from <= f64::EPSILON
    }

    /// A value, noted if it is beyond the known one.
    fn seen(&mut self, known: &mut Extreme, side: f64, theta: f64) -> f64 {
        let value = self.value(theta);
        if side * value > side * known.value {
            let time = self.step.t + theta * self.step.h;
            *known = Extreme { value, time, state: self.step.at(theta) };
        }
        side * value
    }
}

/// A part of a step: the greatest value in it is at most `most`, slopes are in `[falls, grows]`.
struct Part {
    from: f64,
    to: f64,
    most: f64,
    falls: f64,
    grows: f64,
}
