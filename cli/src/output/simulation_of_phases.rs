//! The JSON document of a simulation of phases, its tables, and its words for people.

use super::ending::Ending;
use super::named::Named;
use super::plots::{Drawn, drawn};
use super::simulation::{Counts, RunEntry};
use super::units::{Shown, Units};
use crate::command;
use crate::version::VERSION;
use fdcc::{Model, Simulation, SimulationOfPhases};
use serde::Serialize;

/// One simulation, phase by phase.
#[derive(Serialize)]
pub struct PhasesDocument {
    fdcc: String,
    pub model: String,
    /// The arguments that it was run with; absent where there is no command line.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    command: Vec<String>,
    /// How the last phase ended that was simulated.
    #[serde(flatten)]
    ending: Ending,
    phases: Named<PhaseEntry>,
    objective: Option<f64>,
    counts: Counts,
    #[serde(skip_serializing_if = "Units::is_empty")]
    units: Units,
    #[serde(skip_serializing_if = "Named::is_empty")]
    display_units: Named<Shown>,
    source: String,
    /// Those of each phase.
    #[serde(skip)]
    units_of_phases: Vec<Units>,
}

/// What a phase did, and the pictures that the model asks for in it.
#[derive(Serialize)]
struct PhaseEntry {
    #[serde(flatten)]
    run: RunEntry,
    #[serde(skip_serializing_if = "Named::is_empty")]
    plots: Named<Drawn>,
}

impl PhasesDocument {
    pub fn new(simulated: &SimulationOfPhases, model: &Model) -> Self {
        let of_phases = simulated.all.iter().zip(&simulated.models);
        let entry = |(run, own): (&Simulation, &Model)| PhaseEntry {
            run: RunEntry::new(run, model.source()),
            plots: drawn(run.plots(own)),
        };
        let runs: Vec<PhaseEntry> = of_phases.map(entry).collect();
        let names = simulated.models.iter().map(|it| it.name().to_owned());
        let last = runs.last().expect("a model with phases has one");
        PhasesDocument {
            fdcc: VERSION.to_string(),
            model: model.name().to_owned(),
            command: command::given(),
            ending: last.run.ending.clone(),
            counts: runs.iter().map(|it| it.run.counts).fold(Counts::default(), Counts::and),
            objective: simulated.objective,
            display_units: Units::from(model).shown(),
            units: model.into(),
            units_of_phases: simulated.models.iter().map(Units::from).collect(),
            source: model.source().text.to_string(),
            phases: names.zip(runs).collect(),
        }
    }

    /// The name and the text of `MODEL.PHASE.sim.csv`, for each phase.
    pub fn csv(&self) -> impl Iterator<Item = (String, String)> {
        self.phases.0.iter().map(|(name, it)| (format!("{name}.sim.csv"), it.run.csv()))
    }

    /// Phase by phase, and the objective of all.
    pub fn words(&self) -> String {
        let phases = self.phases.0.iter().zip(&self.units_of_phases);
        let phases = phases.map(|((name, it), units)| format!(" {name}\n{}", it.run.words(units)));
        let value = |value: f64| self.units.value("objective", value, 12);
        let objective = self.objective.map(|it| format!(" objective {}\n", value(it)));
        phases.chain(objective).collect()
    }
}
