//! The controls of a simulation: the model's guess, values that are held from row to row, or
//! polynomials in time.
//!
//! Time is divided into *segments*. On each the controls go through its rows: through one that is
//! held, or through several at the nodes of a polynomial.

use super::tuning::controls::ROUNDING;
use crate::lagrange;
use std::ops::Range;

/// Where the controls come from.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Controls {
    /// The guess of the model.
    #[default]
    Guess,
    /// Row `i` holds from `times[i]` to the next; the first holds before, too.
    Held {
        /// Ascending.
        times: Vec<f64>,
        /// One row of controls for each time.
        rows: Vec<Vec<f64>>,
        /// Whether the times are parts of the interval and move with its ends, as those of a
        /// solution; else they stand still.
        is_stretched: bool,
    },
    /// A polynomial on each segment.
    Polynomial(Polynomials),
}

/// Polynomials in time, one on each segment. Before the first segment its value at the beginning
/// holds, after the last the value at its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomials {
    /// Where segments begin, ascending; then where the last ends.
    pub times: Vec<f64>,
    /// The rows that the polynomial of each segment goes through. Neighbours may share one.
    pub ranges: Vec<Range<usize>>,
    /// The time of each row; those of one segment differ.
    pub nodes: Vec<f64>,
    /// One row of controls for each node.
    pub rows: Vec<Vec<f64>>,
    /// Whether times and nodes are parts of the interval and move with its ends.
    pub is_stretched: bool,
}

impl Controls {
    /// When segments begin; those of the guess are none.
    pub fn begins(&self) -> &[f64] {
        match self {
            Controls::Guess => &[],
            Controls::Held { times, .. } => times,
            Controls::Polynomial(Polynomials { times, ranges, .. }) => &times[..ranges.len()],
        }
    }

    /// The numbers that make the controls, those of one row for each time that has a value of its
    /// own; those of the guess are none.
    pub fn rows(&self) -> &[Vec<f64>] {
        match self {
            Controls::Guess => &[],
            Controls::Held { rows, .. } | Controls::Polynomial(Polynomials { rows, .. }) => rows,
        }
    }

    /// The same, to be changed.
    pub fn rows_mut(&mut self) -> &mut [Vec<f64>] {
        match self {
            Controls::Guess => &mut [],
            Controls::Held { rows, .. } | Controls::Polynomial(Polynomials { rows, .. }) => rows,
        }
    }

    /// Where controls may jump or bend strictly between two times.
    pub(crate) fn breaks(&self, first: f64, last: f64) -> Vec<f64> {
        let mut breaks = self.begins().to_vec();
        // Where the last polynomial ends it bends, unless that is the end but for rounding.
        if let Controls::Polynomial(Polynomials { times, .. }) = self {
            let is_sooner = |end: &&f64| last - **end > ROUNDING * (last - first);
            breaks.extend(times.last().filter(is_sooner));
        }
        breaks.retain(|time| *time > first && *time < last);
        breaks
    }

    /// The segment from a time on; none of the guess.
    pub fn segment(&self, time: f64) -> Option<usize> {
        let begins = self.begins();
        let segment = || begins.partition_point(|other| *other <= time).saturating_sub(1);
        (!begins.is_empty()).then(segment)
    }

    /// Whether the times move with the ends of the interval.
    pub(crate) fn is_stretched(&self) -> bool {
        match self {
            Controls::Guess => false,
            Controls::Held { is_stretched, .. } => *is_stretched,
            Controls::Polynomial(all) => all.is_stretched,
        }
    }

    /// Moves times to other ends of the interval, if they move with them.
    pub(crate) fn stretch(&mut self, [old_first, old_last]: [f64; 2], [first, last]: [f64; 2]) {
        let is_moved = (old_first, old_last) != (first, last) && old_last > old_first;
        if !is_moved || !self.is_stretched() {
            return;
        }
        let factor = (last - first) / (old_last - old_first);
        let stretch = |times: &mut Vec<f64>| {
            times.iter_mut().for_each(|time| *time = first + factor * (*time - old_first));
        };
        match self {
            Controls::Guess => {}
            Controls::Held { times, .. } => stretch(times),
            Controls::Polynomial(all) => {
                stretch(&mut all.times);
                stretch(&mut all.nodes);
            }
        }
    }

    /// The rows that a segment goes through.
    pub(crate) fn range(&self, segment: Option<usize>) -> Range<usize> {
        match (self, segment) {
            (Controls::Polynomial(all), Some(at)) => all.ranges.get(at).cloned().unwrap_or(0..0),
            (Controls::Held { .. }, Some(at)) => at..at + 1,
            _ => 0..0,
        }
    }

    /// What each row of a segment contributes to the controls at a time, or to their derivative of
    /// this order by time.
    pub(crate) fn weights(&self, segment: Option<usize>, time: f64, order: usize) -> Vec<f64> {
        let range = self.range(segment);
        let (Controls::Polynomial(all), Some(at)) = (self, segment) else {
            return vec![f64::from(u8::from(order == 0)); range.len()];
        };
        let nodes = &all.nodes[range];
        let (inside, is_inside) = all.inside(at, time);
        match order {
            0 => lagrange::values(nodes, inside),
            _ if is_inside => lagrange::derivatives(nodes, inside, order),
            _ => vec![0.0; nodes.len()],
        }
    }

    /// The controls of a segment at a time; nothing of the guess.
    pub fn values(&self, segment: Option<usize>, time: f64) -> Vec<f64> {
        self.derivatives(segment, time, 0)
    }

    /// Their derivatives of some order by time.
    pub(crate) fn derivatives(&self, segment: Option<usize>, time: f64, order: usize) -> Vec<f64> {
        let rows = &self.rows()[self.range(segment)];
        let weights = self.weights(segment, time, order);
        let count = rows.first().map_or(0, Vec::len);
        let value = |at: usize| {
            let column = rows.iter().map(|row| row[at]);
            match order {
                0 => lagrange::combined(&weights, column),
                _ => weights.iter().zip(column).map(|(w, u)| w * u).sum(),
            }
        };
        (0..count).map(value).collect()
    }
}

impl Polynomials {
    /// The nearest time of a segment, and whether only rounding makes it another.
    pub(crate) fn inside(&self, segment: usize, time: f64) -> (f64, bool) {
        let [begin, end] = [self.times[segment], self.times[segment + 1]];
        let inside = time.clamp(begin, end);
        (inside, (time - inside).abs() <= ROUNDING * (end - begin))
    }
}
