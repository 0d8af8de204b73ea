//! From bytes to a model, with everything that is wrong with it as plain data.

use super::{DataFiles, Model};
use crate::error::Error;
use fdcc_compiler::{Analysis, Files, analyze_with, check_given, check_with_objective};
use fdcc_grammar::{Code, Diagnostic, ParseCache, Severity, SourceFile, Span, parse};
use std::string::FromUtf8Error;
use std::sync::Arc;

/// A text with everything that is known about it.
///
/// ```
/// let text = "time t in [0, 1]\nstate x start 0\ndynamics { x' = y }";
/// let checked = fdcc::check("broken", text.into());
/// assert!(checked.model.is_none());
/// assert_eq!(checked.diagnostics[0].code.to_string(), "FDC0101");
/// ```
pub struct Checked {
    /// The text.
    pub source: Arc<SourceFile>,
    /// What it means, if it has no mistake but parameters that wait for a value, and trajectories
    /// that are not unique.
    pub model: Option<Model>,
    /// What is wrong with it, in the order of the text.
    pub diagnostics: Arc<Vec<Diagnostic>>,
}

/// Reads and checks a text; `name` stands in messages. A model with measured data waits for it.
pub fn check(name: &str, bytes: Vec<u8>) -> Checked {
    check_with(name, bytes, None)
}

/// The same with data files.
pub fn check_with(name: &str, bytes: Vec<u8>, files: Option<DataFiles>) -> Checked {
    let (source, not_text) = text(name, bytes);
    let source = Arc::new(source);
    if let Some(diagnostic) = not_text {
        return Checked { source, model: None, diagnostics: Arc::new(vec![diagnostic]) };
    }
    let cache = &mut ParseCache::default();
    let Analysis { model, diagnostics, .. } = analyze(cache, &source.text, files.as_ref());
    Checked::new(source, model, diagnostics, files)
}

impl Checked {
    fn new(
        source: Arc<SourceFile>,
        meaning: Option<fdcc_compiler::Model>,
        diagnostics: Vec<Diagnostic>,
        files: Option<DataFiles>,
    ) -> Self {
        let diagnostics = Arc::new(diagnostics);
        let model = meaning.map(|it| Model::new(source.clone(), diagnostics.clone(), it, files));
        Checked { source, model, diagnostics }
    }

    /// Whether a finding is a parameter that waits for a value, which it may still get.
    pub fn waits(&self, found: &Diagnostic) -> bool {
        self.model.is_some() && found.code == Code::NoValue
    }

    /// Whether a mistake keeps the model from being solved.
    pub fn is_wrong(&self) -> bool {
        let is_wrong = |it: &Diagnostic| it.severity == Severity::Error && !self.waits(it);
        self.model.is_none() || self.diagnostics.iter().any(is_wrong)
    }

    /// The model, unless it has a mistake.
    ///
    /// # Errors
    ///
    /// All that was found.
    pub fn into_model(self) -> Result<Model, Error> {
        let is_wrong = self.is_wrong();
        let wrong = || Error::Model(self.diagnostics.to_vec());
        self.model.filter(|_| !is_wrong).ok_or_else(wrong)
    }
}

impl Model {
    /// The same with another objective: any expression that has a value at the end, such as
    /// `x(end)`. The places of what is found are in that expression.
    pub fn with_objective(&self, of: &str) -> Checked {
        let tree = parse(&self.source.text).tree;
        let checked = check_with_objective(&tree, of, for_compiler(self.files.as_ref()));
        let files = self.files.clone();
        let found = Checked::new(self.source.clone(), checked.model, Vec::new(), files);
        Checked { diagnostics: Arc::new(checked.diagnostics), ..found }
    }
}

impl Model {
    /// The same, where signals are given from outside on so many equal intervals; all values stay.
    pub(crate) fn with_given_signals(&self, intervals: usize) -> Result<Model, Error> {
        let tree = parse(&self.source.text).tree;
        let checked = check_given(&tree, for_compiler(self.files.as_ref()), Some(intervals));
        let mut meaning = checked.model.ok_or(Error::Model(checked.diagnostics))?;
        meaning.take_values(&self.meaning).map_err(Error::Model)?;
        Ok(self.with_meaning(meaning))
    }
}

/// Reads and checks a text: the one way in which the library does.
pub(crate) fn analyze(cache: &mut ParseCache, text: &str, files: Option<&DataFiles>) -> Analysis {
    analyze_with(cache, text, for_compiler(files))
}

/// Data files as the compiler wants them.
fn for_compiler(files: Option<&DataFiles>) -> Option<&dyn Files> {
    files.map(|files| files as &dyn Files)
}

/// The text of some bytes, and what is wrong if they are none.
pub fn text(name: &str, bytes: Vec<u8>) -> (SourceFile, Option<Diagnostic>) {
    match String::from_utf8(bytes) {
        Ok(text) => (SourceFile::new(name, text), None),
        Err(error) => not_text(name, &error),
    }
}

fn not_text(name: &str, error: &FromUtf8Error) -> (SourceFile, Option<Diagnostic>) {
    let at = error.utf8_error().valid_up_to();
    let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
    let span = Span::new(at, at + char::REPLACEMENT_CHARACTER.len_utf8());
    let diagnostic =
        Diagnostic::new(Code::NotText, "this is not a text file", span, "no character of UTF-8")
            .help("a model is plain text in UTF-8");
    (SourceFile::new(name, text), Some(diagnostic))
}
