//! The JSON document of a simulation, its table, and its words for people.

use super::ending::{Ending, EventEntry, OrderEntry, events, orders, state};
use super::named::Named;
use super::plots::{Drawn, drawn};
use super::units::{Shown, Units};
use crate::command;
use crate::version::VERSION;
use fdcc::{Model, Simulation};
use fdcc_grammar::SourceFile;
use serde::Serialize;
use std::fmt::Write;

/// One simulation. Numbers are written so that they read back to the same bits.
#[derive(Serialize)]
pub struct SimulationDocument {
    fdcc: String,
    pub model: String,
    /// The arguments that it was run with; absent where there is no command line.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    command: Vec<String>,
    #[serde(flatten)]
    run: RunEntry,
    #[serde(skip_serializing_if = "Units::is_empty")]
    units: Units,
    #[serde(skip_serializing_if = "Named::is_empty")]
    display_units: Named<Shown>,
    #[serde(skip_serializing_if = "Named::is_empty")]
    plots: Named<Drawn>,
    source: String,
}

/// What a system did, of one piece or in a phase.
#[derive(Clone, Serialize)]
pub struct RunEntry {
    #[serde(flatten)]
    pub ending: Ending,
    time: Vec<f64>,
    states: Named<Vec<f64>>,
    pub events: Vec<EventEntry>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    orders: Vec<OrderEntry>,
    /// `time`, then the states.
    end: Named<f64>,
    integrals: Named<f64>,
    objective: Option<f64>,
    pub counts: Counts,
}

/// The work that was done.
#[derive(Clone, Copy, Default, Serialize)]
pub struct Counts {
    pub steps: usize,
    rejected: usize,
    stiff: usize,
    evaluations: usize,
}

impl Counts {
    /// That of both.
    pub fn and(self, other: Counts) -> Counts {
        Counts {
            steps: self.steps + other.steps,
            rejected: self.rejected + other.rejected,
            stiff: self.stiff + other.stiff,
            evaluations: self.evaluations + other.evaluations,
        }
    }
}

impl SimulationDocument {
    pub fn new(simulated: &Simulation, model: &Model) -> Self {
        SimulationDocument {
            fdcc: VERSION.to_string(),
            model: simulated.system.name.clone(),
            command: command::given(),
            run: RunEntry::new(simulated, model.source()),
            display_units: Units::from(model).shown(),
            plots: drawn(simulated.plots(model)),
            units: model.into(),
            source: model.source().text.to_string(),
        }
    }

    /// The text of `MODEL.sim.csv`.
    pub fn csv(&self) -> String {
        self.run.csv()
    }

    /// The events, the end, and a verdict.
    pub fn words(&self) -> String {
        self.run.words(&self.units)
    }
}

impl RunEntry {
    pub fn new(simulated: &Simulation, source: &SourceFile) -> Self {
        let Simulation { system, result: simulation } = simulated;
        let ends = simulation.end.iter().zip(&system.states);
        let integrals = ends.filter(|(_, state)| state.hidden);
        let columns =
            simulation.states.iter().zip(&system.states).filter(|(_, state)| !state.hidden);
        let mut end = vec![("time".to_string(), simulation.end_time)];
        end.extend(state(system, &simulation.end).0);
        let counts = simulation.counts;
        RunEntry {
            ending: Ending::new(system, simulation, source),
            time: simulation.time.clone(),
            states: columns.map(|(column, state)| (state.name.clone(), column.clone())).collect(),
            events: events(system, simulation),
            orders: orders(system, simulation),
            end: Named(end),
            integrals: integrals.map(|(value, state)| (state.name.clone(), *value)).collect(),
            objective: simulation.objective,
            counts: Counts {
                steps: counts.steps,
                rejected: counts.rejected,
                stiff: counts.stiff,
                evaluations: counts.evaluations,
            },
        }
    }

    /// A column for the time and for each state.
    pub fn csv(&self) -> String {
        let names: Vec<&str> = self.states.0.iter().map(|(name, _)| name.as_str()).collect();
        let mut text = format!("{}\n", [&["t"], names.as_slice()].concat().join(","));
        for (k, t) in self.time.iter().enumerate() {
            let row = self.states.0.iter().map(|(_, column)| column[k].to_string());
            let row: Vec<String> = std::iter::once(t.to_string()).chain(row).collect();
            text += &format!("{}\n", row.join(","));
        }
        text
    }

    /// The events, the end, and a verdict.
    pub fn words(&self, units: &Units) -> String {
        let mut text = String::new();
        for event in &self.events {
            let time = units.value("time", event.time, 12);
            let (surface, what) = (&event.surface, event.what());
            let state = units.pairs(&event.state, 12);
            writeln!(text, " {time:>16}  {surface:<10} {what:<16} {state}")
                .expect("a string takes everything");
        }
        for order in &self.orders {
            writeln!(text, " note: {}", order.words(units)).expect("a string takes everything");
        }
        let integrals = units.pairs(&self.integrals, 12);
        let value = |value: f64| units.value("objective", value, 12);
        let objective = self.objective.map(|it| format!("objective {}  ", value(it)));
        let events = super::plural(self.events.len(), "event");
        let completed = format!("completed: {events}, {} steps", self.counts.steps);
        let last = self.ending.why(units).unwrap_or(completed);
        text += &format!(" {last}\n end: {}\n", units.pairs(&self.end, 12));
        if !integrals.is_empty() || objective.is_some() {
            text += &format!(" {}{integrals}\n", objective.unwrap_or_default());
        }
        text
    }
}
