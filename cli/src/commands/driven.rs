//! A model and the controls that drive it: what `simulate` and `grad` begin with.

use super::accuracy::Accuracy;
use super::options::{Changes, read_at_any_rate, seconds};
use super::solver::sha256;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output;
use crate::output::control::{self, Driver};
use crate::output::saved::Saved;
use crate::report::log::Level;
use crate::watch::{Deadline, catch_interrupts};
use clap::Args;
use fdcc::{Error, Model};
use fdcc_runtime::simulate::{Controls, Options, System, Watch};
use std::path::PathBuf;
use std::sync::OnceLock;
use std::time::Instant;

/// A model file and where its controls come from.
#[derive(Args)]
pub struct Driven {
    /// The model; `-` is the standard input
    #[arg(value_name = "FILE")]
    file: String,
    #[command(flatten)]
    changes: Changes,
    /// Controls: a .csv with the columns `t` and the controls, or the .sol.json of a solve; the
    /// guess if left out
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
    pub fn read(&self) -> Result<Model, Exit> {
        let is_search = self.seed.is_some() || self.starts.is_some_and(|starts| starts > 1);
        if is_search && self.log != Some(Level::None) {
            output::complain(
                "`--seed` and `--starts` change nothing here: a simulation searches nothing",
            );
        }
        read_at_any_rate(&self.file, &self.changes.of_data(), self.deadline())
    }

    /// When to stop, counted from the first time that somebody asks; Ctrl-C stops at once.
    pub fn deadline(&self) -> Deadline {
        static BEGIN: OnceLock<Instant> = OnceLock::new();
        catch_interrupts();
        Deadline::after(*BEGIN.get_or_init(Instant::now), self.time_limit)
    }

    /// Compiles a model, unless that takes too long.
    pub fn compiled(
        &self,
        model: &Model,
        compile: fn(&Model) -> Result<System, Error>,
    ) -> Result<System, Failure> {
        let model = model.clone();
        let compiled = self.deadline().within(move || compile(&model));
        Ok(compiled.map_err(Failure::Stopped)??)
    }

    /// How exactly to simulate the model, and until when.
    pub fn options(&self, model: &Model) -> Options {
        let deadline = self.deadline();
        let watch = Watch::new(move || deadline.check());
        Options { watch, ..self.accuracy.options(model.meaning().time_size()) }
    }

    /// Changes the model: what its solution says comes first, so that the command line has the last
    /// word.
    pub fn adapt(&self, model: &Model) -> Result<(Model, Driver), Failure> {
        let driver = match &self.control {
            Some(path) => control::read(path, model)?,
            None => Driver::default(),
        };
        let source = model.source();
        let is_other = driver.source_sha256.as_ref().is_some_and(|it| *it != sha256(&source.text));
        if is_other && self.log != Some(Level::None) {
            output::complain(&format!(
                "{} is not the text that was solved; the controls are taken all the same",
                source.name
            ));
        }
        let warm = match &self.warm {
            Some(path) => control::read(path, model)?,
            None => Driver::default(),
        };
        let adapted = model.changed(|meaning| {
            warm.replay.adapt(meaning);
            driver.replay.adapt(meaning);
            Ok::<(), Failure>(())
        })?;
        Ok((self.changes.apply_to_run(&adapted).map_err(Failure::Usage)?, driver))
    }

    /// The model with the parameters and unknowns of the solution that drives its phases, changed;
    /// the command line has the last word.
    pub fn in_phases(&self, model: &Model) -> Result<(Model, Option<Saved>), Failure> {
        if self.warm.is_some() {
            let what = "`--warm` needs a model of one piece; `--control` takes a .sol.json, too";
            return Err(Failure::Usage(what.into()));
        }
        let is_json = |path: &PathBuf| path.extension().is_some_and(|it| it == "json");
        if self.control.as_ref().is_some_and(|path| !is_json(path)) {
            let what = "each phase has controls of its own: `--control` takes the .sol.json of a \
                        solve";
            return Err(Failure::Usage(what.into()));
        }
        let saved = self.control.as_deref().map(Saved::read).transpose()?;
        let adapted = saved.as_ref().map(|it| model.with_values_of(&it.record()));
        let adapted = adapted.unwrap_or_else(|| model.clone());
        Ok((self.changes.apply_to_run(&adapted).map_err(Failure::Usage)?, saved))
    }

    /// The controls for a system. What is odd about them is said on the standard error.
    pub fn controls(&self, driver: Driver, system: &System) -> Result<Controls, Failure> {
        if let Some(wrong) = system.wrong_times() {
            return Err(Failure::Usage(wrong));
        }
        let Driver { replay, .. } = driver;
        let doubt = replay.doubts(system.interval).filter(|_| self.log != Some(Level::None));
        if let (Some(doubt), Some(path)) = (doubt, &self.control) {
            output::complain(&format!("{}: {doubt}", path.display()));
        }
        Ok(replay.controls)
    }
}
