//! What `fdcc test --json` prints: one entry per model, one line per expectation.

use super::units::Units;
use serde::Serialize;

/// What became of one model.
#[derive(Serialize)]
pub struct Tested {
    pub file: String,
    pub model: String,
    /// The status of the solve; nothing where there was nothing to expect.
    pub status: Option<String>,
    pub expectations: Vec<Line>,
    /// For the lines that people read; the values here are in SI.
    #[serde(skip)]
    pub units: Units,
}

/// What became of one line of an `expect` block.
#[derive(Serialize)]
pub struct Line {
    pub line: usize,
    pub text: String,
    pub outcome: Word,
    pub left: Option<f64>,
    pub right: Option<f64>,
    pub tolerance: Option<f64>,
    /// Why there are no values.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

#[derive(Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Word {
    Ok,
    Failed,
}
