//! Starting from an earlier solution, on any grid.

use crate::output::document::Document;
use crate::output::named::Named;
use crate::solver::{Failure, Solved};
use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::Problem;
use fdcc_runtime::starts::{Earlier, resample};
use serde::Deserialize;
use std::fs;
use std::path::Path;

/// The part of a `.sol.json` that a start needs. A number that was not finite is `null` there.
#[derive(Deserialize)]
struct Saved {
    states: Named<Vec<Option<f64>>>,
    controls: Named<Vec<Option<f64>>>,
    free: Named<Option<f64>>,
}

/// Reads a `.sol.json` and interpolates it on the grid of the problem. Signals that it does not have are guessed.
pub fn from_file(path: &Path, problem: &Problem) -> Result<Start, Failure> {
    let failure = |what: String| Failure::File(format!("{}{what}", path.display()));
    let text = fs::read_to_string(path).map_err(|error| failure(format!(" cannot be read: {error}")))?;
    let saved: Saved =
        serde_json::from_str(&text).map_err(|error| failure(format!(" is not a solution: {error}")))?;
    let earlier = saved.earlier(problem);
    if earlier.states.iter().chain(&earlier.controls).all(Option::is_none) {
        return Err(failure(format!(" has no state or control of the model `{}`", problem.name)));
    }
    Ok(Start { v: resample(problem, &earlier), warm: None })
}

/// The end of another solve as the start of this one: with its multipliers if the grid is the same.
pub fn from_solved(before: &Solved, problem: &Problem) -> Start {
    let solution = &before.outcome.solution;
    if before.problem.method.intervals == problem.method.intervals {
        return Start { v: solution.v.clone(), warm: Some(solution.multipliers.clone()) };
    }
    Start { v: resample(problem, &Saved::from(&before.document).earlier(problem)), warm: None }
}

impl Saved {
    /// In the order of the problem; a signal with a hole counts as missing.
    fn earlier(&self, problem: &Problem) -> Earlier {
        let column = |of: &Named<Vec<Option<f64>>>, name: &str| of.get(name)?.iter().copied().collect();
        let states = problem.states.iter().map(|state| column(&self.states, &state.name));
        let controls = problem.controls.iter().map(|control| column(&self.controls, &control.name));
        let names = problem.unknowns.iter().map(|unknown| &problem.parameters[unknown.parameter].name);
        Earlier {
            states: states.collect(),
            controls: controls.collect(),
            unknowns: names.map(|name| self.free.get(name).copied().flatten()).collect(),
        }
    }
}

impl From<&Document> for Saved {
    fn from(document: &Document) -> Self {
        let finite = |value: &f64| Some(*value).filter(|value| value.is_finite());
        let columns = |of: &Named<Vec<f64>>| {
            of.0.iter().map(|(name, column)| (name.clone(), column.iter().map(finite).collect())).collect()
        };
        Saved {
            states: columns(&document.states),
            controls: columns(&document.controls),
            free: document.free.0.iter().map(|(name, value)| (name.clone(), finite(value))).collect(),
        }
    }
}
