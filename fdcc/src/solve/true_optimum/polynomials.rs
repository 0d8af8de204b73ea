//! Controls that are polynomials on the intervals of a phase: what they do between their nodes.

use super::range::Range;
use super::tuning::polynomials::{AT_BOUND, JUMP, PART_ROUGH, PARTS, ROUGH};
use fdcc_compiler::Arc;
use fdcc_runtime::lagrange;
use fdcc_runtime::problem::Bounds;
use fdcc_runtime::solution::Trajectory;
use fdcc_runtime::solve::Outcome;

/// A control on one interval.
pub(super) struct Polynomial<'t> {
    /// First and last time.
    pub ends: [f64; 2],
    /// Of its nodes.
    time: &'t [f64],
    values: &'t [f64],
}

/// A control on each interval of a phase; nothing where it is no polynomial.
pub(super) fn polynomials(trajectory: &Trajectory, control: usize) -> Vec<Polynomial<'_>> {
    let Some(nodes) = &trajectory.nodes else { return Vec::new() };
    let count = nodes.time.len() / (trajectory.time.len() - 1);
    let values = nodes.values[control].chunks(count);
    let ends = trajectory.time.windows(2).map(|pair| [pair[0], pair[1]]);
    let pieces = ends.zip(nodes.time.chunks(count)).zip(values);
    pieces.map(|((ends, time), values)| Polynomial { ends, time, values }).collect()
}

impl Polynomial<'_> {
    /// Its value at a time.
    pub fn at(&self, time: f64) -> f64 {
        lagrange::combined(&lagrange::values(self.time, time), self.values.iter().copied())
    }

    /// By how much it leaves its bounds.
    pub fn violation(&self, bounds: Bounds) -> f64 {
        let [from, to] = self.ends;
        let part = |part: usize| from + (to - from) * part as f64 / PARTS as f64;
        let all = (0..=PARTS).map(|it| bounds.violation(self.at(part(it))));
        all.fold(0.0, f64::max)
    }

    /// The bound at or beyond which it is where it begins or ends, or at the node next to that; the
    /// opposite one where it leaves a bound within the interval: whatever is between the last node
    /// and a switch, the polynomial does not get there.
    pub fn bound_at(&self, end: usize, Range { bounds, width, .. }: &Range) -> Arc {
        let slack = AT_BOUND * width;
        let last = self.values.len() - 1;
        let [node, rest] = [end * last, (1 - end) * last].map(|at| self.values[at]);
        let ends = [self.at(self.ends[end]), node];
        let is_lower = |value: f64| value < bounds.lower + slack;
        let is_upper = |value: f64| value > bounds.upper - slack;
        match () {
            () if is_lower(rest) && !is_lower(node) && bounds.upper.is_finite() => Arc::Upper,
            () if is_upper(rest) && !is_upper(node) && bounds.lower.is_finite() => Arc::Lower,
            () if ends.into_iter().any(is_lower) => Arc::Lower,
            () if ends.into_iter().any(is_upper) => Arc::Upper,
            () => Arc::Free,
        }
    }

    /// The largest distance from the straight line that is nearest in the mean.
    fn off_line(&self) -> f64 {
        let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len() as f64;
        let (time_mean, value_mean) = (mean(self.time), mean(self.values));
        let moment = |a: &[f64], a_mean: f64| -> f64 {
            self.time.iter().zip(a).map(|(t, a)| (t - time_mean) * (a - a_mean)).sum()
        };
        let slope = moment(self.values, value_mean) / moment(self.time, time_mean);
        let gap = |(t, value): (&f64, &f64)| (value - value_mean - slope * (t - time_mean)).abs();
        self.time.iter().zip(self.values).map(gap).fold(0.0, f64::max)
    }
}

/// By how much a control leaves its bounds between its nodes, for its width.
pub(crate) fn beyond_bounds(ranges: &[Range], trajectory: &Trajectory) -> f64 {
    let of = |(at, range): (usize, &Range)| {
        let pieces = polynomials(trajectory, at).into_iter();
        pieces.map(|it| it.violation(range.bounds) / range.width).fold(0.0, f64::max)
    };
    ranges.iter().enumerate().map(of).fold(0.0, f64::max)
}

/// Where a control changes most within an interval, if that is so much that it jumps there.
pub(super) fn jump(ranges: &[Range], trajectory: &Trajectory) -> Option<f64> {
    let mut largest = (JUMP, None);
    for (at, Range { width, .. }) in ranges.iter().enumerate() {
        let pieces = polynomials(trajectory, at);
        for triple in pieces.windows(3) {
            let [before, own, after] = triple else { unreachable!("windows of three") };
            let change = (after.at(after.ends[0]) - before.at(before.ends[1])).abs() / width;
            if change > largest.0 {
                largest = (change, Some(0.5 * (own.ends[0] + own.ends[1])));
            }
        }
    }
    largest.1
}

/// Where a control is far from linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rough {
    /// Only near the ends of a phase.
    AtEnds,
    /// Also in its middle half. On a singular arc the objective hardly depends on what a polynomial
    /// does between its nodes, and what is found is nothing but noise.
    Throughout,
}

/// Whether a control is far from linear on several intervals of a phase, and where.
pub(super) fn roughness(ranges: &[Range], outcome: &Outcome) -> Option<Rough> {
    let of = |(at, Range { width, .. }): (usize, &Range)| {
        let pieces = polynomials(&outcome.trajectory, at);
        let is_rough = |pieces: &[Polynomial]| {
            let rough = pieces.iter().filter(|it| it.off_line() > ROUGH * width);
            rough.count() as f64 > PART_ROUGH * pieces.len() as f64
        };
        let quarter = pieces.len() / 4;
        let middle = &pieces[quarter..pieces.len() - quarter];
        is_rough(&pieces).then(|| if is_rough(middle) { Rough::Throughout } else { Rough::AtEnds })
    };
    // A control without bounds has no singular arcs: it would have no optimum.
    let is_bounded = |it: &Range| (it.bounds.upper - it.bounds.lower).is_finite();
    let controls = ranges.iter().enumerate().filter(|it| is_bounded(it.1));
    let all: Vec<Rough> = controls.filter_map(of).collect();
    all.iter().find(|it| **it == Rough::Throughout).or(all.first()).copied()
}
