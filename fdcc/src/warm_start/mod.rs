//! Starting from an earlier solution, on any grid.

mod complete;
pub(crate) mod phases;
mod tuning;

use crate::error::Error;
use crate::record::{Record, find, number, whole};
use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::solve::warm_start::{Earlier, from_earlier};

/// Whether a record has something of a problem, and that wholly.
pub(crate) fn check(record: &Record, chain: &Chain) -> Result<(), Error> {
    let known = own(record, chain);
    let is_foreign = |(record, problem): &(&Record, &Problem)| {
        let earlier = earlier(record, problem);
        earlier.states.iter().chain(&earlier.controls).all(Option::is_none)
    };
    if known.iter().all(is_foreign) {
        return Err(Error::Foreign(chain.name.clone()));
    }
    let whole = |(record, problem): &(&Record, &Problem)| complete::check(record, problem);
    known.iter().try_for_each(whole).map_err(Error::Record)
}

/// The record of each phase that has one.
fn own<'r, 'c>(record: &'r Record, chain: &'c Chain) -> Vec<(&'r Record<'r>, &'c Problem)> {
    let of = |problem: &'c Problem| Some((of_phase(record, chain, problem)?, problem));
    chain.phases.iter().filter_map(of).collect()
}

fn of_phase<'r>(record: &'r Record, chain: &Chain, problem: &Problem) -> Option<&'r Record<'r>> {
    match chain.phases.len() {
        1 if record.phases.is_empty() => Some(record),
        _ => record.phases.iter().find(|it| it.model == problem.name),
    }
}

/// The record on the grids of the chain. What it does not have is guessed.
pub(crate) fn from_record(record: &Record, chain: &Chain) -> Start {
    let of = |problem: &Problem| match of_phase(record, chain, problem) {
        Some(record) => earlier(record, problem),
        None => Earlier::default(),
    };
    from_earlier(chain, &chain.phases.iter().map(of).collect::<Vec<_>>())
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
        pieces: Vec::new(),
    }
}

/// The smoothing width of each surface of the problem; none where a model named them or the solve
/// did not come to its end, so that they may be wide.
fn widths(record: &Record, problem: &Problem) -> Vec<Option<f64>> {
    let settings = &record.settings;
    let width = |name: &str| number(&settings.sigmas, name).filter(|_| settings.sigma_chosen);
    problem.surfaces.iter().map(|surface| width(&surface.name)).collect()
}
