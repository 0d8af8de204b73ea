//! Starting from an earlier solution.

use crate::commands::Exit;
use crate::output;
use crate::output::document::Document;
use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::Problem;
use fdcc_runtime::starts::{Earlier, resample};
use std::fs;
use std::path::Path;

/// Reads a `.sol.json` and interpolates it on the grid of the problem. Signals that it does not have are guessed.
pub fn start(path: &Path, problem: &Problem) -> Result<Start, Exit> {
    let complain = |what: String| {
        output::complain(&format!("{}: {what}", path.display()));
        Exit::File
    };
    let text = fs::read_to_string(path).map_err(|error| complain(format!("cannot be read: {error}")))?;
    let document: Document =
        serde_json::from_str(&text).map_err(|error| complain(format!("is not a solution: {error}")))?;
    if document.time.len() < 2 {
        return Err(complain("has no trajectory".into()));
    }
    let columns = |names: Vec<&str>, of: &output::named::Named<Vec<f64>>| {
        names.into_iter().map(|name| of.get(name).cloned()).collect()
    };
    let earlier = Earlier {
        states: columns(problem.states.iter().map(|it| it.name.as_str()).collect(), &document.states),
        controls: columns(problem.controls.iter().map(|it| it.name.as_str()).collect(), &document.controls),
        unknowns: problem.unknowns.iter().map(|it| document.free.get(&problem.parameters[it.parameter].name).copied()).collect(),
    };
    Ok(Start { v: resample(problem, &earlier), warm: None })
}
