//! `fdcc simulate`: the true system, integrated from event to event.

use super::driven::Driven;
use super::options::usage;
use super::solver::wrote;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output::simulation::SimulationDocument;
use crate::output::{self, files};
use crate::page;
use clap::Args;
use fdcc::{Accuracy, Model, Simulation};
use std::path::PathBuf;

/// Simulate the true system, with every event located
#[derive(Args)]
pub struct Simulate {
    #[command(flatten)]
    driven: Driven,
    /// Report the states at these times, in the unit of time, instead of at all steps
    #[arg(long, value_name = "T1,T2,...", value_delimiter = ',', allow_hyphen_values = true)]
    times: Vec<f64>,
    /// Print the result as one JSON document, and nothing else, on the standard output
    #[arg(long)]
    json: bool,
    /// Write MODEL.sim.json, MODEL.sim.csv and MODEL.sim.html to this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Simulate {
    /// Simulates and reports.
    pub fn run(self) -> Exit {
        if self.times.iter().any(|time| !time.is_finite()) || !self.times.is_sorted() {
            return usage("`--times` needs numbers in ascending order");
        }
        let model = match self.driven.read() {
            Ok(model) => model,
            Err(exit) => return exit,
        };
        match self.simulate(&model) {
            Ok((document, exit)) => self.report(&document, exit, &model),
            Err(failure) => failure.report(model.source()),
        }
    }

    fn simulate(&self, model: &Model) -> Result<(SimulationDocument, Exit), Failure> {
        let (model, driver) = self.driven.adapt(model)?;
        let system = self.driven.compiled(&model, Model::system)?;
        let controls = self.driven.controls(driver, &system)?;
        let [first, last] = system.interval;
        let unit = model.meaning().time_size();
        let times = self.times.iter().map(|time| time * unit).collect();
        let options = Accuracy { times, ..self.driven.options(&model) };
        let mut times = self.times.iter().zip(&options.times);
        if let Some((outside, _)) = times.find(|(_, time)| **time < first || **time > last) {
            let [first, last] = [first, last].map(|time| time / unit);
            return Err(Failure::Usage(format!(
                "`--times`: {outside} is not between {first} and {last}"
            )));
        }
        let simulation = Simulation::new(&model, system, &controls, &options);
        let exit = if simulation.is_complete() { Exit::Fine } else { Exit::NotSolved };
        Ok((SimulationDocument::new(&simulation, &model), exit))
    }

    fn report(&self, document: &SimulationDocument, exit: Exit, model: &Model) -> Exit {
        let written = match &self.out {
            Some(folder) => {
                let json = output::json(document);
                let page = page::of(&json);
                let all = [("sim.json", json), ("sim.csv", document.csv()), ("sim.html", page)];
                files::write_all(folder, &document.model, &all)
            }
            None => Ok(Vec::new()),
        };
        if self.json {
            output::print(&output::json(document));
        } else {
            output::print(&document.words());
        }
        wrote(written, self.json, exit, model.source())
    }
}
