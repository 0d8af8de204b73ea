//! Why a command has no result.

use fdcc::Error;
use fdcc_grammar::Diagnostic;
use fdcc_runtime::nlp::Stop;

/// Why there was no solve at all.
pub enum Failure {
    /// The model has no meaning for the solver.
    Model(Vec<Diagnostic>),
    /// There is nothing in the model that could be chosen.
    Nothing,
    /// What was asked for cannot be done.
    Usage(String),
    /// A file cannot be used.
    File(String),
    /// There was no time to compile the model.
    Stopped(Stop),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Model(diagnostics) => Failure::Model(diagnostics),
            Error::Nothing => Failure::Nothing,
            Error::Call(what) => Failure::Usage(what),
            Error::Record(_) | Error::Foreign(_) | Error::File(_) => {
                Failure::File(error.to_string())
            }
        }
    }
}
