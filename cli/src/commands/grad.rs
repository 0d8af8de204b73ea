//! `fdcc grad`: the exact gradient of the true system, and what others would have computed instead.

use super::Exit;
use super::driven::Driven;
use super::options::{Prepared, show, usage};
use crate::gradients::Question;
use crate::output::gradient::{Document, Found};
use crate::output::{self, files};
use crate::solver::Failure;
use clap::Args;
use fdcc::exact::Exact;
use fdcc::quantities::{By, everything, named};
use fdcc_compiler::Model;
use fdcc_grammar::{Severity, SourceFile, parse};
use fdcc_runtime::simulate::{Controls, System};
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
    /// Write MODEL.grad.json to this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// By more numbers than this a matrix of second derivatives is nothing to look at.
const MOST_SECOND: usize = 64;

impl Grad {
    /// Differentiates and reports.
    pub fn run(self) -> Exit {
        let mut prepared = match self.driven.read().and_then(|prepared| self.asked(prepared)) {
            Ok(prepared) => prepared,
            Err(exit) => return exit,
        };
        match self.gradient(&mut prepared) {
            Ok(document) => self.report(&document.in_units((&prepared.model).into()), &prepared),
            Err(failure) => failure.report(&prepared.source),
        }
    }

    /// The model with the objective that `--of` asks for. What is wrong with that is shown under
    /// its own name.
    fn asked(&self, prepared: Prepared) -> Result<Prepared, Exit> {
        let Some(of) = &self.of else { return Ok(prepared) };
        if of.trim().is_empty() {
            return Err(usage("`--of` needs an expression, such as `x(end)`"));
        }
        let tree = parse(&prepared.source.text).tree;
        let checked = fdcc_compiler::check_with_objective(&tree, of);
        let source = SourceFile::new("--of", of.as_str());
        show(checked.diagnostics.iter().filter(|it| it.severity >= Severity::Warning), &source);
        let model = checked.model.ok_or(Exit::Usage)?;
        Ok(Prepared { model, ..prepared })
    }

    fn gradient(&self, prepared: &mut Prepared) -> Result<Document, Failure> {
        let replay = self.driven.adapt(prepared)?;
        let system = self.driven.compiled(&prepared.model, fdcc_compiler::compile_sensitivities)?;
        if prepared.model.objective.is_none() {
            return Err(Failure::Usage(
                "the model has no objective; `--of EXPR` says what to differentiate".into(),
            ));
        }
        let controls = self.driven.controls(replay, &system)?;
        let by = self.by(&system, &controls, &prepared.model)?;
        self.answer(&Question { model: &prepared.model, system, controls, by }, &prepared.source)
    }

    fn answer(&self, question: &Question, source: &SourceFile) -> Result<Document, Failure> {
        let Question { model, system, controls, by } = question;
        let has_second = self.second(by)?;
        let of = self.of.as_deref().unwrap_or("objective");
        let options = self.driven.options(model);
        let exact = match Exact::new(system, controls, &options, &question.quantities()) {
            Ok(exact) => exact,
            Err(simulation) => return Ok(Document::without(of, system, &simulation, source)),
        };
        let simulation = &exact.found.simulation;
        let second = has_second.then(|| question.second(simulation));
        let (smoothed, discretised) = (question.smoothed(simulation), question.discretised());
        let (exact, method) = (&exact, &model.method);
        let found = Found { of, system, by, exact, second, smoothed, discretised, method };
        Ok(Document::new(found, source))
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
        if self.wrt.is_empty() {
            let all = everything(system, model);
            let nothing =
                "there is nothing to differentiate by; `--wrt x(start)` names the start of `x`";
            return if all.is_empty() { Err(Failure::Usage(nothing.into())) } else { Ok(all) };
        }
        let mut all: Vec<By> = Vec::new();
        for name in self.wrt.iter().map(|name| name.trim()) {
            let found = named(name, system, controls, model);
            let found = found.map_err(|what| Failure::Usage(format!("--wrt: {what}")))?;
            let is_new = |by: &By| all.iter().all(|known| known.name != by.name);
            let new: Vec<By> = found.into_iter().filter(is_new).collect();
            all.extend(new);
        }
        Ok(all)
    }

    fn report(&self, document: &Document, prepared: &Prepared) -> Exit {
        let exit = if document.trusted { Exit::Fine } else { Exit::NotSolved };
        let written = match &self.out {
            Some(folder) => {
                files::write_all(folder, &document.model, &[("grad.json", output::json(document))])
            }
            None => Ok(Vec::new()),
        };
        output::print(&if self.json { output::json(document) } else { document.words() });
        match written {
            Ok(names) if names.is_empty() || self.json => exit,
            Ok(names) => {
                output::print(&format!(" wrote {}\n", names.join("  ")));
                exit
            }
            Err(failure) => failure.report(&prepared.source),
        }
    }
}
