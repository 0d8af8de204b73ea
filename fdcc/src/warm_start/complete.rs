//! Whether an earlier solution has a number wherever it should: half of one is no place to start
//! from.

use crate::record::{Record, find};
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
    for unknown in &problem.unknowns {
        let name = &problem.parameters[unknown.parameter].name;
        if find(&record.free, name).is_some_and(|value| !value.is_finite()) {
            return Err(format!("`{name}` is no number"));
        }
    }
    Ok(())
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
