//! What may end a mode, sampled along a step.
//!
//! The surfaces beside the state are functions of the state alone: all samples in one call. The selectors of sliding
//! surfaces each need a linear system; where three samples tell that they stay off their ends, there are no more.

use super::field::{Field, Mode};
use super::locate::{Condition, reserve};
use super::step::Step;
use crate::problem::Columns;

/// Times of the samples, in parts of the step.
const THETAS: [f64; 9] = [0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0];

/// Samples of a condition, which holds where they are not negative.
pub(super) struct Samples {
    pub condition: Condition,
    pub thetas: &'static [f64],
    pub values: Vec<f64>,
}

impl Samples {
    /// Whether a sample is negative or may have a negative value beside it.
    pub fn may_end(&self) -> bool {
        (1..self.values.len()).any(|k| self.values[k] < 0.0 || self.is_dip(k))
    }

    /// Whether there is a minimum near a sample which may be below 0: a parabola through three samples goes
    /// below the least by an eighth of their second difference at most.
    pub fn is_dip(&self, k: usize) -> bool {
        let values = &self.values;
        k + 1 < values.len()
            && values[k] <= values[k - 1].min(values[k + 1])
            && values[k] <= values[k - 1] - 2.0 * values[k] + values[k + 1]
    }
}

/// Samples of `side psi` for every surface beside the state.
pub(super) fn besides(field: &mut Field, step: &Step) -> Vec<Samples> {
    let is_beside = |mode: &Mode| matches!(mode, Mode::Below | Mode::Above);
    if !field.modes.iter().any(is_beside) {
        return Vec::new();
    }
    let mut psi = Columns::new(field.modes.len(), THETAS.len());
    field.psi_along(step, &THETAS, &mut psi);
    let surfaces = (0..field.modes.len()).filter(|&i| is_beside(&field.modes[i]));
    let of = |i: usize| Samples {
        condition: Condition::Reaches(i),
        thetas: &THETAS,
        values: psi.column(i).iter().map(|psi| field.modes[i].side() * psi).collect(),
    };
    surfaces.map(of).collect()
}

/// Samples of `side e` for every kink.
pub(super) fn kinks(field: &mut Field, step: &Step) -> Vec<Samples> {
    let count = field.system.kinks.outputs();
    if count == 0 || field.is_blind {
        return Vec::new();
    }
    let rows: Vec<Vec<f64>> =
        THETAS.iter().map(|theta| field.bends(step.t + theta * step.h, &step.at(*theta)).psi).collect();
    let of = |k: usize| Samples {
        condition: Condition::Bends(k),
        thetas: &THETAS,
        values: rows.iter().map(|row| field.side_of(k) * row[k]).collect(),
    };
    (0..count).map(of).collect()
}

/// Samples of `1 - |s|` for every sliding surface, and every ball at rest.
pub(super) fn slidings(field: &mut Field, step: &Step) -> Vec<Samples> {
    let is_first = |i: &usize| field.ball_of(*i).is_none_or(|ball| ball.surfaces.start == *i);
    let sliding: Vec<usize> = field.sliding().into_iter().filter(is_first).collect();
    if sliding.is_empty() {
        return Vec::new();
    }
    const COARSE: [f64; 3] = [0.0, 0.5, 1.0];
    let coarse = selectors_along(field, step, &sliding, &COARSE);
    if coarse.iter().all(|samples| is_far(&samples.values)) {
        return Vec::new();
    }
    selectors_along(field, step, &sliding, &THETAS)
}

/// Whether the ends are farther than a bend between the samples goes.
fn is_far(values: &[f64]) -> bool {
    let bend = values[0] - 2.0 * values[1] + values[2];
    values.iter().all(|value| *value > bend.abs())
}

fn selectors_along(
    field: &mut Field,
    step: &Step,
    sliding: &[usize],
    thetas: &'static [f64],
) -> Vec<Samples> {
    let empty = |&i: &usize| Samples { condition: Condition::Leaves(i), thetas, values: Vec::new() };
    let mut all: Vec<Samples> = sliding.iter().map(empty).collect();
    let mut rate = vec![0.0; step.start.len()];
    for theta in thetas {
        field.rate_into(step.t + theta * step.h, &step.at(*theta), &mut rate);
        for (samples, &i) in all.iter_mut().zip(sliding) {
            samples.values.push(reserve(field, i));
        }
    }
    all
}
