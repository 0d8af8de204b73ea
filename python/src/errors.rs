//! Why there is no result, as exceptions of Python.

use fdcc::Error;
use fdcc_grammar::{Diagnostic, SourceFile};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;

/// The exception for an error of the library; `source` is the text that places are in.
pub fn raised(py: Python, error: Error, source: &SourceFile) -> PyErr {
    match error {
        Error::Model(diagnostics) => wrong_model(py, &diagnostics, source),
        Error::Nothing => model_error(py, &error.to_string(), "[]"),
        Error::File(message) => PyOSError::new_err(message),
        Error::Call(_) | Error::Record(_) | Error::Foreign(_) => {
            PyValueError::new_err(error.to_string())
        }
    }
}

/// `fdcc.ModelError` with the drawing of `fdcc check`.
pub fn wrong_model(py: Python, diagnostics: &[Diagnostic], source: &SourceFile) -> PyErr {
    let (drawn, json) =
        (fdcc_cli::drawn(diagnostics, source), fdcc_cli::diagnostics(diagnostics, source));
    model_error(py, &drawn, &json)
}

fn model_error(py: Python, text: &str, diagnostics: &str) -> PyErr {
    let class = py.import("fdcc._errors").and_then(|it| it.getattr("ModelError"));
    match class.and_then(|it| it.call1((text, diagnostics))) {
        Ok(error) => PyErr::from_value(error),
        Err(error) => error,
    }
}
