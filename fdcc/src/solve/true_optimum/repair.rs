//! What a solved structure says of itself: what to leave out, what to release.

use super::Located;
use super::contacts::{Contacts, rows_of_switch};
use super::path_values::slopes;
use super::range::ranges;
use super::structure::Structure;
use super::tuning::certificate::{CONTACT, WRONG_SIGN};
use super::tuning::repair::NOTHING;
use fdcc_compiler::{Arc, Mode, Model, is_kink};
use fdcc_runtime::problem::Problem;
use fdcc_runtime::solution::{ControlSlopes, control_slopes};

/// The structure without the phase that is least there; with a control released; else nothing.
pub(super) fn better(model: &Model, between: &Problem, located: &Located) -> Option<Structure> {
    without_contradiction(model, located).or_else(|| released(between, located))
}

/// The structure without the phase that is least there, or without what its multiplier or its
/// motion contradicts; else nothing.
pub(super) fn without_contradiction(model: &Model, located: &Located) -> Option<Structure> {
    let structure = &located.structure;
    if let Some(rest) = without_nothing(structure) {
        return Some(rest);
    }
    if let Some(repelled) = (0..structure.phases.len()).find(|j| !is_attracted(model, located, *j))
    {
        return structure.may_leave_out(repelled).then(|| structure.without(repelled));
    }
    if let Some(wrong) = Contacts::new(model, located).wrong_sign().filter(|it| it.part > CONTACT) {
        return Some(match wrong.is_at_corner {
            true => structure.without_corner(wrong.phase, wrong.limit),
            false => structure.without_contact(wrong.phase, wrong.limit),
        });
    }
    None
}

/// The structure without the phases that have shrunk to nothing, if there are some.
pub(super) fn without_nothing(structure: &Structure) -> Option<Structure> {
    let count = structure.phases.len();
    let is_gone = |j: &usize| {
        is_nothing(structure, *j) && !structure.is_touch(*j) && structure.may_leave_out(*j)
    };
    let gone: Vec<usize> = (0..count).filter(is_gone).collect();
    let rest = || gone.iter().rev().fold(structure.clone(), |rest, j| rest.without_phase(*j));
    (!gone.is_empty() && gone.len() < count).then(|| rest().merged())
}

/// The structure with a control released from a bound that its slope contradicts.
pub(super) fn released(between: &Problem, located: &Located) -> Option<Structure> {
    let wrong = wrong_sign(between, located).filter(|it| it.part > WRONG_SIGN)?;
    let mut other = located.structure.clone();
    other.phases[wrong.phase].arcs[wrong.control] = Arc::Free;
    Some(other.merged())
}

/// The structures without one of the holds that have shrunk to a touch: a touch that is not worth
/// it is stationary, too.
pub(super) fn without_touches(structure: &Structure) -> Vec<Structure> {
    let phases = 0..structure.phases.len();
    let touches = phases.filter(|j| is_nothing(structure, *j) && structure.is_touch(*j));
    touches.filter(|j| structure.may_leave_out(*j)).map(|j| structure.without(j)).collect()
}

/// Whether a jump happens at the very last time: that it happens at all would be a condition that
/// nobody wrote.
pub(crate) fn jumps_in_the_end(structure: &Structure) -> bool {
    let last = structure.phases.len() - 1;
    structure.phases[last].jump.is_some() && is_nothing(structure, last)
}

/// Whether a phase has no length.
pub(super) fn is_nothing(structure: &Structure, j: usize) -> bool {
    let [first, last] = structure.ends();
    structure.times[j + 1] - structure.times[j] < NOTHING * (last - first)
}

/// A control at a bound in a phase, whose slope has the wrong sign.
pub(crate) struct WrongArc {
    phase: usize,
    control: usize,
    /// By how much, for the size of the Hamiltonian and the distance of the bounds.
    pub part: f64,
}

/// The worst of all arcs.
pub(crate) fn wrong_sign(between: &Problem, located: &Located) -> Option<WrongArc> {
    let mut all = Vec::new();
    let ranges = ranges(&between.controls, &located.outcome.phases);
    for (j, phase) in located.structure.phases.iter().enumerate() {
        let (problem, outcome) = (&located.chain.phases[j], &located.outcome.phases[j]);
        let slopes = control_slopes(problem, outcome);
        let own = outcome.trajectory.hamiltonian.scale.max(f64::MIN_POSITIVE);
        let size = located.size_of_phase(j).max(own);
        for (control, arc) in phase.arcs.iter().enumerate() {
            let ControlSlopes { least, largest, terms } = slopes[control];
            let wrong = match arc {
                Arc::Free => continue,
                Arc::Lower => -least.0,
                Arc::Upper => largest.0,
            };
            let that_matters = if terms > 0.0 { own / terms } else { 0.0 };
            let part = ranges[control].worth(wrong, that_matters) / size;
            all.push(WrongArc { phase: j, control, part });
        }
    }
    all.into_iter().max_by(|a, b| a.part.total_cmp(&b.part))
}

/// Whether what is held in a phase draws the state to itself: `psi'` falls with the selector. On a
/// kink nothing depends on that, and controls alone keep the motion there.
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
            if !is_kink(&switch.place.name) && !(0..count).all(is_falling) {
                return false;
            }
            control += count;
        }
        row += rows_of_switch(switch, *mode);
    }
    true
}
