//! `fdcc simulate`: the true system, integrated from event to event.

use super::driven::Driven;
use super::options::usage;
use super::solver::wrote;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output::simulation::SimulationDocument;
use crate::output::simulation_of_phases::PhasesDocument;
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
    /// Report the states at these times, in the unit of time, instead of at all steps and between
    /// long ones
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
        let done = match model.phases().is_empty() {
            true => self.simulate(&model).map(|(document, exit)| (Text::of(&document), exit)),
            false => self.simulate_phases(&model),
        };
        match done {
            Ok((text, exit)) => self.report(&text, exit, &model),
            Err(failure) => failure.report(model.source()),
        }
    }

    fn simulate_phases(&self, model: &Model) -> Result<(Text, Exit), Failure> {
        if !self.times.is_empty() {
            let what = "`--times` needs a model of one piece; phases have times of their own";
            return Err(Failure::Usage(what.into()));
        }
        let (model, saved) = self.driven.in_phases(model)?;
        // The model has its values, or others.
        let record = saved.as_ref().map(|it| it.record().without_values());
        let simulated = model.simulate_phases(record.as_ref(), &self.options(&model))?;
        let exit = if simulated.is_complete() { Exit::Fine } else { Exit::NotSolved };
        Ok((Text::of_phases(&PhasesDocument::new(&simulated, &model)), exit))
    }

    fn simulate(&self, model: &Model) -> Result<(SimulationDocument, Exit), Failure> {
        let (model, driver) = self.driven.adapt(model)?;
        let system = self.driven.compiled(&model, Model::system)?;
        let controls = self.driven.controls(driver, &system)?;
        let [first, last] = system.interval;
        let unit = model.meaning().time_size();
        let times = self.times.iter().map(|time| time * unit).collect();
        let options = Accuracy { times, ..self.options(&model) };
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

    fn options(&self, model: &Model) -> Accuracy {
        Accuracy { points_between: true, ..self.driven.options(model) }
    }

    fn report(&self, text: &Text, exit: Exit, model: &Model) -> Exit {
        let written = match &self.out {
            Some(folder) => {
                let page = ("sim.html".to_owned(), page::of(&text.json));
                let json = ("sim.json".to_owned(), text.json.clone());
                let all: Vec<_> =
                    [json].into_iter().chain(text.csv.clone()).chain([page]).collect();
                let all: Vec<_> = all.iter().map(|it| (it.0.as_str(), it.1.clone())).collect();
                files::write_all(folder, &text.model, &all)
            }
            None => Ok(Vec::new()),
        };
        output::print(if self.json { &text.json } else { &text.words });
        wrote(written, self.json, exit, model.source())
    }
}

/// A simulation in all its forms.
struct Text {
    model: String,
    json: String,
    /// Endings of the names of files, with what is in them.
    csv: Vec<(String, String)>,
    words: String,
}

impl Text {
    fn of(document: &SimulationDocument) -> Self {
        Text {
            model: document.model.clone(),
            json: output::json(document),
            csv: vec![("sim.csv".into(), document.csv())],
            words: document.words(),
        }
    }

    fn of_phases(document: &PhasesDocument) -> Self {
        Text {
            model: document.model.clone(),
            json: output::json(document),
            csv: document.csv().collect(),
            words: document.words(),
        }
    }
}
