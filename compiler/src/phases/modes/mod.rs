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
//! A control may have an *arc*: it is at one of its bounds throughout a phase.

mod links;
mod phase;

use super::division::{Division, divide};
use super::hold::approach;
use super::shares::Shares;
use crate::model::numbers::numbers;
use crate::model::{Model, Phase, Place, Symbol, not_yet};
use fdcc_grammar::Diagnostic;

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

/// What a control does in a phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Arc {
    /// It is at its lower bound.
    Lower,
    /// It is chosen.
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
}

/// The model in which exactly these phases follow each other; none has surfaces.
///
/// # Errors
///
/// What cannot be divided into phases of given modes yet: jumps, phases, sums over rows.
pub fn with_modes(model: &Model, phases: &[PhaseOfModes]) -> Result<Model, Vec<Diagnostic>> {
    refuse(model)?;
    numbers(model)?;
    let mut whole = Model { smooth: false, ..model.clone() };
    let held = |phase: &PhaseOfModes| phase.modes.contains(&Mode::Held);
    if phases.iter().any(held) {
        // Selectors that are chosen stand behind the controls.
        for at in 0..model.surfaces.len() {
            whole.symbols_mut().input(Symbol::Control(model.controls.len() + at));
        }
    }
    let place = |j: usize| Place { name: format!("time of switch {j}"), ..Place::default() };
    let times = divide(&mut whole, (1..phases.len()).map(place).collect());
    let division = Division::new(&whole, times);
    Ok(Modes { division, phases }.into_model())
}

/// For each of [`Model::switches`] whether its own selector acts on `psi'`: else no choice of it holds
/// the surface.
pub fn may_hold(model: &Model) -> Vec<bool> {
    let mut graph = model.graph.clone();
    let mut acts = |surface: usize| {
        let rate = approach(model, &mut graph, model.surfaces[surface].psi);
        let selector = model.input_of(Symbol::Selector(surface));
        selector.is_some_and(|it| graph.inputs_of(&[rate]).contains(&it))
    };
    model.switches().iter().map(|switch| switch.surfaces.clone().all(&mut acts)).collect()
}

fn refuse(model: &Model) -> Result<(), Vec<Diagnostic>> {
    let jump = model.jumps.first().map(|it| not_yet(it.place.span, "a switch beside a jump"));
    let phase = model.phases.first().map(|it| not_yet(it.place.span, "a switch within a phase"));
    let sum = model.sums.first().map(|it| not_yet(it.place.span, "a sum over rows with switches"));
    let found = model.not_yet.first().cloned().or(jump).or(phase).or(sum);
    found.map_or(Ok(()), |it| Err(vec![it]))
}

struct Modes<'m> {
    division: Division<'m>,
    phases: &'m [PhaseOfModes],
}

impl Modes<'_> {
    fn into_model(mut self) -> Model {
        let model = self.division.model;
        let shares = Shares::new(model, &mut self.division.graph);
        let last = self.division.last();
        if last == 0 {
            let (boundary, objective) = (model.boundary.clone(), model.objective.clone());
            return Model { boundary, objective, ..self.phase(0, &shares) };
        }
        let phases: Vec<Phase> = (0..=last)
            .map(|j| Phase {
                place: Place { name: format!("{} {}", model.name, j + 1), ..Place::default() },
                model: self.phase(j, &shares),
                holds_at_first: false,
            })
            .collect();
        let mut links: Vec<_> = (0..last).map(|j| self.link(j)).collect();
        links.extend(self.division.link_of_whole(&shares));
        let Division { graph, symbols, .. } = self.division;
        let (surfaces, balls) = (Vec::new(), Vec::new());
        Model { graph, symbols, phases, links, surfaces, balls, ..model.clone() }
    }
}
