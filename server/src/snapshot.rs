//! All that is known about one state of a text.

use crate::text::Text;
use fdcc::DataFiles;
use fdcc_compiler::symbols::Names;
use fdcc_compiler::{Analysis, Files, SurfaceReport, analyze_with, surfaces};
use fdcc_grammar::{Code, ParseCache, Severity};
use std::cell::OnceCell;

/// One state of a text, what it means and what is wrong with it.
pub struct Snapshot {
    /// The text.
    pub text: Text,
    /// As `fdcc check` sees it.
    pub analysis: Analysis,
    /// Whether all of it could be read.
    pub is_readable: bool,
    names: OnceCell<Names>,
    surfaces: OnceCell<Vec<SurfaceReport>>,
}

impl Snapshot {
    /// Reads and checks a text, with a cache of its former states and the data files beside it.
    pub fn new(text: Text, cache: &mut ParseCache, files: Option<&DataFiles>) -> Self {
        let load = files.map(|files| |name: &str| files.text(name));
        let load = load.as_ref().map(|load| load as &Files);
        let analysis = analyze_with(cache, &text.text, load);
        let is_syntax = |code: Code| code.as_str().starts_with("FDC00");
        let is_readable = !analysis
            .diagnostics
            .iter()
            .any(|it| it.severity == Severity::Error && is_syntax(it.code));
        Snapshot { text, analysis, is_readable, names: OnceCell::new(), surfaces: OnceCell::new() }
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
}
