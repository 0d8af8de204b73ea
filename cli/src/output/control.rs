//! Control files: CSV with `t` and the controls, held from row to row, or the `.sol.json` of a
//! solve.

use super::saved::Saved;
use crate::failure::Failure;
use crate::input;
use fdcc::{Model, Replay};
use std::path::Path;

/// What drives a simulation.
#[derive(Default)]
pub struct Driver {
    pub replay: Replay,
    /// Of the text that was solved, if these are the controls of a solution.
    pub source_sha256: Option<String>,
}

/// Reads a control file for a model.
pub fn read(path: &Path, model: &Model) -> Result<Driver, Failure> {
    let failure = |what: String| Failure::File(format!("{}{what}", path.display()));
    let is_json = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
    let mut source_sha256 = None;
    let replay = if is_json {
        let saved = Saved::read(path)?;
        let replay = Replay::new(&saved.record(), model.meaning());
        source_sha256 = Some(saved.source_sha256).filter(|it| !it.is_empty());
        replay
    } else {
        let text =
            input::text(path).map_err(|error| failure(format!(" cannot be read: {error}")))?;
        from_csv(&text, model)
    };
    let checked = replay.and_then(|replay| replay.check().map(|()| replay));
    let replay = checked.map_err(|what| failure(format!(": {what}")))?;
    Ok(Driver { replay, source_sha256 })
}

fn from_csv(text: &str, model: &Model) -> Result<Replay, String> {
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let header = lines.next().ok_or("the file is empty; it needs a header such as `t,u`")?.1;
    let names: Vec<&str> =
        header.trim_start_matches('\u{feff}').split(',').map(str::trim).collect();
    let columns = columns(&names, model)?;
    let (mut times, mut rows, mut twice) = (Vec::new(), Vec::new(), None);
    for (at, line) in lines {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        if cells.len() != names.len() {
            let (found, needed) = (cells.len(), names.len());
            return Err(format!("line {}: {found} columns, but the header has {needed}", at + 1));
        }
        let number = |column: usize| match cells[column].parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(format!(
                "line {}: `{}` of `{}` is no number",
                at + 1,
                cells[column],
                names[column]
            )),
        };
        let time = number(0)?;
        let row = columns.iter().map(|&column| number(column)).collect::<Result<_, _>>()?;
        // The first of two rows at one time, on both sides of a jump, holds for no time.
        if times.last() == Some(&time) {
            if twice == Some(time) {
                return Err(format!(
                    "line {}: a third row at t = {time}; a jump has two sides",
                    at + 1
                ));
            }
            twice = Some(time);
            times.pop();
            rows.pop();
        }
        times.push(time);
        rows.push(row);
    }
    Ok(Replay::of_rows(times, rows))
}

/// The column of each control. States and reports may stand beside them, as in the `.csv` of a
/// solve.
fn columns(names: &[&str], model: &Model) -> Result<Vec<usize>, String> {
    let (called, model) = (model.name(), model.meaning());
    let controls = || model.controls.iter().map(|control| control.place.name.as_str());
    if names[0] != "t" {
        let example = std::iter::once("t").chain(controls()).collect::<Vec<_>>().join(",");
        return Err(format!(
            "the first column is `{}`, but must be `t`; the first line looks like `{example}`",
            names[0]
        ));
    }
    let others = model
        .states
        .iter()
        .map(|state| &state.place)
        .chain(model.report.iter().map(|it| &it.place));
    let others: Vec<&str> = others.map(|place| place.name.as_str()).collect();
    for (at, name) in names.iter().enumerate().skip(1) {
        if names[..at].contains(name) {
            return Err(format!("there are two columns `{name}`"));
        }
        if !controls().any(|control| control == *name) && !others.contains(name) {
            let known = controls().collect::<Vec<_>>().join(", ");
            return Err(format!("`{name}` is no control of the model `{called}` ({known})"));
        }
    }
    controls()
        .map(|control| {
            let column = names.iter().position(|name| *name == control);
            column.ok_or_else(|| format!("there is no column for the control `{control}`"))
        })
        .collect()
}
