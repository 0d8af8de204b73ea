//! From bytes to a model, with everything that is wrong with it as plain data.

use super::Model;
use crate::error::Error;
use fdcc_compiler::{Analysis, analyze, check_with_objective};
use fdcc_grammar::{Code, Diagnostic, Severity, SourceFile, Span, parse};
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

/// Reads and checks a text; `name` stands in messages.
pub fn check(name: &str, bytes: Vec<u8>) -> Checked {
    let (source, not_text) = text(name, bytes);
    let source = Arc::new(source);
    if let Some(diagnostic) = not_text {
        return Checked { source, model: None, diagnostics: Arc::new(vec![diagnostic]) };
    }
    let Analysis { model, diagnostics, .. } = analyze(&source.text);
    Checked::new(source, model, diagnostics)
}

impl Checked {
    fn new(
        source: Arc<SourceFile>,
        meaning: Option<fdcc_compiler::Model>,
        diagnostics: Vec<Diagnostic>,
    ) -> Self {
        let diagnostics = Arc::new(diagnostics);
        let model = meaning.map(|it| Model::new(source.clone(), diagnostics.clone(), it));
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
        let checked = check_with_objective(&parse(&self.source.text).tree, of);
        let found = Checked::new(self.source.clone(), checked.model, Vec::new());
        Checked { diagnostics: Arc::new(checked.diagnostics), ..found }
    }
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
