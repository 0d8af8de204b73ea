//! Controls that are angles, without the full turns that mean nothing: on a grid each interval may
//! have its own, but no polynomial goes through all of them.

use super::Whole;
use fdcc_compiler::Model;
use fdcc_runtime::problem::{Bounds, Problem};
use fdcc_runtime::solution::phases::Jump;
use fdcc_runtime::solve::Outcome;
use std::f64::consts::TAU;

impl Whole {
    /// A smoothed answer, in which angles turn no more than they have to.
    pub fn of_smoothed(
        model: &Model,
        problem: &Problem,
        mut outcome: Outcome,
        jumps: Vec<(usize, Jump)>,
    ) -> Self {
        let angles = model.are_angles().into_iter().enumerate().filter(|it| it.1);
        for (control, _) in angles {
            let bounds = problem.controls[control].bounds;
            let own = &mut outcome.trajectory;
            without_turns(&mut own.controls[control], bounds);
            own.nodes.iter_mut().for_each(|it| without_turns(&mut it.values[control], bounds));
        }
        Whole { outcome, is_exact: false, jumps, phases: Vec::new(), beside: Vec::new() }
    }
}

/// As far as bounds leave room for all of them, else not at all.
fn without_turns(values: &mut [f64], bounds: Bounds) {
    let mut own = values.to_vec();
    for k in 1..own.len() {
        own[k] -= TAU * ((own[k] - own[k - 1]) / TAU).round();
    }
    let least = own.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = own.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let up = TAU * ((bounds.lower - least) / TAU).ceil().max(0.0);
    let down = TAU * ((largest - bounds.upper) / TAU).ceil().max(0.0);
    let shift = if up > 0.0 { up } else { -down };
    if least + shift >= bounds.lower && largest + shift <= bounds.upper {
        values.iter_mut().zip(own).for_each(|(value, own)| *value = own + shift);
    }
}
