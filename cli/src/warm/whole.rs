//! Whether an earlier solution has a number wherever it should: half of one is no place to start
//! from.

use crate::output::saved::{Column, Saved};
use fdcc_runtime::problem::Problem;

/// Says what is missing of the signals and unknowns of the problem that the solution has.
pub fn check(saved: &Saved, problem: &Problem) -> Result<(), String> {
    ascending(&column(&saved.time, "time")?)?;
    let points = saved.time.len();
    for state in &problem.states {
        signal(saved.states.get(&state.name), &state.name, points)?;
    }
    for control in &problem.controls {
        signal(saved.controls.get(&control.name), &control.name, points - 1)?;
    }
    for unknown in &problem.unknowns {
        let name = &problem.parameters[unknown.parameter].name;
        if saved.free.get(name).is_some_and(Option::is_none) {
            return Err(format!("`{name}` is no number"));
        }
    }
    Ok(())
}

/// A state has a value at each time, a control one for each interval.
fn signal(found: Option<&Column>, name: &str, length: usize) -> Result<(), String> {
    let Some(found) = found else { return Ok(()) };
    if found.len() != length {
        return Err(format!("`{name}` has {} values where there should be {length}", found.len()));
    }
    column(found, name).map(drop)
}

fn column(found: &Column, name: &str) -> Result<Vec<f64>, String> {
    let number = |(at, value): (usize, &Option<f64>)| {
        value.ok_or_else(|| format!("value {} of `{name}` is no number", at + 1))
    };
    found.iter().enumerate().map(number).collect()
}

/// Two jumps may happen at one time, so times need not differ.
fn ascending(times: &[f64]) -> Result<(), String> {
    if let Some(at) = times.windows(2).position(|pair| pair[1] < pair[0]) {
        return Err(format!("its times must ascend, but {} follows {}", times[at + 1], times[at]));
    }
    match times {
        [first, .., last] if first < last => Ok(()),
        _ => Err("its times do not go from a first to a later one".into()),
    }
}
