//! What a solved structure says of itself: what to leave out, what to release, what to try.

use super::Located;
use super::structure::{Structure, width};
use fdcc_compiler::{Arc, Mode, Model, PhaseOfModes, may_hold};
use fdcc_runtime::problem::{Columns, Problem};
use fdcc_runtime::solution::{Trajectory, control_slopes};
use fdcc_runtime::solve::Outcome;

/// A shorter phase, for the whole time, has shrunk to nothing.
const NOTHING: f64 = 1e-5;
/// A slope of the Hamiltonian by a control that is at a bound may have the wrong sign by so much,
/// for the size of the Hamiltonian and the distance of the bounds.
const WRONG_SIGN: f64 = 1e-5;
/// A surface is 0 where it is smaller than this, for its largest value.
const ON_SURFACE: f64 = 1e-7;
/// What a phase that is tried begins with, for the whole time.
const TRIED: f64 = 0.01;

/// The structure without the phase that is least there; with a control released; else nothing.
pub(super) fn better(model: &Model, between: &Problem, located: &Located) -> Option<Structure> {
    let structure = &located.structure;
    let [first, last] = structure.ends();
    let is_nothing =
        |j: &usize| structure.times[j + 1] - structure.times[*j] < NOTHING * (last - first);
    let count = structure.phases.len();
    let gone: Vec<usize> = (0..count).filter(is_nothing).collect();
    if !gone.is_empty() && gone.len() < count {
        return Some(
            gone.iter().rev().fold(structure.clone(), |rest, j| rest.without_phase(*j)).merged(),
        );
    }
    if let Some(repelled) = (0..structure.phases.len()).find(|j| !is_attracted(model, located, *j))
    {
        return (structure.phases.len() > 1).then(|| structure.without(repelled));
    }
    let (phase, control, _) = wrong_sign(between, located).filter(|it| it.2 > WRONG_SIGN)?;
    let mut other = structure.clone();
    other.phases[phase].arcs[control] = Arc::Free;
    Some(other.merged())
}

/// The phase and the control at a bound whose slope has the wrong sign most, and by how much.
pub(crate) fn wrong_sign(between: &Problem, located: &Located) -> Option<(usize, usize, f64)> {
    let mut all = Vec::new();
    for (j, phase) in located.structure.phases.iter().enumerate() {
        let (problem, outcome) = (&located.chain.phases[j], &located.outcome.phases[j]);
        let slopes = control_slopes(problem, outcome);
        let size = outcome.trajectory.hamiltonian.size.max(f64::MIN_POSITIVE);
        for (control, arc) in phase.arcs.iter().enumerate() {
            let width = width(between.controls[control].bounds);
            let [least, largest] = slopes[control];
            let wrong = match arc {
                Arc::Free => continue,
                Arc::Lower => -least,
                Arc::Upper => largest,
            };
            all.push((j, control, wrong * width / size));
        }
    }
    all.into_iter().max_by(|a, b| a.2.total_cmp(&b.2))
}

/// Whether what is held in a phase draws the state to itself: `psi'` falls with the selector.
pub(crate) fn is_attracted(model: &Model, located: &Located, j: usize) -> bool {
    let phase = &located.structure.phases[j];
    let (problem, trajectory) = (&located.chain.phases[j], &located.outcome.phases[j].trajectory);
    let (mut row, mut control) = (model.path.len(), model.controls.len());
    for (switch, mode) in model.switches().iter().zip(&phase.modes) {
        let count = switch.surfaces.len();
        if *mode == Mode::Held {
            let is_falling = |at: usize| {
                slopes(problem, trajectory, row + at, control + at).iter().all(|it| *it < 0.0)
            };
            if !(0..count).all(is_falling) {
                return false;
            }
            control += count;
        }
        row += match (mode, switch.is_ball) {
            (Mode::Held, true) => count + 1,
            (Mode::Held, false) | (_, false) => count,
            (_, true) => 0,
        };
    }
    true
}

/// The derivative of a path condition by a control, at the beginning of each interval.
fn slopes(problem: &Problem, trajectory: &Trajectory, row: usize, control: usize) -> Vec<f64> {
    let (path, count) = (&*problem.path, trajectory.time.len() - 1);
    let layout = *path.layout();
    let mut points = Columns::new(layout.point_inputs(), count);
    let columns = trajectory.states.iter().chain(&trajectory.controls);
    for k in 0..count {
        points.column_mut(0)[k] = k as f64 / count as f64;
    }
    for (at, column) in columns.enumerate() {
        points.column_mut(1 + at).copy_from_slice(&column[..count]);
    }
    let pattern = path.jacobian_pattern();
    let mut values = Columns::new(path.outputs(), count);
    let mut jacobian = Columns::new(pattern.entries.len(), count);
    path.jacobian(&points, &trajectory.parameters, &mut values, &mut jacobian);
    let place = (row as u32, (layout.controls().start + control) as u32);
    match pattern.entries.iter().position(|it| *it == place) {
        Some(entry) => jacobian.column(entry).to_vec(),
        None => vec![0.0; count],
    }
}

/// With a hold wherever a surface is crossed, and where the motion begins or ends on a surface, or
/// with the `only`th of these alone; nothing where there is no such place.
pub(super) fn with_holds(
    model: &Model,
    located: &Located,
    whole: &Outcome,
    only: Option<usize>,
) -> Option<Structure> {
    let structure = &located.structure;
    let [first, last] = structure.ends();
    let tried = TRIED * (last - first);
    let mut other = Structure { phases: Vec::new(), times: vec![first] };
    let mut add = |phase: PhaseOfModes, until: f64| {
        other.phases.push(phase);
        other.times.push(until);
    };
    let mut places = 0..;
    let mut is_asked =
        |_: &PhaseOfModes| places.next().is_some_and(|at| only.is_none_or(|only| only == at));
    let count = structure.phases.len();
    for j in 0..count {
        let own = &structure.phases[j];
        let length = structure.times[j + 1] - structure.times[j];
        let step = tried.min(0.2 * length);
        if let Some(held) = begins_on(model, located, whole, j).filter(&mut is_asked) {
            add(held, structure.times[j] + step);
        }
        let crossed = structure.phases.get(j + 1).and_then(|next| crossing(model, own, next));
        let end = ends_on(model, located, whole, j).filter(|_| j + 1 == count).or(crossed);
        match end.filter(&mut is_asked) {
            Some(held) => {
                add(own.clone(), structure.times[j + 1] - step);
                add(held, structure.times[j + 1]);
            }
            None => add(own.clone(), structure.times[j + 1]),
        }
    }
    (other.phases.len() > count).then_some(other)
}

/// The modes of the first phase with those surfaces held on which the state begins.
fn begins_on(model: &Model, located: &Located, whole: &Outcome, j: usize) -> Option<PhaseOfModes> {
    if j > 0 {
        return None;
    }
    held_where(model, &located.structure.phases[0], &|surface| {
        is_zero(whole, surface, |column| column[0])
    })
}

/// The modes of the last phase with those surfaces held on which the state ends.
fn ends_on(model: &Model, located: &Located, whole: &Outcome, j: usize) -> Option<PhaseOfModes> {
    held_where(model, &located.structure.phases[j], &|surface| {
        is_zero(whole, surface, |column| column[column.len() - 1])
    })
}

fn held_where(
    model: &Model,
    phase: &PhaseOfModes,
    is_zero: &dyn Fn(usize) -> bool,
) -> Option<PhaseOfModes> {
    let mut held = phase.clone();
    for (switch, may_hold) in may_hold(model).into_iter().enumerate() {
        if may_hold && is_zero(switch) {
            held.modes[switch] = Mode::Held;
        }
    }
    held.arcs.fill(Arc::Free);
    (held.modes != phase.modes).then_some(held)
}

/// A hold between two phases on different sides of a surface.
fn crossing(model: &Model, before: &PhaseOfModes, after: &PhaseOfModes) -> Option<PhaseOfModes> {
    let mut held = before.clone();
    let modes = held.modes.iter_mut().zip(&after.modes).zip(may_hold(model));
    for ((mode, next), may_hold) in modes {
        if may_hold && *mode != *next && *mode != Mode::Held && *next != Mode::Held {
            *mode = Mode::Held;
        }
    }
    held.arcs.fill(Arc::Free);
    (held.modes != before.modes).then_some(held)
}

/// Whether the function of a surface is 0 at an end.
fn is_zero(whole: &Outcome, surface: usize, end: fn(&[f64]) -> f64) -> bool {
    let own = &whole.trajectory.switching[surface];
    let largest = own.iter().fold(0.0, |a: f64, it| a.max(it.abs()));
    end(own).abs() <= ON_SURFACE * largest
}
