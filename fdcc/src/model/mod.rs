//! A model: read, checked, and compiled once for all values of its parameters.

mod code;
mod data;
mod reading;
mod stages;
mod values;

pub use data::DataFiles;
pub(crate) use reading::analyze;
pub use reading::{Checked, check, check_with, text};
pub use stages::Stage;
pub use values::Value;

use crate::error::Error;
use code::Code;
use fdcc_compiler::Kinks;
use fdcc_grammar::{Diagnostic, SourceFile};
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::simulate::System;
use std::sync::Arc;

/// A model without mistakes. Clones and variants with other values share what is compiled.
///
/// ```
/// use fdcc::{Model, Options};
///
/// let model = Model::from_text("hop", "time t in [0, 1]
/// param reach = 0.5
/// state x start 0
/// control u in [-1, 1]
/// dynamics { x' = u }
/// end x == reach
/// minimize integral(u^2)")?;
/// let near = model.solve(&Options::default())?;
/// let far = model.with("reach", 0.8)?.solve(&Options::default())?;
/// assert!(near.objective() < far.objective());
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Clone)]
pub struct Model {
    source: Arc<SourceFile>,
    diagnostics: Arc<Vec<Diagnostic>>,
    meaning: Arc<fdcc_compiler::Model>,
    files: Option<DataFiles>,
    code: Arc<Code>,
}

/// What all phases share, as a problem without signals; the problem itself if there is one phase.
pub(crate) fn frame(chain: &Chain) -> Problem {
    let first = chain.phases[0].clone();
    if chain.phases.len() == 1 && chain.links.is_empty() {
        return first;
    }
    let shared = first.parameters.len() - widths(&first);
    Problem {
        name: chain.name.clone(),
        parameters: first.parameters[..shared].to_vec(),
        unknowns: chain.unknowns.clone(),
        states: Vec::new(),
        controls: Vec::new(),
        surfaces: Vec::new(),
        path_bounds: Vec::new(),
        half_open: Vec::new(),
        boundary_bounds: Vec::new(),
        start: Vec::new(),
        report_names: Vec::new(),
        ..first
    }
}

/// How many smoothing widths a problem has; they come last.
fn widths(problem: &Problem) -> usize {
    let is_width = |it: &&fdcc_runtime::problem::Parameter| it.name.starts_with("sigma(");
    problem.parameters.iter().rev().take_while(is_width).count()
}

impl Model {
    /// Reads and checks a file, with the data files beside it.
    ///
    /// # Errors
    ///
    /// A file that cannot be read; a model with mistakes.
    pub fn from_file(path: &str) -> Result<Self, Error> {
        let cannot = |error| Error::File(format!("{path} cannot be read: {error}"));
        let bytes = std::fs::read(path).map_err(cannot)?;
        check_with(path, bytes, Some(DataFiles::beside(path))).into_model()
    }

    /// Reads and checks a text; `name` stands in messages.
    ///
    /// # Errors
    ///
    /// A model with mistakes.
    pub fn from_text(name: &str, text: &str) -> Result<Self, Error> {
        check(name, text.into()).into_model()
    }

    /// The model with what it means, as the compiler has it.
    pub(crate) fn new(
        source: Arc<SourceFile>,
        diagnostics: Arc<Vec<Diagnostic>>,
        meaning: fdcc_compiler::Model,
        files: Option<DataFiles>,
    ) -> Self {
        Model { source, diagnostics, meaning: Arc::new(meaning), files, code: Arc::default() }
    }

    /// Another meaning of the same text.
    pub(crate) fn with_meaning(&self, meaning: fdcc_compiler::Model) -> Self {
        let (source, diagnostics) = (Arc::clone(&self.source), Arc::clone(&self.diagnostics));
        Model::new(source, diagnostics, meaning, self.files.clone())
    }

    /// The name that the model gives itself.
    pub fn name(&self) -> &str {
        &self.meaning.name
    }

    /// The text.
    pub fn source(&self) -> &SourceFile {
        &self.source
    }

    /// Warnings and advice about the text.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// What it means, as the compiler has it.
    pub fn meaning(&self) -> &fdcc_compiler::Model {
        &self.meaning
    }

    /// The problem that is solved for it: bounds, guesses and parameters with their values. Of a
    /// model with phases, what they share: parameters, unknowns and method.
    ///
    /// # Errors
    ///
    /// What cannot be solved yet; parameters without a value.
    pub fn problem(&self) -> Result<Problem, Error> {
        Ok(frame(&self.chain()?))
    }

    /// The problems of its phases and the links between them; one problem if it has no phases.
    ///
    /// # Errors
    ///
    /// As for [`problem`](Model::problem).
    pub fn chain(&self) -> Result<Chain, Error> {
        self.code.chain(&self.meaning).map_err(Error::Model)
    }

    /// The texts of the data files that it reads, by the names that it gives them.
    ///
    /// # Errors
    ///
    /// A file that cannot be read any more.
    pub fn data(&self) -> Result<Vec<(String, String)>, Error> {
        let Some(files) = &self.files else { return Ok(Vec::new()) };
        let phases = self.meaning.phases.iter().flat_map(|phase| &phase.model.tables);
        let names = phases.chain(&self.meaning.tables).map(|table| &table.file);
        let text = |name: &String| Ok((name.clone(), files.text(name).map_err(Error::File)?));
        names.map(text).collect()
    }

    /// The same, where some names are known to be far smaller than one of their units.
    pub(crate) fn with_magnitudes(&self, magnitudes: Vec<(String, f64)>) -> Model {
        let meaning = fdcc_compiler::Model { magnitudes, ..(*self.meaning).clone() };
        Model { meaning: Arc::new(meaning), ..self.clone() }
    }

    /// The model in which unknowns and surfaces stand for the kinks that an optimum may lie on;
    /// nothing where there are none.
    pub(crate) fn without_kinks(&self, kinks: Kinks) -> Option<Model> {
        let is_true = !self.names_its_discretisation();
        let meaning = fdcc_compiler::without_kinks(&self.meaning, kinks, is_true)?;
        let code = if kinks == Kinks::Relaxed { self.code.without_kinks() } else { Arc::default() };
        Some(Model { meaning: Arc::new(meaning), code, ..self.clone() })
    }

    /// Whether a grid is named, or the width of layers where there are any: then the optimum of
    /// that is meant, and not that of the system that was written.
    pub(crate) fn names_its_discretisation(&self) -> bool {
        let phases = self.meaning.phases.iter().map(|it| &it.model);
        let all: Vec<&fdcc_compiler::Model> = match self.meaning.phases.is_empty() {
            true => vec![&self.meaning],
            false => phases.collect(),
        };
        let switches = |it: &fdcc_compiler::Model| !it.surfaces.is_empty() || !it.jumps.is_empty();
        match all.iter().any(|it| switches(it)) {
            true => all.iter().any(|it| switches(it) && it.method.names_width()),
            false => all.iter().any(|it| it.method.names_grid),
        }
    }

    /// Does once for all values of its parameters what makes its functions ready.
    pub(crate) fn make_ready(&self, make: impl FnOnce()) {
        self.code.make_ready(make);
    }

    /// Its phases, as models of their own; none if it has none.
    pub fn phases(&self) -> Vec<Model> {
        let own = |phase: &fdcc_compiler::Phase| self.with_meaning(phase.model.clone());
        self.meaning.phases.iter().map(own).collect()
    }

    /// The true system, for simulation.
    ///
    /// # Errors
    ///
    /// What cannot be simulated yet; parameters without a value.
    pub fn system(&self) -> Result<System, Error> {
        fdcc_compiler::compile_simulation(&self.meaning).map_err(Error::Model)
    }

    /// The true system with all derivatives.
    ///
    /// # Errors
    ///
    /// As for [`system`](Model::system).
    pub fn sensitivity_system(&self) -> Result<System, Error> {
        fdcc_compiler::compile_sensitivities(&self.meaning).map_err(Error::Model)
    }
}
