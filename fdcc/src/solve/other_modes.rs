//! Whether a replay is in the modes that were planned.

use super::Solution;
use super::true_optimum::certificate_limits::REPLAYED;
use crate::verification::{Stay, Verification, modes};
use fdcc_compiler::{Model, Switch, is_kink};
use fdcc_runtime::problem::{Columns, Problem};
use fdcc_runtime::solution::Trajectory;
use fdcc_runtime::solution::modes::Span;

/// The part of the time on which the replay is in another mode than the plan, of the surface where
/// that is most. Where the plan is on the surface itself, its selector may be 1 or -1 in either
/// mode: a belt may carry a box with all the friction that there is.
pub(super) fn other_modes(model: &Model, solution: &Solution, replay: &Verification) -> f64 {
    let time = solution.time();
    let duration = time[time.len() - 1] - time[0];
    let written = &solution.model().meaning().surfaces;
    let sizes = sizes(&solution.problem, &solution.outcome.trajectory);
    let of = |(at, switch): (usize, &Switch)| {
        // The components of a `Dir` are held together.
        let name = &model.surfaces[switch.surfaces.start].place.name;
        let stays = written.iter().position(|it| it.place.name == *name);
        let Some(stays) = stays.and_then(|at| replay.stays.get(at)) else { return f64::INFINITY };
        let spans = &solution.outcome.modes[at];
        let psi = &solution.outcome.trajectory.switching[at];
        let size = psi.iter().fold(sizes[at], |size: f64, it| size.max(it.abs()));
        let is_off = |k: usize| psi[k..].iter().take(2).any(|it| it.abs() > REPLAYED * size);
        let is_other = |k: usize| {
            let middle = 0.5 * (time[k] + time[k + 1]);
            let span = spans.iter().find(|it| middle <= it.to);
            let stay = stays.iter().find(|it| middle <= it.to);
            !span.zip(stay).is_some_and(|(span, stay)| is_same(switch, span, stay))
        };
        let others = (0..time.len() - 1).filter(|k| is_off(*k) && is_other(*k));
        others.map(|k| time[k + 1] - time[k]).sum::<f64>() / duration
    };
    // On a kink, both modes are the same.
    let all = model.switches().into_iter().enumerate();
    let meant = all.filter(|it| !is_kink(&it.1.place.name));
    meant.map(|(at, switch)| of((at, &switch))).fold(0.0, f64::max)
}

fn is_same(switch: &Switch, span: &Span, stay: &Stay) -> bool {
    let held = "held";
    let [own, its] = [crate::names::mode_name(span.mode), modes::name(stay.mode)];
    if switch.is_ball { (own == held) == (its == held) } else { own == its }
}

/// What the terms of each switching function change by along the motion, at most: by what it is
/// another where one state is further by as much as it moves. A surface that is never left has no
/// other size.
fn sizes(problem: &Problem, trajectory: &Trajectory) -> Vec<f64> {
    let points = points(problem, trajectory);
    let values = |points: &Columns| {
        let mut values = Columns::new(problem.switching.outputs(), points.count());
        problem.switching.value(points, &trajectory.parameters, &mut values);
        values
    };
    let (own, mut sizes) = (values(&points), vec![0.0; problem.switching.outputs()]);
    for (at, column) in trajectory.states.iter().enumerate() {
        let (mut moved, by) = (points.clone(), extent(column));
        moved.column_mut(1 + at).iter_mut().for_each(|it| *it += by);
        let moved = values(&moved);
        for (surface, size) in sizes.iter_mut().enumerate() {
            let pairs = moved.column(surface).iter().zip(own.column(surface));
            let changes = pairs.map(|(a, b)| (a - b).abs()).filter(|it| it.is_finite());
            *size += changes.fold(0.0, f64::max);
        }
    }
    sizes
}

/// Time and states at the grid points.
fn points(problem: &Problem, trajectory: &Trajectory) -> Columns {
    let (inputs, count) = (problem.switching.layout().point_inputs(), trajectory.time.len());
    let mut points = Columns::new(inputs, count);
    let [first, last] = [trajectory.time[0], trajectory.time[count - 1]];
    for (tau, time) in points.column_mut(0).iter_mut().zip(&trajectory.time) {
        *tau = (time - first) / (last - first);
    }
    for (at, column) in trajectory.states.iter().enumerate() {
        points.column_mut(1 + at).copy_from_slice(column);
    }
    points
}

/// From the least to the largest value.
fn extent(values: &[f64]) -> f64 {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least
}
