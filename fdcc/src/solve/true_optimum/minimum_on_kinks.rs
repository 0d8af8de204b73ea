//! Whether the controls minimise the Hamiltonian of a model with its kinks, where unknowns stood
//! for them: what these were allowed knows nothing of the other side of a kink of the right side.

use super::insertion::{Least, at_point, hamiltonian_at, least};
use super::minimum::{controls_at, interpolation, is_far, samples};
use super::point::point_of;
use super::range::ranges;
use super::tuning::minimum::PARTS;
use fdcc_compiler::{Arc, Model, PhaseOfModes, limits};
use fdcc_runtime::problem::{ControlShape, Problem};
use fdcc_runtime::solve::Outcome;
use std::ops::ControlFlow;
use std::slice;

/// By how much other controls make the Hamiltonian of a model without surfaces less, at most, at a
/// few points of its trajectory.
pub(crate) fn gain_on_kinks(model: &Model, problem: &Problem, outcome: &Outcome) -> f64 {
    let own = &outcome.trajectory;
    let (phase, last) = (without_modes(model), own.time.len() - 2);
    let ranges = ranges(&problem.controls, slice::from_ref(outcome));
    let is_limited = !limits(model).is_empty();
    let gain = |part: &f64| {
        let k = (part * last as f64) as usize;
        let states = model.states.len();
        let at = point_of(own, (problem, states), &interpolation(&own.time, (k, *part)));
        let chain = at_point(model, &phase, &at)?;
        let value =
            |controls: &[f64]| match least(&chain, Some(controls), &|| ControlFlow::Continue(())) {
                Least::Value(value, controls) => Some((value, controls)),
                _ => None,
            };
        let controls = controls_at(own, k, at.time);
        let here = hamiltonian_at(&chain, &controls);
        // On a kink the way down may lead far away; so it does where a limit is kept, of which the
        // Hamiltonian knows nothing.
        let is_near = |it: &[f64]| is_limited || !is_far(&ranges, [&controls, it]);
        let near = value(&controls).filter(|it| is_near(&it.1));
        let near = near.map_or(here, |it| it.0.min(here));
        let others = samples(&ranges, &controls).into_iter().chain([controls]);
        let least = others.filter_map(|it| Some(value(&it)?.0)).min_by(f64::total_cmp)?;
        Some(near - least)
    };
    PARTS.iter().filter_map(gain).fold(0.0, f64::max)
}

fn without_modes(model: &Model) -> PhaseOfModes {
    let free = vec![Arc::Free; limits(model).len()];
    PhaseOfModes {
        jump: None,
        modes: Vec::new(),
        arcs: vec![Arc::Free; model.controls.len()],
        contacts: free.clone(),
        touches: free,
        shape: ControlShape::Polynomial,
        halvings: 0,
        is_graded: false,
        steep: Vec::new(),
        is_cut: false,
        is_joined: false,
    }
}
