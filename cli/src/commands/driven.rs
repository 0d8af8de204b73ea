//! A model and the controls that drive it: what `simulate` and `grad` begin with.

use super::Exit;
use super::accuracy::Accuracy;
use super::options::{Changes, Prepared, read_at_any_rate, seconds};
use crate::log::Level;
use crate::output;
use crate::output::control;
use crate::replay::Replay;
use crate::solver::Failure;
use crate::watch::{Deadline, catch_interrupts};
use clap::Args;
use fdcc_runtime::simulate::{Controls, Options, System, Watch};
use std::path::PathBuf;
use std::time::Instant;

/// A model file and where its controls come from.
#[derive(Args)]
pub struct Driven {
    /// The model; `-` is the standard input
    #[arg(value_name = "FILE")]
    file: String,
    #[command(flatten)]
    changes: Changes,
    /// Controls: a .csv with the columns `t` and the controls, or the .sol.json of a solve; the guess if left out
    #[arg(long, value_name = "FILE")]
    control: Option<PathBuf>,
    /// Take the unknowns, parameters and open starts of an earlier .sol.json, but not its controls
    #[arg(long, value_name = "FILE")]
    warm: Option<PathBuf>,
    #[command(flatten)]
    accuracy: Accuracy,
    /// Stop after this many seconds and keep the trajectory so far
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    time_limit: Option<f64>,
    /// Shared with the commands that search; here there is nothing to vary
    #[arg(long, value_name = "N", hide = true)]
    seed: Option<u64>,
    /// Shared with the commands that search; here there is one start
    #[arg(long, value_name = "K", hide = true)]
    starts: Option<u32>,
    /// How much to tell on the standard error: with `none` nothing but what is wrong
    #[arg(long, value_enum)]
    log: Option<Level>,
}

impl Driven {
    /// Reads and checks the model, without any changes.
    pub fn read(&self) -> Result<Prepared, Exit> {
        let is_search = self.seed.is_some() || self.starts.is_some_and(|starts| starts > 1);
        if is_search && self.log != Some(Level::None) {
            output::complain("`--seed` and `--starts` change nothing here: a simulation searches nothing");
        }
        read_at_any_rate(&self.file, &Changes::default())
    }

    /// How exactly to simulate, and until when; Ctrl-C stops it.
    pub fn options(&self) -> Options {
        catch_interrupts();
        let deadline = Deadline::after(Instant::now(), self.time_limit);
        Options { watch: Watch::new(move || deadline.check()), ..self.accuracy.options() }
    }

    /// Changes the model: what its solution says comes first, so that the command line has the last word.
    pub fn adapt(&self, prepared: &mut Prepared) -> Result<Replay, Failure> {
        let replay = match &self.control {
            Some(path) => control::read(path, &prepared.model)?,
            None => Replay::default(),
        };
        if replay.is_of_another(&prepared.source.text) && self.log != Some(Level::None) {
            let name = &prepared.source.name;
            output::complain(&format!(
                "{name} is not the text that was solved; the controls are taken all the same"
            ));
        }
        if let Some(path) = &self.warm {
            control::read(path, &prepared.model)?.adapt(&mut prepared.model);
        }
        replay.adapt(&mut prepared.model);
        self.changes.apply(&mut prepared.model).map_err(Failure::Usage)?;
        Ok(replay)
    }

    /// The controls for a system. What is odd about them is said on the standard error.
    pub fn controls(&self, replay: Replay, system: &System) -> Result<Controls, Failure> {
        let [first, last] = system.interval;
        let wrong = match (first.is_finite() && last.is_finite(), first <= last) {
            (false, _) => Some("both must be numbers"),
            (true, false) => Some("it must not run backwards"),
            (true, true) => None,
        };
        if let Some(wrong) = wrong {
            return Err(Failure::Usage(format!("time runs from {first} to {last}; {wrong}")));
        }
        let doubt = replay.doubts(system.interval).filter(|_| self.log != Some(Level::None));
        if let (Some(doubt), Some(path)) = (doubt, &self.control) {
            output::complain(&format!("{}: {doubt}", path.display()));
        }
        Ok(replay.held().unwrap_or(Controls::Guess))
    }
}
