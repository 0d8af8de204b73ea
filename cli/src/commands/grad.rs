//! `fdcc grad`: the exact gradient of the true system, and what others would have computed instead.

use super::driven::Driven;
use super::options::{show, usage};
use super::solver::wrote;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output::gradient::GradientDocument;
use crate::output::{self, files};
use crate::page;
use clap::Args;
use fdcc::{Accuracy, By, Controls, Gradient, Model, NotBy, by_names};
use fdcc_grammar::{Severity, SourceFile};
use fdcc_runtime::simulate::System;
use std::path::PathBuf;

/// The exact gradient through all events, and whether it can be trusted
#[derive(Args)]
pub struct Grad {
    #[command(flatten)]
    driven: Driven,
    /// What to differentiate: an expression with a value at the end, such as `x(end)`; the
    /// objective if left out
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    of: Option<String>,
    /// By what: params, free unknowns, starts such as `x(start)`, controls; all params and unknowns
    /// if left out
    #[arg(long, value_name = "A,B,...", value_delimiter = ',')]
    wrt: Vec<String>,
    /// The second derivatives, too
    #[arg(long)]
    second: bool,
    /// Print the result as one JSON document, and nothing else, on the standard output
    #[arg(long)]
    json: bool,
    /// Write MODEL.grad.json and MODEL.grad.html to this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// By more numbers than this a matrix of second derivatives is nothing to look at.
const MOST_SECOND: usize = 64;

impl Grad {
    /// Differentiates and reports.
    pub fn run(self) -> Exit {
        let model = match self.driven.read().and_then(|model| self.asked(model)) {
            Ok(model) => model,
            Err(exit) => return exit,
        };
        match self.gradient(&model) {
            Ok(document) => self.report(&document, &model),
            Err(failure) => failure.report(model.source()),
        }
    }

    /// The model with the objective that `--of` asks for. What is wrong with that is shown under
    /// its own name.
    fn asked(&self, model: Model) -> Result<Model, Exit> {
        let Some(of) = &self.of else { return Ok(model) };
        if of.trim().is_empty() {
            return Err(usage("`--of` needs an expression, such as `x(end)`"));
        }
        let checked = model.with_objective(of);
        let source = SourceFile::new("--of", of.as_str());
        show(checked.diagnostics.iter().filter(|it| it.severity >= Severity::Warning), &source);
        checked.model.ok_or(Exit::Usage)
    }

    fn gradient(&self, model: &Model) -> Result<GradientDocument, Failure> {
        let (model, driver) = self.driven.adapt(model)?;
        let system = self.driven.compiled(&model, Model::sensitivity_system)?;
        if model.meaning().objective.is_none() {
            return Err(Failure::Usage(
                "the model has no objective; `--of EXPR` says what to differentiate".into(),
            ));
        }
        let controls = self.driven.controls(driver, &system)?;
        let by = self.by(&system, &controls, &model)?;
        let has_second = self.second(&by)?;
        let accuracy = Accuracy { points_between: true, ..self.driven.options(&model) };
        let gradient = Gradient::new(&model, system, controls, by, &accuracy);
        let of = self.of.as_deref().unwrap_or("objective");
        let document = GradientDocument::new(of, &gradient, has_second, &model);
        let document = document.with_trajectory(&gradient, model.source());
        Ok(document.in_units((&model).into()))
    }

    /// Whether second derivatives are wanted; not by thousands of rows of controls.
    fn second(&self, by: &[By]) -> Result<bool, Failure> {
        let count: usize = by.iter().map(|by| by.quantities.len()).sum();
        match self.second && count > MOST_SECOND {
            true => Err(Failure::Usage(format!(
                "--second: by {MOST_SECOND} numbers at most, not by {count}"
            ))),
            false => Ok(self.second),
        }
    }

    fn by(&self, system: &System, controls: &Controls, model: &Model) -> Result<Vec<By>, Failure> {
        let names: Vec<&str> = self.wrt.iter().map(|name| name.trim()).collect();
        let wrong = |why: NotBy| match names.is_empty() {
            true => Failure::Usage(with_option(&why)),
            false => Failure::Usage(format!("--wrt: {}", with_option(&why))),
        };
        by_names(&names, system, controls, model).map_err(wrong)
    }

    fn report(&self, document: &GradientDocument, model: &Model) -> Exit {
        let exit = if document.trusted { Exit::Fine } else { Exit::NotSolved };
        let written = match &self.out {
            Some(folder) => {
                let json = output::json(document);
                let page = page::of(&json);
                let all = [("grad.json", json), ("grad.html", page)];
                files::write_all(folder, &document.model, &all)
            }
            None => Ok(Vec::new()),
        };
        output::print(&if self.json { output::json(document) } else { document.words() });
        wrote(written, self.json, exit, model.source())
    }
}

/// Why there is no derivative by a name, and the option that helps.
fn with_option(why: &NotBy) -> String {
    match why {
        NotBy::Nothing => format!("{why}; `--wrt x(start)` names the start of `x`"),
        NotBy::Computed(name, value) => {
            format!("{why}; `--set {name}={value}` makes it one of its own")
        }
        NotBy::Guessed(_) => {
            format!("{why}; `--control FILE` gives it values to differentiate by")
        }
        NotBy::Unknown(_) => why.to_string(),
    }
}
