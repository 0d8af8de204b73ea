//! `fdcc mpc`: a model as the controller of a true system, in closed loop.

use super::options::{Changes, read};
use super::solver::wrote;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output::closed_loop::{ClosedLoopDocument, ClosedLoopStep};
use crate::output::picture::all_bounds;
use crate::output::units::Units;
use crate::output::{self, files};
use crate::page;
use crate::watch::{Deadline, catch_interrupts, is_interrupted};
use clap::Args;
use fdcc::language::NamedUnit;
use fdcc::{Accuracy, ClosedLoop, Error, Model, Options};
use std::path::PathBuf;
use std::time::Instant;

/// Control a true system by a model, in closed loop
///
/// In each step the model is solved from the state of the true system, and the first value of each
/// control is held for the first interval of its grid. The smoothed problem of the model is solved,
/// from the solution before; the plant has true friction.
#[derive(Args)]
pub struct Mpc {
    /// The model that controls; `-` is the standard input
    #[arg(value_name = "FILE")]
    file: String,
    /// The model of the true system, with states and controls of the same names; the same model if
    /// left out
    #[arg(long, value_name = "FILE")]
    plant: Option<String>,
    /// How many steps
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    steps: u32,
    /// End each solve after so many microseconds with its best iterate
    #[arg(long, value_name = "US", value_parser = clap::value_parser!(u32).range(1..))]
    budget: Option<u32>,
    #[command(flatten)]
    changes: Changes,
    /// Print the result as one JSON document, and nothing else, on the standard output
    #[arg(long)]
    json: bool,
    /// Write MODEL.mpc.json, MODEL.mpc.csv and MODEL.mpc.html to this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Mpc {
    /// Runs the loop and reports.
    pub fn run(self) -> Exit {
        catch_interrupts();
        let model = match read(&self.file, &self.changes) {
            Ok(model) => model,
            Err(exit) => return exit,
        };
        let plant = match &self.plant {
            Some(file) => read(file, &self.changes.of_data()),
            None => Ok(model.clone()),
        };
        let plant = match plant {
            Ok(plant) => plant,
            Err(exit) => return exit,
        };
        match self.close(&model, &plant) {
            Ok(document) => self.report(&document, &model),
            Err(failure) => failure.report(model.source()),
        }
    }

    /// The loop.
    fn close(&self, model: &Model, plant: &Model) -> Result<ClosedLoopDocument, Failure> {
        measure_alike(model, plant)?;
        let problem = model.problem()?;
        let controller = model.controller(problem.method.intervals())?;
        let mut document = ClosedLoopDocument::new(&controller, plant.name(), all_bounds(&problem));
        let mut closed = ClosedLoop::new(controller, plant.plant()?)?;
        for _ in 0..self.steps {
            if is_interrupted() {
                document.end("interrupted");
                break;
            }
            document.add(self.solve(&mut closed)?);
            if !closed.apply(&Accuracy::default())? {
                document.end("the simulation of the plant ends early");
                break;
            }
        }
        document.close(closed.time(), closed.state());
        Ok(document)
    }

    /// One solve, within its time.
    fn solve(&self, closed: &mut ClosedLoop) -> Result<ClosedLoopStep, Failure> {
        let (time, state) = (closed.time(), closed.state().to_vec());
        let begin = Instant::now();
        let seconds = self.budget.map(|budget| f64::from(budget) * 1e-6);
        let deadline = Deadline::after(begin, seconds);
        let options = Options { stop: &|| deadline.check(), ..Options::default() };
        let found = closed.solve(&options)?;
        Ok(ClosedLoopStep {
            time,
            state,
            controls: found.first_controls().0,
            status: found.status_name(),
            is_solved: found.is_solved(),
            iterations: found.outcome.solution.counts.iterations,
            seconds: begin.elapsed().as_secs_f64(),
        })
    }

    fn report(&self, document: &ClosedLoopDocument, model: &Model) -> Exit {
        let written = match &self.out {
            Some(folder) => {
                let json = output::json(document);
                let page = page::of(&json);
                let all = [("mpc.json", json), ("mpc.csv", document.csv()), ("mpc.html", page)];
                files::write_all(folder, &document.model, &all)
            }
            None => Ok(Vec::new()),
        };
        output::print(&match self.json {
            true => output::json(document),
            false => document.words(&Units::from(model)),
        });
        let exit = if document.is_fine() { Exit::Fine } else { Exit::NotSolved };
        wrote(written, self.json, exit, model.source())
    }
}

/// A value goes from one to the other as a number: what has the same name has to measure the same,
/// as far as both say what they measure.
fn measure_alike(model: &Model, plant: &Model) -> Result<(), Error> {
    let meaning = model.meaning();
    let states = meaning.states.iter().map(|it| &it.place.name);
    let names: Vec<&String> =
        states.chain(meaning.controls.iter().map(|it| &it.place.name)).collect();
    for own in model.units().iter().filter(|it| names.contains(&&it.name)) {
        let other = plant.units().iter().find(|it| it.name == own.name);
        if let Some(other) = other.filter(|it| it.dimension != own.dimension) {
            let shown = |unit: &NamedUnit| match unit.unit.as_str() {
                "" => "a plain number".to_owned(),
                unit => format!("[{unit}]"),
            };
            return Err(Error::Call(format!(
                "`{}` is {} in `{}`, and {} in the plant `{}`; a closed loop hands it over as it \
                 is, so both have to measure the same",
                own.name,
                shown(own),
                model.name(),
                shown(other),
                plant.name()
            )));
        }
    }
    Ok(())
}
