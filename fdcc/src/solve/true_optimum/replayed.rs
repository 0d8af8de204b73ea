//! What the true system does with the controls of an answer: the modes and jumps that a structure
//! may have.

use super::Whole;
use crate::verification::{Verification, modes};
use fdcc_compiler::Model;
use fdcc_runtime::simulate::{Event, EventKind, Mode as Motion};
use fdcc_runtime::solution::modes::{Mode, Span};
use fdcc_runtime::solution::phases::Jump;

/// The trajectory of a replay, on the grid of what was replayed; nothing if it did not reach the
/// last time. `model` is what holds between jumps.
pub(crate) fn replayed(model: &Model, whole: &Whole, replay: &Verification) -> Option<Whole> {
    if !replay.is_whole {
        return None;
    }
    let mut other = Whole { is_exact: true, phases: Vec::new(), ..whole.clone() };
    let (trajectory, simulation) = (&mut other.outcome.trajectory, &replay.simulation);
    let intervals = trajectory.time.len() - 1;
    for (column, found) in trajectory.states.iter_mut().zip(&simulation.states) {
        let each = (found.len() - 1) / intervals;
        column.iter_mut().enumerate().for_each(|(k, value)| *value = found[k * each]);
    }
    other.outcome.modes = stays(model, replay)?;
    other.jumps = simulation.events.iter().filter_map(jump).collect();
    Some(other)
}

/// What each of [`Model::switches`] does.
fn stays(model: &Model, replay: &Verification) -> Option<Vec<Vec<Span>>> {
    let of = |first: usize| {
        let name = &model.surfaces[first].place.name;
        let at = replay.system.surfaces.iter().position(|it| it.name == *name)?;
        let span = |it: &modes::Stay| Span { mode: mode(it.mode), from: it.from, to: it.to };
        Some(replay.stays[at].iter().map(span).collect())
    };
    model.switches().iter().map(|switch| of(switch.surfaces.start)).collect()
}

fn mode(of: Motion) -> Mode {
    match of {
        Motion::Below => Mode::Below,
        Motion::Sliding | Motion::Held => Mode::Held,
        Motion::Above | Motion::Moving => Mode::Above,
    }
}

fn jump(event: &Event) -> Option<(usize, Jump)> {
    let EventKind::Jump(at) = event.kind else { return None };
    let Event { time, before, after, .. } = event.clone();
    Some((at, Jump { time, before, after }))
}
