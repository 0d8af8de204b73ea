//! A model with surfaces as a chain of phases with given modes: the true system, where nothing is
//! smoothed.
//!
//! In each phase every surface has a mode, which gives its selector a meaning:
//!
//! ```text
//! above    s =  1       psi >= 0          psi(T_j+1) = 0 where the phase after it has another mode
//! below    s = -1       psi <= 0          the same
//! held     |s| <= 1     psi' = 0          s is a control of the phase
//! ```
//!
//! A `Dir` moves (`s = psi/|psi|`) or is held (`|s| <= 1`, `psi' = 0` for each component). That a
//! held surface has `psi = 0` follows from where the phase begins; at its end nothing is said. The
//! times at which phases end are unknowns, and everything is smooth inside of a phase, so that an
//! optimum of the chain is one of the system that was written, with its switches located.
//!
//! A control may have an *arc*: it is at one of its bounds throughout a phase. So may a state or a
//! path condition: `limits`.

mod begun;
mod beside_jumps;
mod departures;
mod ends;
mod hamiltonian;
mod hold_normals;
mod hold_parameters;
mod independent;
mod junctions;
mod limits;
mod linked;
mod links;
mod phase;
mod starts;

pub use begun::with_beginnings;
pub use departures::{is_uncontrolled, may_hold};
pub use hamiltonian::{Point, hamiltonian};
pub use hold_normals::{HoldNormals, NormalsAt};
pub use hold_parameters::Slopes;
pub use limits::{Limit, limits};

use super::division::{Division, divide, numbered};
use super::in_phases::divided;
use super::shares::Shares;
use super::{Jumps, MultiPhase, between_jumps};
use crate::model::{Model, Place, Symbol, not_yet};
use fdcc_grammar::Diagnostic;
use fdcc_runtime::problem::ControlShape;
use linked::Linked;

/// Where the state is relative to a surface in a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Mode {
    /// `psi <= 0`
    Below,
    /// `psi = 0`, and the selector is whatever keeps it so; a `Dir` rests.
    Held,
    /// `psi >= 0`; a `Dir` moves.
    Above,
}

/// What a control, a state or a path condition does in a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Arc {
    /// It is at its lower bound.
    Lower,
    /// It is between its bounds.
    Free,
    /// It is at its upper bound.
    Upper,
}

/// What holds throughout a phase.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct PhaseOfModes {
    /// One for each of [`Model::switches`].
    pub modes: Vec<Mode>,
    /// One for each control.
    pub arcs: Vec<Arc>,
    /// One for each of [`limits()`].
    pub contacts: Vec<Arc>,
    /// One for each of [`limits()`]: which are touched at the beginning, and left at once.
    pub touches: Vec<Arc>,
    /// The jump that happens at the beginning: an index into [`Model::jumps`] and behind these into
    /// [`crossings`](super::crossings()).
    pub jump: Option<usize>,
    /// What its controls are on an interval.
    pub shape: ControlShape,
    /// How often its intervals are halved.
    pub halvings: u32,
    /// Whether its intervals get shorter and shorter towards its ends.
    pub is_graded: bool,
    /// Around which times inside of it intervals get shorter, in parts of 2^16 of its duration.
    pub steep: Vec<u16>,
    /// Whether controls jump where it begins, though nothing else changes.
    pub is_cut: bool,
    /// Whether controls that reach their bounds where it begins are at these on both sides, though
    /// an arc of a limit begins or ends there; and surfaces that are left there are left along
    /// them.
    pub is_joined: bool,
}

impl PhaseOfModes {
    /// Whether it is the same as the phase before it, and nothing happens between them.
    pub fn goes_on(&self, before: &Self) -> bool {
        self.is_alike(before)
            && self.shape == before.shape
            && self.halvings == before.halvings
            && self.is_graded == before.is_graded
            && self.steep == before.steep
    }

    /// Whether nothing happens between the phase before it and itself, which may only be on other
    /// intervals.
    pub fn is_alike(&self, before: &Self) -> bool {
        let is_same = self.modes == before.modes && self.arcs == before.arcs;
        let is_touched = self.touches.iter().any(|it| *it != Arc::Free);
        let is_given = !self.arcs.contains(&Arc::Free) && !self.modes.contains(&Mode::Held);
        is_same
            && self.contacts == before.contacts
            && !is_touched
            && (!self.is_cut || is_given)
            && self.jump.is_none()
    }

    /// Whether it reaches the limits that one of two others reaches, and both reach some.
    pub fn is_union(&self, before: &Self, after: &Self) -> bool {
        let both = before.contacts.iter().zip(&after.contacts);
        let union = both.map(|(a, b)| if *a == Arc::Free { *b } else { *a });
        self.contacts != before.contacts
            && self.contacts != after.contacts
            && self.contacts.iter().copied().eq(union)
    }

    /// Whether something determines the controls at each node.
    pub fn needs_polynomials(&self) -> bool {
        self.modes.contains(&Mode::Held) || self.contacts.iter().any(|it| *it != Arc::Free)
    }

    /// Whether as many limits are reached as controls are free: an arc of one of these would be
    /// another condition.
    pub fn are_controls_given(&self) -> bool {
        let count = |arcs: &[Arc], is_free: bool| {
            arcs.iter().filter(|it| (**it == Arc::Free) == is_free).count()
        };
        let reached = count(&self.contacts, false);
        reached > 0 && reached >= count(&self.arcs, true)
    }

    /// Controls and limits are between their bounds.
    pub fn release(&mut self) {
        for arcs in [&mut self.arcs, &mut self.contacts, &mut self.touches] {
            arcs.fill(Arc::Free);
        }
    }

    /// Begins where a phase that is left out began, with what happens there.
    pub fn begin_like(&mut self, gone: &Self) {
        self.jump = self.jump.or(gone.jump);
        let touched = gone.contacts.iter().zip(&gone.touches);
        for ((own, contact), (arc, touch)) in
            self.touches.iter_mut().zip(&self.contacts).zip(touched)
        {
            let of_gone = if *arc == Arc::Free { *touch } else { *arc };
            if *own == Arc::Free && *contact == Arc::Free {
                *own = of_gone;
            }
        }
    }
}

/// The model in which exactly these phases follow each other; none has surfaces.
///
/// # Errors
///
/// What cannot be divided into phases of given modes: phases, sums over rows of which the objective
/// is no sum.
pub fn with_modes(model: &Model, phases: &[PhaseOfModes]) -> Result<Model, Vec<Diagnostic>> {
    with_modes_from(model, phases, None)
}

/// The model in which these phases of given modes follow each other in each of its phases.
///
/// # Errors
///
/// What cannot be divided into phases of given modes: sums over rows of which the objective is no
/// sum.
pub fn with_modes_in_phases(
    model: &Model,
    structures: &[&[PhaseOfModes]],
) -> Result<Model, Vec<Diagnostic>> {
    divided(model, &mut |phase, own| {
        let linked = Linked::new(model, structures, phase);
        with_modes_from(&own, structures[phase], Some(linked))
    })
}

/// The same of one of several phases, which links put where it begins.
fn with_modes_from(
    model: &Model,
    phases: &[PhaseOfModes],
    linked: Option<Linked>,
) -> Result<Model, Vec<Diagnostic>> {
    refuse(model)?;
    let (jumps, mut whole) = (Jumps::new(model)?, prepared(model));
    let place = |j: usize| Place { name: format!("time of switch {j}"), ..Place::default() };
    let times = divide(&mut whole, (1..phases.len()).map(place).collect());
    let events: Vec<Option<usize>> = phases[1..].iter().map(|it| it.jump).collect();
    let between = MultiPhase::new(&jumps, Division::new(&whole, times), &events);
    Ok(Modes { between, phases, linked }.into_model())
}

/// The model with symbols of selectors that are chosen, which stand behind the controls.
fn prepared(model: &Model) -> Model {
    let mut whole = Model { smooth: false, ..between_jumps(model).into_owned() };
    for at in 0..whole.surfaces.len() {
        let at = model.controls.len() + at;
        for symbol in [Symbol::Control, Symbol::ControlAtStart, Symbol::ControlAtEnd] {
            whole.symbols_mut().input(symbol(at));
        }
    }
    whole
}

fn refuse(model: &Model) -> Result<(), Vec<Diagnostic>> {
    let phase = model.phases.first().map(|it| not_yet(it.place.span, "a switch within a phase"));
    let sum = model.sums.first().filter(|_| !model.are_sums_terms());
    let sum = sum.map(|it| not_yet(it.place.span, "a function of a sum over rows with switches"));
    let found = model.not_yet.first().cloned().or(phase).or(sum);
    found.map_or(Ok(()), |it| Err(vec![it]))
}

struct Modes<'m> {
    /// What the jumps make of the phases.
    between: MultiPhase<'m>,
    phases: &'m [PhaseOfModes],
    /// What links say of the state at the first time.
    linked: Option<Linked>,
}

impl Modes<'_> {
    fn into_model(mut self) -> Model {
        let model = self.between.division.model;
        let shares = Shares::new(model, &mut self.between.division.graph);
        let (last, boundary) = (self.between.division.last(), self.boundary());
        if last == 0 {
            let objective = model.objective.clone();
            let phase = self.phase(0, &shares);
            let boundary = phase.boundary.iter().chain(&boundary).cloned().collect();
            return Model { boundary, objective, ..phase };
        }
        let phases = numbered(&model.name, (0..=last).map(|j| self.phase(j, &shares)));
        let mut links: Vec<_> = (0..last).map(|j| self.link(j)).collect();
        links.extend(self.between.division.link_of_whole(&shares, &boundary));
        let Division { graph, symbols, .. } = self.between.division;
        let (surfaces, balls) = (Vec::new(), Vec::new());
        Model { graph, symbols, phases, links, surfaces, balls, ..model.clone() }
    }
}
