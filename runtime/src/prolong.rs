//! A start on one uniform grid as the start on another one of the same problem.
//!
//! Over normalised time a chain of stages holds three kinds of numbers: values at grid points, values of intervals, and multipliers. States and the
//! multipliers of conditions at grid points belong to `tau_k = k/N`, controls and the multipliers of defects to the middle of their interval; all are
//! interpolated linearly. A defect holds the whole step, so that its multiplier is the costate on every grid; a path constraint or a bound stands for a
//! piece of time, so that its multiplier and the barrier parameter are proportional to `1/N`.

use crate::linalg::Stages;
use crate::nlp::{Multipliers, Start, Warm};

/// The start on the grid of `to`. Both chains must be of one problem.
pub fn prolong(from: Stages, start: &Start, to: Stages) -> Start {
    let shrink = from.intervals as f64 / to.intervals as f64;
    let warm = start.warm.as_ref().map(|Warm { multipliers: Multipliers { rows, lower, upper }, mu }| {
        let multipliers = Multipliers {
            rows: conditions(from, rows, to, shrink),
            lower: variables(from, lower, to, shrink),
            upper: variables(from, upper, to, shrink),
        };
        Warm { multipliers, mu: shrink * mu }
    });
    Start { v: variables(from, &start.v, to, 1.0), warm }
}

/// One number for each variable; those of stages times `factor`.
fn variables(from: Stages, source: &[f64], to: Stages, factor: f64) -> Vec<f64> {
    let mut target = vec![0.0; to.variables()];
    let (old, new) = (from.variable_step(), to.variable_step());
    for i in 0..to.states {
        let at = |k: usize| source[k * old + i];
        (0..=to.intervals)
            .for_each(|k| target[k * new + i] = factor * at_point(from.intervals, &at, to.intervals, k));
    }
    for i in to.states..new {
        let at = |k: usize| source[k * old + i];
        (0..to.intervals)
            .for_each(|k| target[k * new + i] = factor * in_interval(from.intervals, &at, to.intervals, k));
    }
    target[to.globals()].copy_from_slice(&source[from.globals()]);
    target
}

/// One number for each row; those of path constraints times `factor`.
fn conditions(from: Stages, source: &[f64], to: Stages, factor: f64) -> Vec<f64> {
    let mut target = vec![0.0; to.rows()];
    let (old, new) = (from.row_step(), to.row_step());
    for i in 0..new {
        let factor = if i < to.states { 1.0 } else { factor };
        let at = |k: usize| source[k * old + i];
        (0..to.intervals)
            .for_each(|k| target[k * new + i] = factor * in_interval(from.intervals, &at, to.intervals, k));
    }
    target[to.coupling()].copy_from_slice(&source[from.coupling()]);
    target
}

/// Values at `k/old`, read at `k/new`.
fn at_point(old: usize, at: &dyn Fn(usize) -> f64, new: usize, k: usize) -> f64 {
    between(k as f64 * old as f64 / new as f64, old, at)
}

/// Values in the middle of `old` intervals, read in the middle of interval `k` of `new`; constant beyond the first and the last.
fn in_interval(old: usize, at: &dyn Fn(usize) -> f64, new: usize, k: usize) -> f64 {
    between((k as f64 + 0.5) * old as f64 / new as f64 - 0.5, old - 1, at)
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

    fn chain(intervals: usize) -> Stages {
        Stages { intervals, states: 1, controls: 1, inner: 0, globals: 1, local_rows: 1, coupling_rows: 1 }
    }

    /// `x = 3 tau`, `u = 5 tau` at the middle of its interval, `g = 7`; multipliers 2 of defects, 4 of path rows, 6 of bounds, 8 of the coupling row.
    fn start(chain: Stages) -> Start {
        let n = chain.intervals as f64;
        let mut v: Vec<f64> =
            (0..chain.intervals).flat_map(|k| [3.0 * k as f64 / n, 5.0 * (k as f64 + 0.5) / n]).collect();
        v.extend([3.0, 7.0]);
        let mut rows = [2.0, 4.0].repeat(chain.intervals);
        rows.push(8.0);
        let bounds = vec![6.0; chain.variables()];
        let multipliers = Multipliers { rows, lower: bounds.clone(), upper: bounds };
        Start { v, warm: Some(Warm { multipliers, mu: 1e-3 }) }
    }

    fn difference(a: &[f64], b: &[f64]) -> f64 {
        assert_eq!(a.len(), b.len());
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// But for controls beyond the first and the last middle, which stay what they are there.
    #[test]
    fn what_is_linear_in_time_is_the_same_on_any_grid() {
        for (from, to) in [(10, 20), (20, 10), (7, 16)] {
            let (from, to) = (chain(from), chain(to));
            let (found, mut expected) = (prolong(from, &start(from), to).v, start(to).v);
            for k in 0..to.intervals {
                let (low, high) = (2.5 / from.intervals as f64, 5.0 - 2.5 / from.intervals as f64);
                expected[to.control(k).start] = expected[to.control(k).start].clamp(low, high);
            }
            assert!(difference(&found, &expected) < 1e-14, "{found:?}");
        }
    }

    #[test]
    fn multipliers_of_pieces_of_time_and_the_barrier_parameter_fall_with_the_step() {
        let (from, to) = (chain(10), chain(40));
        let warm = prolong(from, &start(from), to).warm.expect("the start is warm");
        assert_eq!(warm.mu, 1e-3 / 4.0);
        let mut rows = [2.0, 1.0].repeat(40);
        rows.push(8.0);
        assert_eq!(warm.multipliers.rows, rows);
        let stages = &warm.multipliers.lower[..to.variables() - 1];
        assert!(stages.iter().all(|z| *z == 1.5));
        assert_eq!(warm.multipliers.lower[to.variables() - 1], 6.0, "an unknown is no piece of time");
    }
}
