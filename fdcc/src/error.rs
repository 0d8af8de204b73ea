//! Why there is no answer at all: a wrong model or a wrong call. A solve that finds nothing is no
//! error; its status says so.

use fdcc_grammar::Diagnostic;
use std::fmt;

/// A wrong model or a wrong call.
///
/// ```
/// use fdcc::{Error, Model};
///
/// let Err(Error::Model(diagnostics)) = Model::from_text("broken", "state x start y") else {
///     panic!("`y` is not declared");
/// };
/// assert!(diagnostics.iter().any(|it| it.message.contains("`y`")));
/// assert!(matches!(Model::from_file("nowhere.fdc"), Err(Error::File(_))));
/// ```
#[derive(Clone, Debug)]
pub enum Error {
    /// The model has no meaning for what was asked; places are byte ranges in its text.
    Model(Vec<Diagnostic>),
    /// There is nothing in the model that could be chosen.
    Nothing,
    /// What was asked for cannot be done.
    Call(String),
    /// A recorded solution cannot be used with this model.
    Record(String),
    /// A recorded solution has no state or control of the model of this name.
    Foreign(String),
    /// A file cannot be read.
    File(String),
}

impl std::error::Error for Error {}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Error::Model(diagnostics) => {
                f.write_str(diagnostics.first().map_or("the model is wrong", |it| &it.message))
            }
            Error::Nothing => f.write_str("the model has no state, control or `free` unknown"),
            Error::Foreign(model) => {
                write!(f, "the solution has no state or control of the model `{model}`")
            }
            Error::Call(what) | Error::Record(what) | Error::File(what) => f.write_str(what),
        }
    }
}
