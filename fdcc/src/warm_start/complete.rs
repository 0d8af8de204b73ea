//! Whether an earlier solution has a number wherever it should: half of one is no place to start
//! from.

use super::tuning::ROUNDING;
use crate::record::{NodesRecord, Record, find};
use fdcc_runtime::problem::Problem;

/// Says what is missing of the signals and unknowns of the problem that the solution has.
pub(super) fn check(record: &Record, problem: &Problem) -> Result<(), String> {
    is_whole(record.time, "time")?;
    ascending(record)?;
    let points = record.time.len();
    for state in &problem.states {
        signal(find(&record.states, &state.name), &state.name, points)?;
    }
    for control in &problem.controls {
        signal(find(&record.controls, &control.name), &control.name, points - 1)?;
    }
    if let Some(nodes) = &record.nodes {
        nodes_of_controls(nodes, problem, record.time)?;
    }
    for unknown in &problem.unknowns {
        let name = &problem.parameters[unknown.parameter].name;
        if find(&record.free, name).is_some_and(|value| !value.is_finite()) {
            return Err(format!("`{name}` is no number"));
        }
    }
    Ok(())
}

/// Each control has a value at each of its nodes, which do not go back in time, and are within it.
fn nodes_of_controls(nodes: &NodesRecord, problem: &Problem, times: &[f64]) -> Result<(), String> {
    is_whole(nodes.time, "control_nodes.time")?;
    if let Some(pair) = nodes.time.windows(2).find(|pair| pair[1] < pair[0]) {
        let [before, after] = [pair[0], pair[1]];
        return Err(format!("its `control_nodes` must ascend, but {after} follows {before}"));
    }
    let [first, last] = [times[0], times[times.len() - 1]];
    let slack = ROUNDING * (last - first);
    let is_outside = |time: &&f64| **time < first - slack || **time > last + slack;
    if let Some(time) = nodes.time.iter().find(is_outside) {
        return Err(format!("its `control_nodes` have {time}, outside of its times"));
    }
    let mut own = problem.controls.iter().map(|it| &it.name);
    own.try_for_each(|name| {
        let found = find(&nodes.values, name);
        if found.is_none() {
            return Err(format!("`control_nodes` has no values of `{name}`"));
        }
        signal(found, &format!("control_nodes.values.{name}"), nodes.time.len())
    })
}

/// A state has a value at each time, a control one for each interval.
fn signal(found: Option<&[f64]>, name: &str, length: usize) -> Result<(), String> {
    let Some(found) = found else { return Ok(()) };
    if found.len() != length {
        return Err(format!("`{name}` has {} values where there should be {length}", found.len()));
    }
    is_whole(found, name)
}

fn is_whole(found: &[f64], name: &str) -> Result<(), String> {
    match found.iter().position(|value| !value.is_finite()) {
        Some(at) => Err(format!("value {} of `{name}` is no number", at + 1)),
        None => Ok(()),
    }
}

/// Two times are the same only where a jump happens.
fn ascending(record: &Record) -> Result<(), String> {
    let times = record.time;
    let jumps = |time: f64| record.jumps.iter().any(|jump| jump.time == time);
    let is_wrong = |pair: &[f64]| pair[1] < pair[0] || pair[1] == pair[0] && !jumps(pair[0]);
    if let Some(at) = times.windows(2).position(is_wrong) {
        return Err(format!("its times must ascend, but {} follows {}", times[at + 1], times[at]));
    }
    match times {
        [first, .., last] if first < last => Ok(()),
        _ => Err("its times do not go from a first to a later one".into()),
    }
}
