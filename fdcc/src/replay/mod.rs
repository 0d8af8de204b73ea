//! What a simulation takes over: controls over time, and of a solution also its parameters,
//! unknowns, starts and method.

pub(crate) mod polynomials;
mod tuning;

use crate::record::{Record, Settings, find};
use fdcc_compiler::Model;
use fdcc_compiler::kernels;
use fdcc_runtime::problem::{ControlShape, Grid, Order, Scheme};
use fdcc_runtime::simulate::Controls;
use polynomials::polynomials;
use tuning::SLACK;

/// Controls over time; parameters, unknowns, start values and method of a solution.
///
/// ```
/// use fdcc::{Accuracy, Model, Options, Replay};
///
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// let model = Model::from_text("hop", text)?;
/// let solution = model.solve(&Options::default())?;
/// let replay = Replay::new(&solution.record(), model.meaning()).map_err(fdcc::Error::Record)?;
/// let simulation = model.simulate(&replay.controls, &Accuracy::default())?;
/// assert!((simulation.result.end[0] - 0.5).abs() < 1e-6);
/// # Ok::<(), fdcc::Error>(())
/// ```
#[derive(Default)]
pub struct Replay {
    /// Over time, with a segment for each interval of a solution; the times of a solution stretch
    /// with those of the model.
    pub controls: Controls,
    params: Vec<(String, f64)>,
    free: Vec<(String, f64)>,
    start: Vec<(String, f64)>,
    method: Restored,
}

/// The settings of the solution.
#[derive(Default)]
struct Restored {
    scheme: Option<Scheme>,
    controls: Option<ControlShape>,
    intervals: Option<usize>,
    sigma: Option<f64>,
    kernel: Option<&'static str>,
}

impl Replay {
    /// What a solution says, if it is one of this model.
    ///
    /// # Errors
    ///
    /// A control that is missing, or times that do not ascend, in words.
    pub fn new(record: &Record, model: &Model) -> Result<Replay, String> {
        if record.time.iter().any(|time| !time.is_finite()) {
            return Err("a time is no number".into());
        }
        ascend(record.time)?;
        let names: Vec<&str> =
            model.controls.iter().map(|control| control.place.name.as_str()).collect();
        let controls = match &record.nodes {
            Some(nodes) => polynomials(record, nodes, &names)?,
            None => held(record, &names)?,
        };
        let starts = record.states.iter();
        let starts: Vec<(&str, f64)> =
            starts.filter_map(|(name, column)| Some((*name, *column.first()?))).collect();
        Ok(Replay {
            controls,
            params: numbers(&record.params),
            free: numbers(&record.free),
            start: numbers(&starts),
            method: Restored::new(&record.settings),
        })
    }

    /// Controls alone, each row of which holds from its time on; the times stand still.
    pub fn of_rows(times: Vec<f64>, rows: Vec<Vec<f64>>) -> Replay {
        let controls = Controls::Held { times, rows, is_stretched: false };
        Replay { controls, ..Replay::default() }
    }

    /// Whether the controls can be followed.
    ///
    /// # Errors
    ///
    /// Why they cannot, in words.
    pub fn check(&self) -> Result<(), String> {
        if self.controls.begins().is_empty() {
            return Err("there is no row of values".into());
        }
        ascend(self.controls.begins())
    }

    /// Gives the model the parameters, unknowns and method of the solution, and the start of states
    /// that the model leaves open.
    pub fn adapt(&self, model: &mut Model) {
        model.restore_params(&self.params);
        self.free.iter().for_each(|(name, value)| model.set_free(name, *value));
        self.start.iter().for_each(|(name, value)| model.set_open_start(name, *value));
        self.method.adapt(model);
    }

    /// What about the times is likely a slip, though it can be followed.
    pub fn doubts(&self, [first, last]: [f64; 2]) -> Option<String> {
        let slack = SLACK * (last - first);
        let times = self.controls.begins();
        let begin = *times.first()?;
        let unused = times.iter().filter(|time| **time > last + slack).count();
        if unused > 0 {
            let begin = if unused == 1 { "row begins" } else { "rows begin" };
            return Some(format!("{unused} {begin} after the last time, {last}: not used"));
        }
        let is_late = begin > first + slack;
        is_late.then(|| format!("the first row begins at {begin}: used from {first} on"))
    }
}

impl Restored {
    /// What is not known is no reason to refuse the controls.
    fn new(settings: &Settings) -> Self {
        let is_width = |sigma: &f64| *sigma > 0.0 && sigma.is_finite();
        Restored {
            scheme: settings.scheme,
            controls: settings.controls,
            intervals: settings.intervals.filter(|count| *count > 0),
            sigma: settings.sigma.filter(is_width),
            kernel: settings.kernel.and_then(kernels::find).map(|it| it.name),
        }
    }

    fn adapt(&self, model: &mut Model) {
        let method = &mut model.method;
        if let Some(scheme) = self.scheme {
            (method.scheme, method.order) = (scheme, Order::Fixed);
        }
        method.controls = self.controls.unwrap_or(method.controls);
        if let Some(intervals) = self.intervals {
            method.grid = Grid::Uniform(intervals);
        }
        method.sigma = self.sigma.or(method.sigma);
        if let Some(kernel) = self.kernel {
            method.kernel = kernel.into();
        }
        method.begin();
        model.smooth |= self.sigma.is_some() || self.kernel.is_some();
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
fn held(record: &Record, names: &[&str]) -> Result<Controls, String> {
    let times = record.time[..record.time.len().saturating_sub(1)].to_vec();
    let mut rows = vec![Vec::new(); times.len()];
    for name in names {
        let column = column(record, name, times.len())?;
        rows.iter_mut().zip(column).for_each(|(row, value)| row.push(*value));
    }
    Ok(Controls::Held { times, rows, is_stretched: true })
}

/// The values of a control, one for each interval.
fn column<'s>(record: &Record<'s>, name: &str, intervals: usize) -> Result<&'s [f64], String> {
    let column = find(&record.controls, name).ok_or(format!("there is no control `{name}`"))?;
    if column.len() != intervals {
        return Err(format!("`{name}` has {} values for {intervals} intervals", column.len()));
    }
    match column.iter().position(|value| !value.is_finite()) {
        Some(at) => Err(format!("value {} of `{name}` is no number", at + 1)),
        None => Ok(column),
    }
}

fn numbers(values: &[(&str, f64)]) -> Vec<(String, f64)> {
    let finite = values.iter().filter(|(_, value)| value.is_finite());
    finite.map(|(name, value)| (name.to_string(), *value)).collect()
}
