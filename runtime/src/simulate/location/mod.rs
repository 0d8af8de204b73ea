//! The first event inside a step.
//!
//! Every condition is a function `g >= 0` of time: `side * psi` beside a surface or a kink, `1 -
//! |s|` on a surface. Along the dense output
//! none of them is negative before the event that is found (see [`search`]). The
//! root is refined on steps of the pair
//! itself, so it is as accurate as the integration.

mod bisection;
mod discontinuity;
pub(crate) mod extremes;
pub(crate) mod hidden;
mod search;
mod sliding;
pub(crate) mod touch;
mod tube;

use super::field::Field;
use super::field::direction::length;
use super::steps::Step;
use crate::simulate::mode::Mode;
use crate::simulate::tape::Cause;
use crate::simulate::tuning::location::{
    NEAR, ROUNDINGS, SECANT_OFFSET, SELECTOR_NOISE, SHORTEST, SOON,
};
pub(crate) use bisection::bisect;
use search::{Search, Signal};

/// What may end a mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Condition {
    /// The state reaches a surface.
    Reaches(usize),
    /// The selector of a sliding surface reaches the end of its interval.
    Leaves(usize),
    /// The state reaches a kink of the right side.
    CrossesKink(usize),
    /// A surface moves away from the state that rests on it.
    Parts(usize),
}

impl From<Condition> for Cause {
    fn from(condition: Condition) -> Self {
        match condition {
            Condition::Reaches(surface) | Condition::Parts(surface) => Cause::Reaches(surface),
            Condition::Leaves(surface) => Cause::Leaves(surface),
            Condition::CrossesKink(kink) => Cause::CrossesKink(kink),
        }
    }
}

/// An event, with the state there.
pub(crate) struct Found {
    pub condition: Condition,
    /// How long the step is that ends there.
    pub h: f64,
    pub state: Vec<f64>,
    /// Whether the switching function jumps there, and is not 0.
    pub is_jump: bool,
}

/// What is known of the events in a step.
pub(crate) enum First {
    /// There is none.
    None,
    /// The first.
    At(Found),
    /// There is none before this part of the step; what comes then takes too long to find out.
    NotBefore(f64),
    /// There are more than times that can be told apart.
    Unresolved,
}

/// The first event of a step.
pub(crate) fn first(field: &mut Field, step: &Step) -> First {
    let (mut until, mut found, mut is_known) = (1.0, None, true);
    // A step may be too long to have times at its beginning that can be told apart.
    let distinct = f64::MIN_POSITIVE.max(ROUNDINGS * f64::EPSILON * step.t.abs());
    for condition in conditions(field) {
        let tube = field.lend_tube();
        let mut signal = Signal { field, step, condition, tube };
        if signal.clearly_holds(until) {
            signal.field.tube = Some(signal.tube);
            continue;
        }
        let noise = signal.noise(0.0);
        if matches!(condition, Condition::Reaches(_)) && signal.is_unresolved(until, noise) {
            return First::Unresolved;
        }
        match signal.first_failure(until, noise) {
            Search::Holds => {}
            Search::Fails([_, soon], _) if soon < SOON && soon * step.h > distinct => {
                return First::NotBefore(soon / SOON.sqrt());
            }
            Search::Fails(ends, noise) => {
                until = root(&mut |theta| signal.value(theta), ends, noise);
                let is_jump = matches!(condition, Condition::Reaches(_))
                    && discontinuity::jumps(&mut signal, until);
                (found, is_known) = (Some((condition, is_jump)), true);
            }
            Search::HoldsUntil(theta) => (until, found, is_known) = (theta, None, false),
        }
    }
    match found {
        Some((condition, true)) => {
            let (h, state) = (until * step.h, step.at(until));
            First::At(Found { condition, h, state, is_jump: true })
        }
        Some((condition, false)) => First::At(refine(field, step, condition, until)),
        None if is_known => First::None,
        None => First::NotBefore(until),
    }
}

/// All that may end the mode.
fn conditions(field: &Field) -> Vec<Condition> {
    let is_first = |i: usize| field.ball_of(i).is_none_or(|ball| ball.surfaces.start == i);
    let of = |(i, mode): (usize, &Mode)| match mode {
        Mode::Below | Mode::Above => Some(Condition::Reaches(i)),
        Mode::Sliding if is_first(i) => Some(Condition::Leaves(i)),
        Mode::Held => Some(Condition::Parts(i)),
        Mode::Sliding | Mode::Moving => None,
    };
    let kinks = if field.is_blind { 0 } else { field.system.kinks.outputs() };
    field
        .modes
        .iter()
        .enumerate()
        .filter_map(of)
        .chain((0..kinks).map(Condition::CrossesKink))
        .collect()
}

/// What rounding may make of 0 at a point.
pub(super) fn noise(field: &mut Field, condition: Condition, t: f64, x: &[f64]) -> f64 {
    field.find_rounding(t, x);
    match condition {
        Condition::Reaches(i) => field.normals(t, x).noise(i, x),
        Condition::Leaves(_) => SELECTOR_NOISE,
        Condition::Parts(_) => 0.0,
        Condition::CrossesKink(k) => field.kinks(t, x).noise(k, x),
    }
}

/// `1 - |s|` of a sliding surface or of a ball at rest.
pub(crate) fn reserve(field: &Field, surface: usize) -> f64 {
    match field.ball_of(surface) {
        Some(ball) => 1.0 - length(&field.selectors[ball.surfaces.clone()]),
        None => 1.0 - field.selectors[surface].abs(),
    }
}

/// What is not negative before a condition ends.
pub(crate) fn value(field: &mut Field, condition: Condition, t: f64, x: &[f64]) -> f64 {
    match condition {
        Condition::Reaches(i) => field.modes[i].side() * field.psi(t, x)[i],
        Condition::Parts(i) => field.slack[i] - field.psi(t, x)[i].abs(),
        Condition::Leaves(i) => {
            field.rate(t, x);
            reserve(field, i)
        }
        Condition::CrossesKink(k) => field.side_of(k) * field.kinks(t, x).psi[k],
    }
}

/// The root between a time where `g` is positive, or 0 by rounding, and one where it is negative.
fn root(g: &mut dyn FnMut(f64) -> f64, [mut low, mut high]: [f64; 2], noise: f64) -> f64 {
    let mut at_low = g(low);
    let mut at_high = g(high);
    let begin = low;
    // A mode begins on its surface, as far as rounding can tell: the positive part may be shorter
    // than any sample.
    let mut span = high - begin;
    while at_low <= noise {
        span *= 0.5;
        if span < SHORTEST {
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

/// The secant method on steps that end at the event.
fn refine(field: &mut Field, step: &Step, condition: Condition, theta: f64) -> Found {
    let mut trial = step.clone();
    let mut end = |theta: f64| {
        let state = if theta == 0.0 {
            step.start.clone()
        } else {
            trial.attempt(field, theta * step.h);
            trial.end.clone()
        };
        let value = value(field, condition, step.t + theta * step.h, &state);
        (state, value)
    };
    let (mut state, mut value) = end(theta);
    let mut best = theta;
    let mut other = theta * (1.0 - SECANT_OFFSET);
    let mut at_other = if theta > 0.0 { end(other).1 } else { 0.0 };
    for _ in 0..6 {
        let next = best - value * (best - other) / (value - at_other);
        let is_near = (next - theta).abs() <= NEAR * theta && next <= 1.0;
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
    Found { condition, h, state, is_jump: false }
}

/// Newton's steps onto a surface that is reached but for rounding and tolerances: the least change
/// of the states, each in units of how exact it is. What more than that would be needed for, such
/// as rounding of the time where states hardly move the surface, is left as it is.
fn bring_to(field: &mut Field, surface: usize, t: f64, state: &mut [f64]) {
    let exact: Vec<f64> =
        state.iter().enumerate().map(|(i, x)| field.tolerance.of(i, [*x; 2], 0.0)).collect();
    for _ in 0..2 {
        let normals = field.normals(t, state);
        let slope = normals.by_state.row(surface);
        let largest = slope.iter().zip(&exact).map(|(d, e)| (d * e).abs()).fold(0.0, f64::max);
        let shares: Vec<f64> = slope.iter().zip(&exact).map(|(d, e)| d * e / largest).collect();
        let square: f64 = shares.iter().map(|share| share * share).sum();
        let factor = normals.psi[surface] / largest / square;
        // In units of how exact the states are.
        let way = factor.abs() * square.sqrt();
        if way.is_nan() || way > 1.0 {
            return;
        }
        let changes = shares.iter().zip(&exact).map(|(share, e)| factor * share * e);
        state.iter_mut().zip(changes).for_each(|(x, change)| *x -= change);
    }
}
