//! Options that all commands share which compute something.

use super::solver::stopped;
use crate::drawing::render;
use crate::exit::Exit;
use crate::model;
use crate::output;
use crate::report::log::Level;
use crate::watch::Deadline;
use clap::Args;
use fdcc::{Checked, Model};
use fdcc_grammar::{Diagnostic, Severity, SourceFile};
use fdcc_runtime::problem::Method;
use std::path::PathBuf;
use std::time::Instant;

/// What may be changed without touching the model.
#[derive(Args, Clone, Debug, Default)]
pub struct Changes {
    /// Give a `param` another value, such as `w=1` or `m=200[g]` (repeatable)
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Give a key of the `method` block another value, such as `N=500` (repeatable)
    #[arg(long, value_name = "KEY=VALUE")]
    method: Vec<String>,
    /// Look for data files in this folder instead of that of the model
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
}

impl Changes {
    /// Only where data files are.
    pub fn of_data(&self) -> Changes {
        Changes { data: self.data.clone(), ..Changes::default() }
    }

    /// Applies them, or says what is wrong with one.
    pub fn apply(&self, model: &Model) -> Result<Model, String> {
        self.applied(model, |_| false)
    }

    /// The same where nothing is searched: an unknown is given its value like a parameter.
    pub fn apply_to_run(&self, model: &Model) -> Result<Model, String> {
        self.applied(model, |name| model.has_unknown(name))
    }

    fn applied(&self, model: &Model, is_unknown: impl Fn(&str) -> bool) -> Result<Model, String> {
        model.changed(|meaning| {
            for text in &self.set {
                let (name, value) = split(text, "--set NAME=VALUE")?;
                match is_unknown(name) {
                    true => meaning.set_unknown(name, value)?,
                    false => meaning.set_param(name, value)?,
                }
            }
            for text in &self.method {
                let (key, value) = split(text, "--method KEY=VALUE")?;
                meaning.set_method(key, value)?;
            }
            meaning.fits_together()
        })
    }
}

fn split<'t>(text: &'t str, form: &str) -> Result<(&'t str, &'t str), String> {
    let (name, value) =
        text.split_once('=').ok_or(format!("`{text}` is not of the form {form}"))?;
    Ok((name.trim(), value.trim()))
}

/// The difference that is called confirmation where nobody names one.
pub const USUAL_GAP: f64 = 1e-3;

/// When a replay confirms a solution.
#[derive(Args, Clone)]
pub struct Gap {
    /// The largest difference between solution and true system that is called confirmation: of a
    /// state for how far it moves, of a condition for the size of its terms; without it the
    /// `accuracy` of the method, or 0.001
    #[arg(allow_negative_numbers = true)]
    #[arg(long, value_name = "G", value_parser = difference)]
    gap: Option<f64>,
}

impl Gap {
    /// What is named, else the `accuracy` of a method, else the usual one.
    pub fn of(&self, method: &Method) -> f64 {
        self.gap.or(method.accuracy).unwrap_or(USUAL_GAP)
    }
}

fn difference(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 && value.is_finite() => Ok(value),
        _ => Err("it needs a finite number that is not negative".into()),
    }
}

/// How to solve, and what to leave behind.
#[derive(Args, Clone)]
pub struct Options {
    #[command(flatten)]
    pub changes: Changes,
    /// Print the result as one JSON document, and nothing else, on the standard output
    #[arg(long)]
    pub json: bool,
    /// Write MODEL.sol.json, MODEL.csv and MODEL.html to this folder; a sweep writes its rows and a
    /// page of them there
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Start from an earlier .sol.json; its N, scheme and sigma may be others
    #[arg(long, value_name = "FILE")]
    pub warm: Option<PathBuf>,
    /// How much to tell on the standard error while solving
    #[arg(long, value_enum)]
    pub log: Option<Level>,
    /// Stop each solve after this many seconds and keep its best iterate
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub time_limit: Option<f64>,
    /// Seed of the random variations that `--starts` makes
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Solve from K starting points, the guess and variations of it, and keep the best solution
    #[arg(value_parser = clap::value_parser!(u32).range(1..=10_000))]
    #[arg(long, value_name = "K", default_value_t = 1)]
    pub starts: u32,
}

/// A number of seconds for a time limit.
pub fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 => Ok(value),
        _ => Err("it needs a number of seconds above 0".into()),
    }
}

/// [`read`] with all the options that change the model.
pub fn prepare(file: &str, options: &Options) -> Result<Model, Exit> {
    let deadline = Deadline::after(Instant::now(), options.time_limit);
    let model = load(file, &options.changes, false, deadline)?;
    let Some(seed) = options.seed else { return Ok(model) };
    model.changed(|meaning| {
        meaning.method.seed = seed;
        Ok(())
    })
}

/// Reads and checks a model and applies the changes. What is wrong with it is shown on the standard
/// error.
pub fn read(file: &str, changes: &Changes) -> Result<Model, Exit> {
    load(file, changes, false, Deadline::NEVER)
}

/// The same, also if it has no unique trajectory: a simulation finds out where, and `show` says
/// why.
pub fn read_at_any_rate(file: &str, changes: &Changes, deadline: Deadline) -> Result<Model, Exit> {
    load(file, changes, true, deadline)
}

fn load(
    file: &str,
    changes: &Changes,
    at_any_rate: bool,
    deadline: Deadline,
) -> Result<Model, Exit> {
    let checked = model::check(file, changes.data.as_deref(), deadline)
        .map_err(|stop| stopped(file, stop))?;
    let checked = checked.map_err(|error| {
        output::complain(&format!("{file} cannot be read: {error}"));
        Exit::File
    })?;
    // A parameter that waits for a value may get it from the changes; compiling finds out.
    let told = |it: &&Diagnostic| it.severity >= Severity::Warning && !checked.waits(it);
    show(checked.diagnostics.iter().filter(told), &checked.source);
    let is_wrong = checked.is_wrong();
    let Checked { model, diagnostics, .. } = checked;
    let Some(model) = model else {
        if diagnostics.iter().all(|it| it.severity < Severity::Error) {
            output::complain(&format!(
                "{file}: there is nothing to compute; `fdcc check` says nothing else"
            ));
        }
        return Err(Exit::ModelError);
    };
    if !at_any_rate && is_wrong {
        return Err(Exit::ModelError);
    }
    changes.apply(&model).map_err(|message| usage(&message))
}

/// Complains about wrong usage.
pub fn usage(message: &str) -> Exit {
    output::complain(message);
    Exit::Usage
}

/// Prints diagnostics on the standard error.
pub fn show<'d>(diagnostics: impl Iterator<Item = &'d Diagnostic>, source: &SourceFile) {
    let renderer = render::Renderer::for_stderr();
    diagnostics.for_each(|diagnostic| output::tell(&renderer.render(diagnostic, source)));
}
