//! A text of the language while it is written: what is wrong with it, what each name in it stands
//! for, repairs; and the words of the language itself. What editors show.
//!
//! Spans are byte ranges in the text.

pub use fdcc_compiler::symbols::{Definition, Kind, Meaning, Names, Occurrence, Role, enclosing};
pub use fdcc_compiler::vocabulary;
pub use fdcc_compiler::{
    Grid, NamedUnit, Order, Smoothness, SurfaceReport, SymbolInformation, parse_quantity, repair,
};

use crate::model::{DataFiles, analyze};
use fdcc_compiler::{Analysis, grid, surfaces, symbol_information};
use fdcc_grammar::{Code, Diagnostic, ParseCache, Severity, Span, ast};
use std::sync::OnceLock;

/// One state of a text, read and checked, with or without mistakes.
///
/// ```
/// use fdcc::language::Reading;
///
/// let text = "param k = 2 [1/s]\ntime t in [0, 1] [s]\nstate x start 1\ndynamics { x' = -k*x }";
/// let reading = Reading::new(text, &mut Default::default(), None);
/// assert!(reading.diagnostics().is_empty());
/// assert!(reading.names().definitions.iter().any(|it| it.name == "k"));
/// assert!(reading.information(None, "k").is_some());
/// ```
pub struct Reading {
    analysis: Analysis,
    names: OnceLock<Names>,
    surfaces: OnceLock<Vec<SurfaceReport>>,
}

impl Reading {
    /// Reads and checks a text as [`check_with`](crate::check_with) does; `cache` keeps what was
    /// read of its former states.
    pub fn new(text: &str, cache: &mut ParseCache, files: Option<&DataFiles>) -> Self {
        let analysis = analyze(cache, text, files);
        Reading { analysis, names: OnceLock::new(), surfaces: OnceLock::new() }
    }

    /// What could be read of it.
    pub fn tree(&self) -> &ast::Model {
        &self.analysis.tree
    }

    /// What is wrong with it, in the order of the text.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.analysis.diagnostics
    }

    /// The unit of each name, if the text uses units.
    pub fn units(&self) -> &[NamedUnit] {
        &self.analysis.units
    }

    /// Whether all of it could be read.
    pub fn is_readable(&self) -> bool {
        let is_syntax = |code: Code| code.as_str().starts_with("FDC00");
        let is_unread = |it: &Diagnostic| it.severity == Severity::Error && is_syntax(it.code);
        !self.diagnostics().iter().any(is_unread)
    }

    /// The name of the model, if the text has no error.
    pub fn model_name(&self) -> Option<&str> {
        self.analysis.model.as_ref().map(|model| model.name.as_str())
    }

    /// Whether the text has no error.
    pub fn has_meaning(&self) -> bool {
        self.analysis.model.is_some()
    }

    /// Every name with its role.
    pub fn names(&self) -> &Names {
        self.names.get_or_init(|| Names::new(&self.analysis.tree))
    }

    /// What is known about each surface, if there is a model and all its parameters have values.
    pub fn surfaces(&self) -> &[SurfaceReport] {
        let found = || self.analysis.model.as_ref().and_then(|model| surfaces(model).ok());
        self.surfaces.get_or_init(|| found().unwrap_or_default())
    }

    /// What is known about a surface of a phase, or outside of all phases.
    pub fn surface(&self, phase: Option<&str>, name: &str) -> Option<SurfaceReport> {
        let reports = surfaces(self.meaning_of(phase)?).ok()?;
        reports.into_iter().find(|it| it.place.name == name)
    }

    /// What is known about a name of a phase, or outside of all phases: nothing if the text has an
    /// error or waits for the value of a parameter.
    pub fn information(&self, phase: Option<&str>, name: &str) -> Option<SymbolInformation> {
        symbol_information(self.meaning_of(phase)?, name)
    }

    /// Where the objective stands, if the text has no error.
    pub fn objective(&self) -> Option<Span> {
        self.analysis.model.as_ref()?.objective.as_ref().map(|it| it.0.span)
    }

    /// The grid in numbers, as for [`information`](Reading::information).
    pub fn grid(&self) -> Option<Grid> {
        grid(self.analysis.model.as_ref()?)
    }

    fn meaning_of(&self, phase: Option<&str>) -> Option<&fdcc_compiler::Model> {
        let whole = self.analysis.model.as_ref()?;
        let Some(name) = phase else { return Some(whole) };
        // Of a phase for each file the first one speaks for all.
        let first = format!("{name}[1]");
        let mut phases = whole.phases.iter().map(|phase| &phase.model);
        phases.find(|it| it.name == name || it.name == first)
    }

    /// The phases that were written as one for each file, with the name of its file.
    pub fn files_of(&self, phase: &str) -> Vec<(&str, &str)> {
        let phases = self.analysis.model.iter().flat_map(|model| &model.phases);
        let of_each = phases.filter(|it| {
            it.model.name.strip_prefix(phase).is_some_and(|rest| rest.starts_with('['))
        });
        let named = of_each.filter_map(|it| {
            let table = it.model.tables.iter().find(|table| table.is_of_pattern)?;
            Some((it.model.name.as_str(), table.file.as_str()))
        });
        named.collect()
    }
}
