//! The exit codes.

use std::process::ExitCode;

/// How a command ended. The numbers are a contract with scripts; the worst of several is the
/// largest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exit {
    /// Solved, or nothing wrong.
    Fine = 0,
    /// The model has errors.
    ModelError = 1,
    /// Not solved; the best iterate is written all the same.
    NotSolved = 2,
    /// Wrong usage.
    Usage = 3,
    /// A file could not be read or written.
    File = 4,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit as u8)
    }
}
