//! Where a condition `g >= 0` is touched inside a step: `g` comes so near to 0 that it cannot be
//! told from it, and goes away again.
//!
//! Branch and bound, as in [`search`](super::search): a part of the step is done where `g` is
//! enclosed above the limit or its rate has one sign, and halved else.

use super::search::Signal;
use super::{Condition, conditions};
use crate::simulate::field::Field;
use crate::simulate::steps::Step;
use crate::simulate::tape::{Cause, Touch};
use crate::simulate::tuning::field::ON_SURFACE;
use crate::simulate::tuning::touch::{MOST_PARTS, TOUCHING};

/// What is touched before a part of a step, each once; leaves the selectors as they are, so that a
/// simulation is the same with a tape and without.
pub(crate) fn touches(field: &mut Field, step: &Step, until: f64) -> Vec<Touch> {
    let mut found = Vec::new();
    let selectors = field.selectors.clone();
    for condition in conditions(field) {
        if matches!(condition, Condition::CrossesKink(_) | Condition::Parts(_)) {
            continue;
        }
        let limit = limit(field, step, until, condition);
        let place = look(field, step, condition, |signal| signal.touched(until, limit));
        let time = |theta: f64| step.t + theta * step.h;
        found.extend(place.map(|theta| Touch { of: Cause::from(condition), time: time(theta) }));
    }
    field.selectors = selectors;
    found
}

/// Where before a part of a step a surface is touched that the state is beside, to rounding.
pub(crate) fn touched_exactly(
    field: &mut Field,
    step: &Step,
    until: f64,
    surface: usize,
) -> Option<f64> {
    let condition = Condition::Reaches(surface);
    if look(field, step, condition, |signal| signal.clearly_holds(until)) {
        return None;
    }
    let mut noise = |theta: f64| {
        let state = step.at(theta);
        field.normals(step.t + theta * step.h, &state).noise(surface, &state)
    };
    let limit = ON_SURFACE * noise(0.0).max(noise(until));
    look(field, step, condition, |signal| signal.touched(until, limit))
}

/// Looks along a step with the memory that the field lends.
fn look<'a, R>(
    field: &mut Field<'a>,
    step: &Step,
    condition: Condition,
    look: impl FnOnce(&mut Signal<'_, 'a>) -> R,
) -> R {
    let tube = field.lend_tube();
    let mut signal = Signal { field, step, condition, tube };
    let seen = look(&mut signal);
    signal.field.tube = Some(signal.tube);
    seen
}

/// What cannot be told from 0, for the sizes of the terms of a condition.
fn limit(field: &mut Field, step: &Step, until: f64, condition: Condition) -> f64 {
    let Condition::Reaches(surface) = condition else { return TOUCHING };
    let mut size = |theta: f64| {
        let state = step.at(theta);
        field.normals(step.t + theta * step.h, &state).size(surface, &state)
    };
    TOUCHING * (1.0 + size(0.0).max(size(until)))
}

impl Signal<'_, '_> {
    /// The part of the step before `until` at which the value is first below the limit, while it
    /// is well above it before and after.
    fn touched(&mut self, until: f64, limit: f64) -> Option<f64> {
        let mut parts = vec![[0.0, until]];
        let mut seen = [0.0, until].map(|theta| [theta, self.value(theta)]).to_vec();
        let mut near = Vec::new();
        for _ in 0..MOST_PARTS {
            let Some([from, to]) = parts.pop() else { break };
            let [[least, _], [falls, grows]] = self.bounds([from, to]);
            let is_done = least > limit || falls > 0.0 || grows < 0.0;
            if is_done || to - from <= self.shortest() {
                continue;
            }
            let middle = 0.5 * (from + to);
            let value = self.value(middle);
            if value <= limit {
                near.push(self.turning_point([from, to]));
            } else {
                seen.push([middle, value]);
                parts.extend([[middle, to], [from, middle]]);
            }
        }
        let is_left = |it: &[f64; 2]| it[1] > 2.0 * limit;
        let is_between = |theta: &f64| {
            let mut left = seen.iter().filter(|it| is_left(it)).map(|it| it[0] < *theta);
            let first = left.next();
            first.is_some_and(|side| left.any(|it| it != side))
        };
        near.into_iter().find(is_between)
    }

    /// Where in a part of the step the value ceases to fall.
    fn turning_point(&mut self, [mut from, mut to]: [f64; 2]) -> f64 {
        while to - from > self.shortest() {
            let middle = 0.5 * (from + to);
            let [_, [low, high]] = self.bounds([middle; 2]);
            if low + high < 0.0 {
                from = middle;
            } else {
                to = middle;
            }
        }
        to
    }
}
