//! The first event inside a step.
//!
//! Every condition is a function `g >= 0` of time: `side * psi` beside a surface or a kink, `1 - |s|` on a surface. It is sampled along the
//! dense output, its interior minima are searched too, so that a dip between two samples is not missed. The
//! root is refined on steps of the pair itself, so it is as accurate as the integration.

use super::direction::length;
use super::events::correct;
use super::field::Field;
use super::result::Options;
use super::samples::{self, Samples};
use super::step::Step;

/// What may end a mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Condition {
    /// The state reaches a surface.
    Reaches(usize),
    /// The selector of a sliding surface reaches the end of its interval.
    Leaves(usize),
    /// The state reaches a kink of the right side.
    Bends(usize),
}

/// An event, with the state there.
pub(super) struct Found {
    pub condition: Condition,
    /// How long the step is that ends there.
    pub h: f64,
    pub state: Vec<f64>,
}

/// The first event of a step.
pub(super) fn first(field: &mut Field, step: &Step, options: &Options) -> Option<Found> {
    let besides = samples::besides(field, step);
    let slidings = samples::slidings(field, step);
    let kinks = samples::kinks(field, step);
    let found = [besides, slidings, kinks].map(|samples| first_of(field, step, &samples));
    let (theta, condition) = found.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(refine(field, step, condition, theta, options))
}

/// The first condition that ends, and when.
fn first_of(field: &mut Field, step: &Step, sampled: &[Samples]) -> Option<(f64, Condition)> {
    let mut first: Option<(f64, Condition)> = None;
    for samples in sampled.iter().filter(|samples| samples.may_end()) {
        let condition = samples.condition;
        let noise = match condition {
            Condition::Reaches(i) => field.normals(step.t, &step.start).noise(i, &step.start),
            Condition::Leaves(_) => 1e-12,
            Condition::Bends(k) => field.bends(step.t, &step.start).noise(k, &step.start),
        };
        let mut g = |theta: f64| value(field, condition, step.t + theta * step.h, &step.at(theta));
        if let Some(theta) = first_root(&mut g, samples, noise)
            && first.is_none_or(|(best, _)| theta < best)
        {
            first = Some((theta, condition));
        }
    }
    first
}

/// `1 - |s|` of a sliding surface or of a ball at rest.
pub(super) fn reserve(field: &Field, surface: usize) -> f64 {
    match field.ball_of(surface) {
        Some(ball) => 1.0 - length(&field.selectors[ball.surfaces.clone()]),
        None => 1.0 - field.selectors[surface].abs(),
    }
}

/// What is not negative before a condition ends.
fn value(field: &mut Field, condition: Condition, t: f64, x: &[f64]) -> f64 {
    match condition {
        Condition::Reaches(i) => field.modes[i].side() * field.psi(t, x)[i],
        Condition::Leaves(i) => {
            field.rate(t, x);
            reserve(field, i)
        }
        Condition::Bends(k) => field.side_of(k) * field.bends(t, x).psi[k],
    }
}

/// Where `g` first becomes negative.
fn first_root(g: &mut dyn FnMut(f64) -> f64, samples: &Samples, noise: f64) -> Option<f64> {
    let Samples { thetas, values, .. } = samples;
    for k in 1..values.len() {
        if values[k] < -noise {
            return Some(root(g, thetas[k - 1], thetas[k], noise));
        }
        if samples.is_dip(k)
            && let Some(below) = dip(g, thetas[k - 1], thetas[k + 1], noise)
        {
            return Some(root(g, thetas[k - 1].min(below), below, noise));
        }
    }
    None
}

/// Where `g` is negative between two times with a minimum in between, by golden section.
fn dip(g: &mut dyn FnMut(f64) -> f64, mut low: f64, mut high: f64, noise: f64) -> Option<f64> {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..60 {
        let (left, right) = (high - golden * (high - low), low + golden * (high - low));
        let (at_left, at_right) = (g(left), g(right));
        if at_left.min(at_right) < -noise {
            return Some(if at_left < at_right { left } else { right });
        }
        if at_left < at_right {
            high = right;
        } else {
            low = left;
        }
        if high - low < 1e-9 {
            break;
        }
    }
    None
}

/// The root between a time where `g` is positive, or 0 by rounding, and one where it is negative.
fn root(g: &mut dyn FnMut(f64) -> f64, mut low: f64, mut high: f64, noise: f64) -> f64 {
    let mut at_low = g(low);
    let mut at_high = g(high);
    let begin = low;
    // A mode begins on its surface, as far as rounding can tell: the positive part may be shorter than any sample.
    let mut span = high - begin;
    while at_low <= noise {
        span *= 0.5;
        if span < 1e-12 {
            return begin;
        }
        let value = g(begin + span);
        if value > noise {
            (low, at_low) = (begin + span, value);
        } else {
            (high, at_high) = (begin + span, value);
        }
    }
    bisect(g, [low, at_low], [high, at_high])
}

/// Bisection and the Illinois rule by turns.
pub(super) fn bisect(
    g: &mut dyn FnMut(f64) -> f64,
    [mut low, mut at_low]: [f64; 2],
    [mut high, mut at_high]: [f64; 2],
) -> f64 {
    for turn in 0..120 {
        let middle = if turn % 3 == 2 {
            0.5 * (low + high)
        } else {
            high - at_high * (high - low) / (at_high - at_low)
        };
        let middle = if middle > low && middle < high { middle } else { 0.5 * (low + high) };
        let value = g(middle);
        if value == 0.0 || high - low <= 2.0 * f64::EPSILON * high {
            return middle;
        }
        if value > 0.0 {
            (low, at_low, at_high) = (middle, value, 0.5 * at_high);
        } else {
            (high, at_high, at_low) = (middle, value, 0.5 * at_low);
        }
    }
    high
}

/// The secant method on steps that end at the event.
fn refine(field: &mut Field, step: &Step, condition: Condition, theta: f64, options: &Options) -> Found {
    let mut trial = step.clone();
    let mut end = |theta: f64| {
        let state = if theta == 0.0 {
            step.start.clone()
        } else {
            trial.attempt(field, theta * step.h, options);
            trial.end.clone()
        };
        let value = value(field, condition, step.t + theta * step.h, &state);
        (state, value)
    };
    let (mut state, mut value) = end(theta);
    let mut best = theta;
    let mut other = theta * (1.0 - 1e-6);
    let mut at_other = if theta > 0.0 { end(other).1 } else { 0.0 };
    for _ in 0..6 {
        let next = best - value * (best - other) / (value - at_other);
        let is_near = (next - theta).abs() <= 1e-3 * theta && next <= 1.0;
        if value == 0.0 || !is_near || next == best {
            break;
        }
        let (next_state, next_value) = end(next);
        if next_value.abs() >= value.abs() {
            break;
        }
        (other, at_other) = (best, value);
        (best, state, value) = (next, next_state, next_value);
    }
    let h = best * step.h;
    if let Condition::Reaches(surface) = condition {
        bring_to(field, surface, step.t + h, &mut state);
    }
    Found { condition, h, state }
}

/// Newton's steps onto a surface that is reached but for rounding, which is as large as the state was on the way.
fn bring_to(field: &mut Field, surface: usize, t: f64, state: &mut [f64]) {
    for _ in 0..2 {
        let normals = field.normals(t, state);
        let slope: Vec<f64> = normals.by_state.row(surface).iter().copied().collect();
        correct(state, &slope, normals.psi[surface]);
    }
}
