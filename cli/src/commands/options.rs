//! Options that all commands share which compute something.

use super::Exit;
use crate::log::Level;
use crate::model::Loaded;
use crate::{output, render};
use clap::Args;
use fdcc_compiler::Model;
use fdcc_grammar::{Diagnostic, Severity, SourceFile};
use fdcc_runtime::problem::Problem;
use std::path::PathBuf;

/// What may be changed without touching the model.
#[derive(Args, Clone)]
pub struct Options {
    /// Another value of a `param`, such as `w=1` or `m=200[g]` (repeatable)
    #[arg(long = "set", value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// Another value of a key of the `method` block, such as `N=500` (repeatable)
    #[arg(long = "method", value_name = "KEY=VALUE")]
    pub method: Vec<String>,
    /// Print the result as one JSON document
    #[arg(long)]
    pub json: bool,
    /// Write MODEL.sol.json, MODEL.csv and MODEL.html to this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Start from an earlier .sol.json, of any grid, scheme or sigma
    #[arg(long, value_name = "FILE")]
    pub warm: Option<PathBuf>,
    /// Iteration table on the standard error
    #[arg(long, value_enum, default_value_t = Level::Short)]
    pub log: Level,
    /// Stop after this many seconds with the best iterate
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub time_limit: Option<f64>,
    /// Seed of everything random
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Solve from this many starting points and keep the best solution
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub starts: u32,
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 => Ok(value),
        _ => Err("a positive number of seconds".into()),
    }
}

/// A model that is ready to be computed with, and its text.
pub struct Prepared {
    pub source: SourceFile,
    pub model: Model,
}

/// Reads and checks a model and applies the changes. What is wrong with it is shown on the standard error.
pub fn prepare(file: &str, options: &Options) -> Result<Prepared, Exit> {
    let loaded = Loaded::read(file).map_err(|error| {
        output::complain(&format!("{file} cannot be read: {error}"));
        Exit::File
    })?;
    let worth_showing = |it: &&Diagnostic| it.severity >= Severity::Warning;
    show(loaded.diagnostics.iter().filter(worth_showing), &loaded.source);
    let is_waiting = |it: &Diagnostic| it.code == fdcc_grammar::Code::NoValue;
    let broken = loaded.diagnostics.iter().any(|it| it.severity == Severity::Error && !is_waiting(it));
    match loaded.model {
        Some(model) if !broken => {
            let model = change(model, &options.set, &options.method)?;
            let model = match options.seed {
                Some(seed) => change(model, &[], &[format!("seed={seed}")])?,
                None => model,
            };
            Ok(Prepared { source: loaded.source, model })
        }
        _ => Err(Exit::ModelError),
    }
}

/// Applies `NAME=VALUE` and `KEY=VALUE`.
pub fn change(mut model: Model, set: &[String], method: &[String]) -> Result<Model, Exit> {
    let result = set.iter().try_for_each(|text| {
        let (name, value) = split(text, "--set NAME=VALUE")?;
        model.set_param(name, value)
    });
    let result = result.and_then(|()| {
        method.iter().try_for_each(|text| {
            let (key, value) = split(text, "--method KEY=VALUE")?;
            model.set_method(key, value)
        })
    });
    match result {
        Ok(()) => Ok(model),
        Err(message) => {
            output::complain(&message);
            Err(Exit::Usage)
        }
    }
}

fn split<'t>(text: &'t str, form: &str) -> Result<(&'t str, &'t str), String> {
    let (name, value) = text.split_once('=').ok_or(format!("`{text}` is not of the form {form}"))?;
    Ok((name.trim(), value.trim()))
}

/// Compiles; what cannot be treated is shown on the standard error.
pub fn compile(prepared: &Prepared) -> Result<Problem, Exit> {
    fdcc_compiler::compile(&prepared.model).map_err(|diagnostics| {
        show(diagnostics.iter(), &prepared.source);
        Exit::ModelError
    })
}

/// Prints diagnostics on the standard error.
pub fn show<'d>(diagnostics: impl Iterator<Item = &'d Diagnostic>, source: &SourceFile) {
    let renderer = render::Renderer::for_stderr();
    diagnostics.for_each(|diagnostic| eprint!("{}", renderer.render(diagnostic, source)));
}
