//! The bounds of variables and rows.

use super::boundary;
use super::interval::{Interval, Signal};
use crate::linalg::Stages;
use crate::problem::{Bounds, Problem};

pub(super) fn of_variables(problem: &Problem, stages: Stages, interval: &Interval) -> Vec<Bounds> {
    let mut bounds = vec![Bounds::FREE; stages.variables()];
    let of = |signal: Signal| match signal {
        Signal::State(i) => problem.states[i].bounds,
        Signal::Control(i) => problem.controls[i].bounds,
    };
    for k in 0..=stages.intervals {
        let end = if k < stages.intervals { stages.variable_step() } else { stages.states };
        for (variable, slot) in (stages.state(k).start..).zip(&interval.slots[..end]) {
            bounds[variable] = of(slot.signal);
        }
        // A control that was handed on has its bounds where it was chosen.
        if k > 0 {
            bounds[stages.state(k)][problem.layout.x..].fill(Bounds::FREE);
        }
    }
    for (variable, start) in stages.state(0).zip(&problem.start) {
        if let Some(value) = start {
            bounds[variable] = Bounds::fixed(*value);
        }
    }
    for (variable, unknown) in stages.globals().zip(&problem.unknowns) {
        bounds[variable] = unknown.bounds;
    }
    for (variable, value) in boundary::given_at_the_end(problem, stages) {
        // On its bound the state would have no interior.
        if bounds[variable].violation(value) == 0.0 {
            bounds[variable] = Bounds::FREE;
        }
    }
    bounds
}

pub(super) fn of_rows(problem: &Problem, stages: Stages) -> Vec<Bounds> {
    let mut bounds = vec![Bounds::fixed(0.0); stages.rows()];
    for k in 0..stages.intervals {
        let path = problem.path_bounds.iter().cycle();
        bounds[stages.local(k)].iter_mut().zip(path).for_each(|(bounds, path)| *bounds = *path);
    }
    bounds[stages.coupling()].copy_from_slice(&problem.boundary_bounds);
    bounds
}
