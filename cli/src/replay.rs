//! What a simulation takes over from a file: controls over time, and of a solution also its
//! parameters, unknowns, starts and method.

use crate::output::named::Named;
use crate::output::saved::{Column, Saved, SavedMethod};
use crate::pieces::{Pieces, pieces};
use crate::solver::sha256;
use fdcc_compiler::Model;
use fdcc_runtime::simulate::Controls;

/// Controls over time; parameters, unknowns, start values and method of a solution.
#[derive(Default)]
pub struct Replay {
    /// When each row begins.
    pub times: Vec<f64>,
    /// One row of controls for each time.
    pub rows: Vec<Vec<f64>>,
    params: Vec<(String, f64)>,
    free: Vec<(String, f64)>,
    start: Vec<(String, f64)>,
    method: Vec<(&'static str, String)>,
    source_sha256: String,
}

impl Replay {
    /// What a solution says, if it is one of this model.
    pub fn new(saved: &Saved, model: &Model) -> Result<Replay, String> {
        let times: Option<Vec<f64>> = saved.time.iter().copied().collect();
        let times = times.ok_or("a time is no number")?;
        ascend(&times)?;
        let names: Vec<&str> =
            model.controls.iter().map(|control| control.place.name.as_str()).collect();
        let Pieces { times, rows } = match &saved.control_nodes {
            Some(nodes) => pieces(saved, nodes, &times, &names)?,
            None => rows(saved, times, &names)?,
        };
        let first = |(name, column): &(String, Column)| Some((name.clone(), (*column.first()?)?));
        Ok(Replay {
            times,
            rows,
            params: numbers(&saved.params),
            free: numbers(&saved.free),
            start: saved.states.0.iter().filter_map(first).collect(),
            method: settings(&saved.method),
            source_sha256: saved.source_sha256.clone(),
        })
    }

    /// Whether the controls can be followed.
    pub fn check(&self) -> Result<(), String> {
        if self.times.is_empty() {
            return Err("there is no row of values".into());
        }
        ascend(&self.times)
    }

    /// Whether it is the solution of another text than this; a table is of none.
    pub fn is_of_another(&self, text: &str) -> bool {
        !self.source_sha256.is_empty() && self.source_sha256 != sha256(text)
    }

    /// Gives the model the parameters, unknowns and method of the solution, and the start of states
    /// that the model leaves open.
    pub fn adapt(&self, model: &mut Model) {
        model.restore_params(&self.params);
        self.free.iter().for_each(|(name, value)| model.set_free(name, *value));
        self.start.iter().for_each(|(name, value)| model.set_open_start(name, *value));
        // A scheme that is not known here is no reason to refuse the controls.
        self.method.iter().for_each(|(key, value)| drop(model.restore_method(key, value)));
    }

    /// What about the times is likely a slip, though it can be followed.
    pub fn doubts(&self, [first, last]: [f64; 2]) -> Option<String> {
        let slack = 1e-9 * (last - first);
        let begin = *self.times.first()?;
        let unused = self.times.iter().filter(|time| **time > last + slack).count();
        if unused > 0 {
            let begin = if unused == 1 { "row begins" } else { "rows begin" };
            return Some(format!("{unused} {begin} after the last time, {last}: not used"));
        }
        let is_late = begin > first + slack;
        is_late.then(|| format!("the first row begins at {begin}: used from {first} on"))
    }

    /// The controls, if a file was given.
    pub fn held(self) -> Option<Controls> {
        let is_stretched = !self.source_sha256.is_empty();
        (!self.times.is_empty()).then_some(Controls::Held {
            times: self.times,
            rows: self.rows,
            is_stretched,
        })
    }
}

fn ascend(times: &[f64]) -> Result<(), String> {
    let found = times.windows(2).position(|pair| pair[0] >= pair[1]);
    found.map_or(Ok(()), |at| {
        Err(format!(
            "times must ascend, but {} follows {} in row {}",
            times[at + 1],
            times[at],
            at + 2
        ))
    })
}

/// One row for each interval.
fn rows(saved: &Saved, mut times: Vec<f64>, names: &[&str]) -> Result<Pieces, String> {
    times.pop();
    let mut rows = vec![Vec::new(); times.len()];
    for name in names {
        let column = held(saved, name, times.len())?;
        rows.iter_mut().zip(column).for_each(|(row, value)| row.push(value));
    }
    Ok(Pieces { times, rows })
}

/// The values of a control, one for each interval.
fn held(saved: &Saved, name: &str, intervals: usize) -> Result<Vec<f64>, String> {
    let column = saved.controls.get(name).ok_or(format!("there is no control `{name}`"))?;
    if column.len() != intervals {
        return Err(format!("`{name}` has {} values for {intervals} intervals", column.len()));
    }
    let number = |(at, value): (usize, &Option<f64>)| {
        value.ok_or(format!("value {} of `{name}` is no number", at + 1))
    };
    column.iter().enumerate().map(number).collect()
}

/// As settings of the `method` block.
fn settings(method: &SavedMethod) -> Vec<(&'static str, String)> {
    let SavedMethod { scheme, controls, n, sigma, kernel, .. } = method;
    let (n, sigma) = (n.map(|n| n.to_string()), sigma.map(|sigma| sigma.to_string()));
    let words = [("scheme", scheme), ("controls", controls), ("kernel", kernel)];
    let words = words.map(|(key, word)| (key, word.clone()));
    let all = words.into_iter().chain([("N", n), ("sigma", sigma)]);
    all.filter_map(|(key, value)| Some((key, value?))).collect()
}

fn numbers(values: &Named<Option<f64>>) -> Vec<(String, f64)> {
    values.0.iter().filter_map(|(name, value)| Some((name.clone(), (*value)?))).collect()
}
