//! Control files: CSV with `t` and the controls, held from row to row, or the `.sol.json` of a solve.

use super::named::Named;
use crate::solver::Failure;
use fdcc_compiler::Model;
use fdcc_runtime::simulate::Controls;
use serde::Deserialize;
use std::fs;
use std::path::Path;

/// What a file says: controls over time; unknowns and start values of a solution.
#[derive(Default)]
pub struct Replay {
    times: Vec<f64>,
    rows: Vec<Vec<f64>>,
    free: Vec<(String, f64)>,
    start: Vec<(String, f64)>,
}

/// The part of a `.sol.json` that a replay needs.
#[derive(Deserialize)]
struct Solution {
    time: Vec<Option<f64>>,
    states: Named<Vec<Option<f64>>>,
    controls: Named<Vec<Option<f64>>>,
    free: Named<Option<f64>>,
}

/// Reads a control file for a model.
pub fn read(path: &Path, model: &Model) -> Result<Replay, Failure> {
    let failure = |what: String| Failure::File(format!("{}{what}", path.display()));
    let text = fs::read_to_string(path).map_err(|error| failure(format!(" cannot be read: {error}")))?;
    let is_json = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
    let replay = if is_json { from_solution(&text, model) } else { from_csv(&text, model) };
    let replay = replay.map_err(|what| failure(format!(": {what}")))?;
    replay.check().map_err(|what| failure(format!(": {what}")))?;
    Ok(replay)
}

fn from_csv(text: &str, model: &Model) -> Result<Replay, String> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let header = lines.next().ok_or("the file is empty; it needs a header such as `t,u`")?.1;
    let names: Vec<&str> = header.trim_start_matches('\u{feff}').split(',').map(str::trim).collect();
    let columns = columns(&names, model)?;
    let mut replay = Replay::default();
    for (at, line) in lines {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        if cells.len() != names.len() {
            let (found, needed) = (cells.len(), names.len());
            return Err(format!("line {}: {found} columns, but the header has {needed}", at + 1));
        }
        let number = |column: usize| match cells[column].parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(format!("line {}: `{}` of `{}` is no number", at + 1, cells[column], names[column])),
        };
        replay.times.push(number(0)?);
        replay.rows.push(columns.iter().map(|&column| number(column)).collect::<Result<_, _>>()?);
    }
    Ok(replay)
}

/// The column of each control. States and reports may stand beside them, as in the `.csv` of a solve.
fn columns(names: &[&str], model: &Model) -> Result<Vec<usize>, String> {
    if names[0] != "t" {
        return Err(format!("the first column is `{}`, but must be `t`", names[0]));
    }
    let controls = || model.controls.iter().map(|control| control.place.name.as_str());
    let others = model.states.iter().map(|state| &state.place).chain(model.report.iter().map(|it| &it.place));
    let others: Vec<&str> = others.map(|place| place.name.as_str()).collect();
    for (at, name) in names.iter().enumerate().skip(1) {
        if names[..at].contains(name) {
            return Err(format!("there are two columns `{name}`"));
        }
        if !controls().any(|control| control == *name) && !others.contains(name) {
            let known = controls().collect::<Vec<_>>().join(", ");
            return Err(format!("`{name}` is no control of the model `{}` ({known})", model.name));
        }
    }
    controls()
        .map(|control| {
            let column = names.iter().position(|name| *name == control);
            column.ok_or_else(|| format!("there is no column for the control `{control}`"))
        })
        .collect()
}

fn from_solution(text: &str, model: &Model) -> Result<Replay, String> {
    let saved: Solution = serde_json::from_str(text).map_err(|error| format!("not a solution: {error}"))?;
    let mut replay = Replay::default();
    let times: Option<Vec<f64>> = saved.time.iter().copied().collect();
    let times = times.ok_or("a time is no number")?;
    let intervals = times.len().saturating_sub(1);
    replay.times = times[..intervals].to_vec();
    replay.rows = vec![Vec::new(); intervals];
    for control in &model.controls {
        let name = &control.place.name;
        let column = saved.controls.get(name).ok_or(format!("there is no control `{name}`"))?;
        if column.len() != intervals {
            return Err(format!("`{name}` has {} values for {intervals} intervals", column.len()));
        }
        for (row, value) in replay.rows.iter_mut().zip(column) {
            row.push(value.ok_or(format!("a value of `{name}` is no number"))?);
        }
    }
    replay.free = numbers(saved.free.0.into_iter());
    replay.start =
        numbers(saved.states.0.into_iter().map(|(name, column)| (name, column.first().copied().flatten())));
    Ok(replay)
}

fn numbers(values: impl Iterator<Item = (String, Option<f64>)>) -> Vec<(String, f64)> {
    values.filter_map(|(name, value)| Some((name, value?))).collect()
}

impl Replay {
    fn check(&self) -> Result<(), String> {
        if self.times.is_empty() {
            return Err("there is no row of values".into());
        }
        match self.times.windows(2).position(|pair| pair[0] >= pair[1]) {
            Some(at) => {
                let [before, after] = [self.times[at], self.times[at + 1]];
                Err(format!("times must ascend, but {after} follows {before}"))
            }
            None => Ok(()),
        }
    }

    /// Gives the model the unknowns of the solution, and the start of states that the model leaves open.
    pub fn adapt(&self, model: &mut Model) {
        self.free.iter().for_each(|(name, value)| model.set_free(name, *value));
        self.start.iter().for_each(|(name, value)| model.set_open_start(name, *value));
    }

    /// The controls, if a file was given.
    pub fn held(self) -> Option<Controls> {
        (!self.times.is_empty()).then_some(Controls::Held { times: self.times, rows: self.rows })
    }
}
