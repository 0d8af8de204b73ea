//! The first event inside a step.
//!
//! Every condition is a function `g >= 0` of time: `side * psi` beside a surface, `1 - |s|` on it. It is sampled along the
//! dense output, its interior minima are searched too, so that a dip between two samples is not missed. The
//! root is refined on steps of the pair itself, so it is as accurate as the integration.

use super::direction::length;
use super::field::{Field, Mode};
use super::result::Options;
use super::step::Step;

/// What may end a mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Condition {
    /// The state reaches a surface.
    Reaches(usize),
    /// The selector of a sliding surface reaches the end of its interval.
    Leaves(usize),
}

/// An event, with the state there.
pub(super) struct Found {
    pub condition: Condition,
    /// How long the step is that ends there.
    pub h: f64,
    pub state: Vec<f64>,
}

const SAMPLES: usize = 8;

/// The first event of a step.
pub(super) fn first(field: &mut Field, step: &Step, options: &Options) -> Option<Found> {
    let conditions: Vec<Condition> = (0..field.modes.len()).filter_map(|i| condition(field, i)).collect();
    if conditions.is_empty() {
        return None;
    }
    let thetas: Vec<f64> = (0..=SAMPLES).map(|k| k as f64 / SAMPLES as f64).collect();
    let table: Vec<Vec<f64>> = thetas
        .iter()
        .map(|&theta| values(field, &conditions, step.t + theta * step.h, &step.at(theta)))
        .collect();
    let normals = field.normals(step.t, &step.start);
    let mut first: Option<(f64, Condition)> = None;
    for (at, &condition) in conditions.iter().enumerate() {
        let noise = match condition {
            Condition::Reaches(i) => normals.noise(i, &step.start),
            Condition::Leaves(_) => 1e-12,
        };
        let samples: Vec<f64> = table.iter().map(|row| row[at]).collect();
        let mut g = |theta: f64| values(field, &[condition], step.t + theta * step.h, &step.at(theta))[0];
        if let Some(theta) = first_root(&mut g, &thetas, &samples, noise)
            && first.is_none_or(|(best, _)| theta < best)
        {
            first = Some((theta, condition));
        }
    }
    first.map(|(theta, condition)| refine(field, step, condition, theta, options))
}

fn condition(field: &Field, surface: usize) -> Option<Condition> {
    match field.modes[surface] {
        Mode::Below | Mode::Above => Some(Condition::Reaches(surface)),
        Mode::Sliding => {
            let is_first = field.ball_of(surface).is_none_or(|ball| ball.surfaces.start == surface);
            is_first.then_some(Condition::Leaves(surface))
        }
        Mode::Moving | Mode::Held => None,
    }
}

fn values(field: &mut Field, conditions: &[Condition], t: f64, x: &[f64]) -> Vec<f64> {
    let psi = field.psi(t, x);
    if conditions.iter().any(|condition| matches!(condition, Condition::Leaves(_))) {
        field.rate(t, x);
    }
    let value = |condition: &Condition| match *condition {
        Condition::Reaches(i) => field.modes[i].side() * psi[i],
        Condition::Leaves(i) => match field.ball_of(i) {
            Some(ball) => 1.0 - length(&field.selectors[ball.surfaces.clone()]),
            None => 1.0 - field.selectors[i].abs(),
        },
    };
    conditions.iter().map(value).collect()
}

/// Where `g` first becomes negative.
fn first_root(g: &mut dyn FnMut(f64) -> f64, thetas: &[f64], samples: &[f64], noise: f64) -> Option<f64> {
    for k in 1..samples.len() {
        if samples[k] < -noise {
            return Some(root(g, thetas[k - 1], thetas[k], noise));
        }
        let is_dip = k + 1 < samples.len() && samples[k] <= samples[k - 1] && samples[k] <= samples[k + 1];
        if is_dip && let Some(below) = dip(g, thetas[k - 1], thetas[k + 1], noise) {
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
    let mut end = |theta: f64| {
        let state = if theta == 0.0 {
            step.start.clone()
        } else {
            Step::take(field, step.t, &step.start, theta * step.h, options).end
        };
        let value = values(field, &[condition], step.t + theta * step.h, &state)[0];
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
    Found { condition, h: best * step.h, state }
}
