//! What is checked of a located answer before it is called an optimum of the true system.

use super::Solution;
use super::true_optimum::{
    Certificate, Check, Located, Stretch, Switch, is_attracted, width, wrong_sign,
};
use crate::verification::{Verification, modes};
use fdcc_compiler::Arc;
use fdcc_runtime::problem::Problem;
use fdcc_runtime::solution::modes::Span;

/// The replay may differ by so much, for how far each state moves; so may conditions and bounds be
/// violated.
const REPLAYED: f64 = 1e-6;
/// The optimality error of the chain of phases.
const STATIONARY: f64 = 1e-7;
/// A slope of the Hamiltonian on an arc may have the wrong sign by so much of its size.
const WRONG_SIGN: f64 = 1e-5;
/// Inside of a phase the Hamiltonian of an autonomous system may change by so much of its size.
const HAMILTONIAN: f64 = 1e-4;
/// For so much of the time plan and replay may be in different modes.
const MODES: f64 = 1e-4;

/// Of a located answer with its replay; `between` is the smoothed problem.
pub(super) fn certificate(
    located: &Located,
    between: &Problem,
    solution: &Solution,
    replay: Option<&Verification>,
) -> Certificate {
    let own = &located.outcome.solution;
    let check = |name, figure, limit| Check { name, figure, limit };
    let unknown = f64::INFINITY;
    let violation = |it: &Verification| it.worst().map_or(0.0, |condition| condition.part.abs());
    let model = solution.model().meaning();
    let phases = 0..located.structure.phases.len();
    let is_held = phases.clone().all(|j| is_attracted(model, located, j));
    let checks = vec![
        check("stationary", own.kkt_error, STATIONARY),
        check("second order", f64::from(u8::from(own.is_saddle)), 0.0),
        check("replayed", replay.and_then(Verification::state_gap).unwrap_or(unknown), REPLAYED),
        check("conditions", replay.map_or(unknown, violation), REPLAYED),
        check("modes", replay.map_or(unknown, |it| other_modes(solution, it)), MODES),
        check("bounds", beyond_bounds(between, solution), REPLAYED),
        check("arcs", wrong_sign(between, located).map_or(0.0, |it| it.2.max(0.0)), WRONG_SIGN),
        check("holds", f64::from(u8::from(!is_held)), 0.0),
        check("insertion", f64::from(u8::from(!located.is_tested)), 0.0),
        check("hamiltonian", hamiltonian(located), HAMILTONIAN),
    ];
    let switches = switches(between, solution);
    Certificate { checks, switches, arcs: arcs(between, located) }
}

fn switches(between: &Problem, solution: &Solution) -> Vec<Switch> {
    let mut all = Vec::new();
    for (surface, spans) in between.surfaces.iter().zip(&solution.outcome.modes) {
        all.extend(spans.windows(2).map(|pair| Switch {
            surface: surface.name.clone(),
            time: pair[1].from,
            from: pair[0].mode,
            to: pair[1].mode,
        }));
    }
    all.sort_by(|a, b| a.time.total_cmp(&b.time));
    all
}

fn arcs(between: &Problem, located: &Located) -> Vec<(String, Vec<Stretch>)> {
    let of = |control: usize| {
        let mut all: Vec<Stretch> = Vec::new();
        let structure = &located.structure;
        for (phase, pair) in structure.phases.iter().zip(structure.times.windows(2)) {
            let arc = match phase.arcs[control] {
                Arc::Lower => "min",
                Arc::Free => "free",
                Arc::Upper => "max",
            };
            match all.last_mut().filter(|it| it.arc == arc) {
                Some(stretch) => stretch.to = pair[1],
                None => all.push(Stretch { arc, from: pair[0], to: pair[1] }),
            }
        }
        all
    };
    between.controls.iter().enumerate().map(|(at, it)| (it.name.clone(), of(at))).collect()
}

/// By how much a control leaves its bounds anywhere, for their distance: between nodes it is a
/// polynomial.
fn beyond_bounds(between: &Problem, solution: &Solution) -> f64 {
    let dense = solution.dense_controls();
    let columns = between.controls.iter().zip(&dense);
    let beyond = columns.map(|(control, values)| {
        let width = width(control.bounds);
        let most = values.iter().map(|value| control.bounds.violation(*value));
        most.fold(0.0, f64::max) / width
    });
    beyond.fold(0.0, f64::max)
}

/// The part of the time on which the replay is in another mode than the plan, of the surface where
/// that is most.
fn other_modes(solution: &Solution, replay: &Verification) -> f64 {
    let time = solution.time();
    let duration = time[time.len() - 1] - time[0];
    let planned = &solution.outcome.modes;
    // A `Dir` has a surface for each component in a replay: all are held, or none.
    if planned.len() != replay.stays.len() {
        return 0.0;
    }
    let of = |(spans, stays): (&Vec<Span>, &Vec<crate::verification::Stay>)| {
        let same: f64 = spans
            .iter()
            .flat_map(|span| stays.iter().map(move |stay| (span, stay)))
            .filter(|(span, stay)| crate::names::mode_name(span.mode) == modes::name(stay.mode))
            .map(|(span, stay)| (span.to.min(stay.to) - span.from.max(stay.from)).max(0.0))
            .sum();
        1.0 - same / duration
    };
    planned.iter().zip(&replay.stays).map(of).fold(0.0, f64::max)
}

/// By how much of its size the Hamiltonian changes inside of a phase, at most; 0 where time matters
/// by itself.
fn hamiltonian(located: &Located) -> f64 {
    let of = |phase: &fdcc_runtime::solve::Outcome| {
        let own = &phase.trajectory.hamiltonian;
        let least = own.values.iter().copied().fold(f64::INFINITY, f64::min);
        let largest = own.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if own.is_constant && !own.is_noise { (largest - least) / own.size } else { 0.0 }
    };
    located.outcome.phases.iter().map(of).fold(0.0, f64::max)
}
