//! `fdcc mpc`: a model as the controller of a true system, in closed loop.

use super::options::{Changes, read};
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output;
use crate::output::closed_loop::{ClosedLoopDocument, ClosedLoopStep};
use crate::output::units::Units;
use crate::watch::{Deadline, catch_interrupts, is_interrupted};
use clap::Args;
use fdcc::{Accuracy, Controller, Error, Model, Options, Plant};
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
        let mut controller = model.controller(model.problem()?.method.intervals())?;
        let mut document = ClosedLoopDocument::new(&controller, plant.name());
        let mut plant = plant.plant()?;
        for _ in 0..self.steps {
            if is_interrupted() {
                document.end("interrupted");
                break;
            }
            let state = measured(&controller, &plant)?;
            let (step, duration) = self.step(&mut controller, &plant, &state)?;
            let controls: Vec<(&str, f64)> =
                controller.controls().zip(step.controls.iter().copied()).collect();
            let arrives = plant.step(&controls, duration, &Accuracy::default())?;
            document.add(step);
            if !arrives {
                document.end("the simulation of the plant ends early");
                break;
            }
        }
        document.close(plant.time(), &measured(&controller, &plant)?);
        Ok(document)
    }

    /// One solve, and for how long its controls are meant.
    fn step(
        &self,
        controller: &mut Controller,
        plant: &Plant,
        state: &[f64],
    ) -> Result<(ClosedLoopStep, f64), Failure> {
        let begin = Instant::now();
        let seconds = self.budget.map(|budget| f64::from(budget) * 1e-6);
        let deadline = Deadline::after(begin, seconds);
        let options = Options { stop: &|| deadline.check(), ..Options::default() };
        let found = controller.step(state, &options)?;
        let first = |column: &Vec<f64>| column.first().copied().unwrap_or(f64::NAN);
        let step = ClosedLoopStep {
            time: plant.time(),
            state: state.to_vec(),
            controls: found.outcome.trajectory.controls.iter().map(first).collect(),
            status: found.status_name(),
            is_solved: found.is_solved(),
            iterations: found.outcome.solution.counts.iterations,
            seconds: begin.elapsed().as_secs_f64(),
        };
        Ok((step, found.time()[1] - found.time()[0]))
    }

    fn report(&self, document: &ClosedLoopDocument, model: &Model) -> Exit {
        output::print(&match self.json {
            true => output::json(document),
            false => document.words(&Units::from(model.meaning())),
        });
        if document.is_fine() { Exit::Fine } else { Exit::NotSolved }
    }
}

/// The states of the plant that the controller knows.
fn measured(controller: &Controller, plant: &Plant) -> Result<Vec<f64>, Failure> {
    let value = |name: &str| {
        let missing = || Error::Call(format!("the plant has no state `{name}`"));
        plant.state(name).ok_or_else(missing)
    };
    Ok(controller.states().map(value).collect::<Result<_, _>>()?)
}
