//! Starting from an earlier solution, on any grid.

mod complete;
pub(crate) mod phases;

use crate::error::Error;
use crate::record::{Record, find, number, whole};
use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::solve::warm_start::{Earlier, from_earlier};

/// Whether a record has something of a problem, and that wholly.
pub(crate) fn check(record: &Record, problem: &Problem) -> Result<(), Error> {
    let earlier = earlier(record, problem);
    if earlier.states.iter().chain(&earlier.controls).all(Option::is_none) {
        return Err(Error::Foreign(problem.name.clone()));
    }
    complete::check(record, problem).map_err(Error::Record)
}

/// The record on the grid of the problem. What it does not have is guessed.
pub(crate) fn from_record(record: &Record, problem: &Problem) -> Start {
    from_earlier(&Chain::single(problem.clone()), &[earlier(record, problem)])
}

/// From 0 to 1; none if one is missing.
fn normalised(times: &[f64]) -> Vec<f64> {
    let times = whole(times).unwrap_or_default();
    let [Some(first), Some(last)] = [times.first(), times.last()] else { return Vec::new() };
    times.iter().map(|time| (time - first) / (last - first)).collect()
}

/// In the order of the problem; a signal with a hole counts as missing.
fn earlier(record: &Record, problem: &Problem) -> Earlier {
    let column = |of: &[(&str, &[f64])], name: &str| whole(find(of, name)?);
    let states = problem.states.iter().map(|state| column(&record.states, &state.name));
    let controls = problem.controls.iter().map(|control| column(&record.controls, &control.name));
    let names = problem.unknowns.iter().map(|unknown| &problem.parameters[unknown.parameter].name);
    Earlier {
        times: normalised(record.time),
        states: states.collect(),
        controls: controls.collect(),
        unknowns: names.map(|name| number(&record.free, name)).collect(),
        widths: widths(record, problem),
    }
}

/// The smoothing width of each surface of the problem; none where a model named them or the solve
/// did not come to its end, so that they may be wide.
fn widths(record: &Record, problem: &Problem) -> Vec<Option<f64>> {
    let settings = &record.settings;
    let width = |name: &str| number(&settings.sigmas, name).filter(|_| settings.sigma_chosen);
    problem.surfaces.iter().map(|surface| width(&surface.name)).collect()
}
