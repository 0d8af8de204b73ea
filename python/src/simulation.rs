//! Simulations of the true system.

use crate::column::Column;
use fdcc::SimulationOfPhases;
use pyo3::prelude::*;
use std::sync::Arc;

/// What the true system does, or one of its phases.
#[pyclass(frozen, module = "fdcc._fdcc")]
pub struct Simulation {
    found: Arc<Found>,
    phase: Option<usize>,
    model: fdcc::Model,
}

/// Of one piece, or of several.
enum Found {
    One(Box<fdcc::Simulation>),
    Phases(SimulationOfPhases),
}

impl Simulation {
    /// Of a model of one piece.
    pub fn new(simulation: fdcc::Simulation, model: fdcc::Model) -> Self {
        let found = Arc::new(Found::One(Box::new(simulation)));
        Simulation { found, phase: None, model }
    }

    /// Of all phases.
    pub fn of_phases(simulated: SimulationOfPhases, model: fdcc::Model) -> Self {
        Simulation { found: Arc::new(Found::Phases(simulated)), phase: None, model }
    }

    /// What has signals: nothing of several phases together.
    fn own(&self) -> Option<&fdcc::Simulation> {
        of(&self.found, self.phase)
    }
}

fn of(found: &Found, phase: Option<usize>) -> Option<&fdcc::Simulation> {
    match found {
        Found::One(simulation) => Some(simulation),
        Found::Phases(all) => phase.map(|at| &all.all[at]),
    }
}

#[pymethods]
impl Simulation {
    /// When states are reported.
    fn time(&self) -> Option<Column> {
        let phase = self.phase;
        Column::lent(&self.found, |it| Some(of(it, phase)?.time()))
    }

    /// All states that are shown, at these times.
    fn states(&self) -> Vec<(&str, Column)> {
        let Some(own) = self.own() else { return Vec::new() };
        let shown = own.system.states.iter().filter(|state| !state.hidden);
        let phase = self.phase;
        let column = |name: &str| Column::lent(&self.found, |it| of(it, phase)?.state(name));
        shown.filter_map(|it| Some((it.name.as_str(), column(&it.name)?))).collect()
    }

    /// The names of its phases, each with what it does.
    fn phases(&self) -> Vec<(&str, Simulation)> {
        let (Found::Phases(all), None) = (&*self.found, self.phase) else { return Vec::new() };
        let one = |at| Simulation {
            found: self.found.clone(),
            phase: Some(at),
            model: self.model.clone(),
        };
        all.models.iter().enumerate().map(|(at, it)| (it.name(), one(at))).collect()
    }

    /// The document of `fdcc simulate --json`, of all phases.
    fn json(&self) -> String {
        match &*self.found {
            Found::One(simulation) => fdcc_cli::simulation(simulation, &self.model),
            Found::Phases(all) => fdcc_cli::simulation_of_phases(all, &self.model),
        }
    }
}
