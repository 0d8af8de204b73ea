//! A start on one uniform grid as the start on another one of the same problem.
//!
//! Over normalised time a chain of stages holds three kinds of numbers: values at grid points,
//! values of intervals, and multipliers. What is carried from interval to interval belongs to
//! `tau_k = k/N`; controls, states at nodes and the multipliers of rows belong to a time `c` of
//! their interval, at `(k + c)/N`. All are interpolated linearly between equals. A defect holds the
//! whole step, so that its multiplier is the costate on every grid; a path constraint or a bound
//! stands for a piece of time, so that its multiplier and the barrier parameter are proportional to
//! `1/N`.

use crate::linalg::Stages;
use crate::nlp::{Multipliers, Start, Warm};
use crate::transcribe::interval::{Interval, Slot};

/// Where in its interval a number is.
pub(crate) struct Times {
    /// Of each variable behind those that are carried.
    variables: Vec<f64>,
    /// Of each row.
    rows: Vec<f64>,
}

impl Times {
    /// Those of an interval with so many path constraints at each point. What has one value in all
    /// of it is in the middle.
    pub(crate) fn new(interval: &Interval, path: usize) -> Self {
        const MIDDLE: f64 = 0.5;
        let carried = interval.carried;
        let constant = |place: usize, slot: &Slot| place < interval.chosen && slot.time == 0.0;
        let slots = interval.slots[carried..].iter().enumerate();
        let variables =
            slots.map(|(place, slot)| if constant(place, slot) { MIDDLE } else { slot.time });
        let (variables, defects) = (variables.collect(), interval.inner() + carried);
        if interval.inner() == 0 {
            return Times { variables, rows: vec![MIDDLE; defects + path] };
        }
        let mut rows = vec![1.0; defects];
        for node in &interval.nodes {
            rows[node.row..][..interval.start.states.len()].fill(node.point.time);
        }
        rows.extend(interval.path.iter().flat_map(|point| vec![point.time; path]));
        Times { variables, rows }
    }
}

/// The start on the grid of `to`. Both chains must be of one problem, whose intervals have these
/// times.
pub(crate) fn prolong(times: &Times, from: Stages, start: &Start, to: Stages) -> Start {
    let shrink = from.intervals as f64 / to.intervals as f64;
    let warm = start.warm.as_ref().map(
        |Warm { multipliers: Multipliers { constraints: rows, lower, upper }, mu, widths }| {
            let multipliers = Multipliers {
                constraints: conditions(times, from, rows, to, shrink),
                lower: variables(times, from, lower, to, shrink),
                upper: variables(times, from, upper, to, shrink),
            };
            Warm { multipliers, mu: mu.map(|mu| shrink * mu), widths: widths.clone() }
        },
    );
    Start { v: variables(times, from, &start.v, to, 1.0), warm }
}

/// One number for each variable; those of stages times `factor`.
fn variables(times: &Times, from: Stages, source: &[f64], to: Stages, factor: f64) -> Vec<f64> {
    let mut target = vec![0.0; to.variables()];
    let (old, new) = (from.variable_step(), to.variable_step());
    for i in 0..to.states {
        let at = |k: usize| source[k * old + i];
        (0..=to.intervals).for_each(|k| {
            target[k * new + i] = factor * at_point(from.intervals, &at, to.intervals, k)
        });
    }
    for (i, time) in (to.states..new).zip(&times.variables) {
        let at = |k: usize| source[k * old + i];
        (0..to.intervals).for_each(|k| {
            target[k * new + i] = factor * in_interval(from.intervals, &at, to.intervals, k, *time);
        });
    }
    target[to.globals()].copy_from_slice(&source[from.globals()]);
    target
}

/// One number for each row; those of path constraints times `factor`.
fn conditions(times: &Times, from: Stages, source: &[f64], to: Stages, factor: f64) -> Vec<f64> {
    let mut target = vec![0.0; to.rows()];
    let (old, new) = (from.row_step(), to.row_step());
    for (i, time) in times.rows.iter().enumerate() {
        let factor = if i < to.defect_rows() { 1.0 } else { factor };
        let at = |k: usize| source[k * old + i];
        (0..to.intervals).for_each(|k| {
            target[k * new + i] = factor * in_interval(from.intervals, &at, to.intervals, k, *time);
        });
    }
    target[to.coupling()].copy_from_slice(&source[from.coupling()]);
    target
}

/// Values at `k/old`, read at `k/new`.
fn at_point(old: usize, at: &dyn Fn(usize) -> f64, new: usize, k: usize) -> f64 {
    between(k as f64 * old as f64 / new as f64, old, at)
}

/// Values at a time of each of `old` intervals, read at that time of interval `k` of `new`;
/// constant beyond the first and the last.
fn in_interval(old: usize, at: &dyn Fn(usize) -> f64, new: usize, k: usize, time: f64) -> f64 {
    between((k as f64 + time) * old as f64 / new as f64 - time, old - 1, at)
}

/// Linear interpolation of values at 0, 1, ..., `last`.
fn between(position: f64, last: usize, at: &dyn Fn(usize) -> f64) -> f64 {
    let position = position.clamp(0.0, last as f64);
    let left = (position as usize).min(last.saturating_sub(1));
    let fraction = position - left as f64;
    if fraction == 0.0 { at(left) } else { (1.0 - fraction) * at(left) + fraction * at(left + 1) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a control, and behind it a state, are in their interval.
    const TIMES: [f64; 2] = [0.5, 0.25];

    fn times() -> Times {
        Times { variables: TIMES.to_vec(), rows: vec![TIMES[1], 0.5, 1.0] }
    }

    fn chain(intervals: usize) -> Stages {
        Stages {
            intervals,
            states: 1,
            controls: 1,
            inner: 1,
            globals: 1,
            local_constraints: 1,
            coupling_constraints: 1,
        }
    }

    /// The control and the inner state, `5 tau` and `3 tau`, in interval `k`.
    fn inside(chain: Stages, k: usize) -> [f64; 2] {
        let at = |time: f64| (k as f64 + time) / chain.intervals as f64;
        [5.0 * at(TIMES[0]), 3.0 * at(TIMES[1])]
    }

    /// `x = 3 tau`, `u = 5 tau` at its time, `g = 7`; multipliers 2 of defects, 4 of path rows, 6
    /// of bounds, 8 of the coupling row.
    fn start(chain: Stages) -> Start {
        let state = |k: usize| 3.0 * k as f64 / chain.intervals as f64;
        let stage = |k: usize| [vec![state(k)], inside(chain, k).to_vec()].concat();
        let mut v: Vec<f64> = (0..chain.intervals).flat_map(stage).collect();
        v.extend([3.0, 7.0]);
        let mut rows = [2.0, 2.0, 4.0].repeat(chain.intervals);
        rows.push(8.0);
        let bounds = vec![6.0; chain.variables()];
        let multipliers = Multipliers { constraints: rows, lower: bounds.clone(), upper: bounds };
        Start { v, warm: Some(Warm { multipliers, mu: Some(1e-3), widths: Vec::new() }) }
    }

    fn difference(a: &[f64], b: &[f64]) -> f64 {
        assert_eq!(a.len(), b.len());
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// But for what is inside intervals, before its first time and behind its last: it stays what
    /// it is there.
    #[test]
    fn what_is_linear_in_time_is_the_same_on_any_grid() {
        for (from, to) in [(10, 20), (20, 10), (7, 16)] {
            let (from, to) = (chain(from), chain(to));
            let (found, mut expected) = (prolong(&times(), from, &start(from), to).v, start(to).v);
            let (first, last) = (inside(from, 0), inside(from, from.intervals - 1));
            for k in 0..to.intervals {
                for i in 0..2 {
                    let value = &mut expected[to.control(k).start + i];
                    *value = value.clamp(first[i], last[i]);
                }
            }
            assert!(difference(&found, &expected) < 1e-14, "{found:?}");
        }
    }

    #[test]
    fn multipliers_of_pieces_of_time_and_the_barrier_parameter_fall_with_the_step() {
        let (from, to) = (chain(10), chain(40));
        let warm = prolong(&times(), from, &start(from), to).warm.expect("the start is warm");
        assert_eq!(warm.mu, Some(1e-3 / 4.0));
        let mut rows = [2.0, 2.0, 1.0].repeat(40);
        rows.push(8.0);
        assert_eq!(warm.multipliers.constraints, rows);
        let stages = &warm.multipliers.lower[..to.variables() - 1];
        assert!(stages.iter().all(|z| *z == 1.5));
        assert_eq!(
            warm.multipliers.lower[to.variables() - 1],
            6.0,
            "an unknown is no piece of time"
        );
    }
}
