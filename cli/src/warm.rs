//! Starting from an earlier solution, on any grid.

pub mod pieces;
mod whole;

use crate::output::named::Named;
use crate::output::saved::{Column, Saved};
use crate::solver::{Failure, Solved};
use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::{Method, Problem};
use fdcc_runtime::solve::warm_start::Earlier;
use fdcc_runtime::solve::warm_start::{again, from_earlier};
use std::path::Path;

/// Reads a `.sol.json` and interpolates it on the grid of the problem. Signals that it does not
/// have are guessed; those that it has must be whole.
pub fn from_file(path: &Path, problem: &Problem) -> Result<Start, Failure> {
    let saved = Saved::read(path)?;
    let earlier = saved.earlier(problem);
    if earlier.states.iter().chain(&earlier.controls).all(Option::is_none) {
        let (path, model) = (path.display(), &problem.name);
        return Err(Failure::File(format!(
            "{path} has no state or control of the model `{model}`"
        )));
    }
    whole::check(&saved, problem)
        .map_err(|what| Failure::File(format!("{}: {what}", path.display())))?;
    Ok(from_earlier(problem, &earlier))
}

/// The end of another solve as the start of this one: with its multipliers if the grid is the same.
pub fn from_solved(before: &Solved, problem: &Problem) -> Start {
    let solution = &before.outcome.solution;
    let shape = |problem: &Problem| {
        let Method { intervals, scheme, controls, mesh, .. } = problem.method.clone();
        (intervals, scheme, controls, mesh)
    };
    if shape(&before.problem) == shape(problem) {
        let is_chosen = before.document.method.sigma_chosen;
        return again(problem, solution, if is_chosen { &before.outcome.sigma } else { &[] });
    }
    from_earlier(problem, &Saved::from(&before.document).earlier(problem))
}

/// From 0 to 1; none if one is missing.
fn normalised(times: &[Option<f64>]) -> Vec<f64> {
    let times: Vec<f64> = times.iter().copied().collect::<Option<_>>().unwrap_or_default();
    let [Some(first), Some(last)] = [times.first(), times.last()] else { return Vec::new() };
    times.iter().map(|time| (time - first) / (last - first)).collect()
}

impl Saved {
    /// In the order of the problem; a signal with a hole counts as missing.
    fn earlier(&self, problem: &Problem) -> Earlier {
        let column = |of: &Named<Column>, name: &str| of.get(name)?.iter().copied().collect();
        let states = problem.states.iter().map(|state| column(&self.states, &state.name));
        let controls = problem.controls.iter().map(|control| column(&self.controls, &control.name));
        let names =
            problem.unknowns.iter().map(|unknown| &problem.parameters[unknown.parameter].name);
        Earlier {
            times: normalised(&self.time),
            states: states.collect(),
            controls: controls.collect(),
            unknowns: names.map(|name| self.free.get(name).copied().flatten()).collect(),
            widths: self.widths(problem),
        }
    }

    /// The smoothing width of each surface of the problem; none where a model named them or the
    /// solve did not come to its end, so that they may be wide.
    fn widths(&self, problem: &Problem) -> Vec<Option<f64>> {
        let is_chosen = self.method.sigma_chosen;
        let width =
            |name: &str| self.method.sigmas.get(name).copied().flatten().filter(|_| is_chosen);
        problem.surfaces.iter().map(|surface| width(&surface.name)).collect()
    }
}
