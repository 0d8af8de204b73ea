//! What is read of a `.sol.json`: to start from it, to replay it, to verify it.

use super::named::Named;
use super::whole::{Signals, Twice};
use crate::failure::Failure;
use crate::input;
use fdcc::Record;
use fdcc::record::{JumpRecord, NodesRecord, Settings};
use fdcc_runtime::problem::{ControlShape, Scheme};
use serde::{Deserialize, Deserializer};
use std::path::Path;

/// A solution as its file has it. A number that was not finite is `null` there, and NaN here.
#[derive(Deserialize)]
pub struct Saved {
    #[serde(default)]
    pub model: String,
    #[serde(default)]
    pub source_sha256: String,
    #[serde(default)]
    objective: Number,
    free: Named<Number>,
    #[serde(default)]
    params: Named<Number>,
    #[serde(default)]
    method: SavedMethod,
    #[serde(default)]
    time: Column,
    states: Named<Column>,
    controls: Named<Column>,
    #[serde(default)]
    control_nodes: Option<SavedNodes>,
    #[serde(default)]
    jumps: Vec<SavedJump>,
    #[serde(default)]
    phases: Named<SavedPhase>,
}

/// A phase of a solution.
#[derive(Deserialize)]
struct SavedPhase {
    #[serde(flatten)]
    method: SavedMethod,
    time: Column,
    states: Named<Column>,
    controls: Named<Column>,
    #[serde(default)]
    control_nodes: Option<SavedNodes>,
    #[serde(default)]
    jumps: Vec<SavedJump>,
}

/// A jump of a solution.
#[derive(Deserialize)]
struct SavedJump {
    jump: String,
    #[serde(default)]
    time: Number,
    /// All states before it.
    #[serde(default)]
    before: Named<Number>,
}

/// What defines controls that are not constant on each interval.
#[derive(Deserialize)]
struct SavedNodes {
    time: Column,
    values: Named<Column>,
}

/// How it was solved; nothing where the file does not say.
#[derive(Default, Deserialize)]
struct SavedMethod {
    scheme: Option<String>,
    controls: Option<String>,
    #[serde(rename = "N")]
    n: Option<u64>,
    sigma: Option<f64>,
    /// The smoothing width of each surface.
    #[serde(default)]
    sigmas: Named<Number>,
    /// Whether these were chosen by a solve that came to its end.
    #[serde(default)]
    sigma_chosen: bool,
    kernel: Option<String>,
}

/// NaN where the file has `null`.
#[derive(Clone, Copy)]
struct Number(f64);

impl Default for Number {
    fn default() -> Self {
        Number(f64::NAN)
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let number = Option::<f64>::deserialize(deserializer)?;
        Ok(number.map_or_else(Number::default, Number))
    }
}

/// A signal over time.
#[derive(Default)]
struct Column(Vec<f64>);

impl<'de> Deserialize<'de> for Column {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let numbers = Vec::<Number>::deserialize(deserializer)?;
        Ok(Column(numbers.into_iter().map(|it| it.0).collect()))
    }
}

impl Saved {
    /// Reads a `.sol.json`. One in which a signal, a parameter or an unknown has no number, or a
    /// signal not as many values as there are times, is refused.
    pub fn read(path: &Path) -> Result<Saved, Failure> {
        let failure = |what: String| Failure::File(format!("{}{what}", path.display()));
        let text =
            input::text(path).map_err(|error| failure(format!(" cannot be read: {error}")))?;
        let saved: Saved = serde_json::from_str(&text)
            .map_err(|error| failure(format!(" is not a solution: {error}")))?;
        saved.check().map_err(|what| failure(format!(": {what}")))?;
        Ok(saved)
    }

    /// Whether everything has the numbers that a replay or a start takes over; says what has not.
    fn check(&self) -> Result<(), String> {
        are_numbers("free", &self.free)?;
        are_numbers("params", &self.params)?;
        signals(String::new(), twice(&self.jumps), (&self.time, &self.states, &self.controls))
            .check()?;
        for (name, phase) in &self.phases.0 {
            let own = (&phase.time, &phase.states, &phase.controls);
            signals(format!("phases.{name}."), Twice::Any, own).check()?;
            are_states(&format!("phases.{name}."), &phase.jumps)?;
        }
        are_states("", &self.jumps)
    }

    /// Nothing if it is no number.
    pub fn objective(&self) -> Option<f64> {
        Some(self.objective.0).filter(|value| value.is_finite())
    }

    /// The parameters.
    pub fn params(&self) -> Vec<(String, f64)> {
        self.params.0.iter().map(|(name, value)| (name.clone(), value.0)).collect()
    }

    /// As the library takes it.
    pub fn record(&self) -> Record<'_> {
        Record {
            model: &self.model,
            free: numbers(&self.free),
            params: numbers(&self.params),
            settings: self.method.settings(),
            time: &self.time.0,
            states: columns(&self.states),
            controls: columns(&self.controls),
            nodes: self
                .control_nodes
                .as_ref()
                .map(|nodes| NodesRecord { time: &nodes.time.0, values: columns(&nodes.values) }),
            jumps: self.jumps.iter().map(jump).collect(),
            phases: self.phases.0.iter().map(|(name, phase)| self.phase(name, phase)).collect(),
        }
    }

    fn phase<'s>(&'s self, name: &'s str, of: &'s SavedPhase) -> Record<'s> {
        let nodes = of.control_nodes.as_ref();
        Record {
            model: name,
            free: numbers(&self.free),
            params: numbers(&self.params),
            settings: Settings {
                sigma_chosen: self.method.sigma_chosen,
                kernel: self.method.kernel.as_deref(),
                ..of.method.settings()
            },
            time: &of.time.0,
            states: columns(&of.states),
            controls: columns(&of.controls),
            nodes: nodes.map(|it| NodesRecord { time: &it.time.0, values: columns(&it.values) }),
            jumps: of.jumps.iter().map(jump).collect(),
            phases: Vec::new(),
        }
    }
}

impl SavedMethod {
    /// A scheme that is not known here is no reason to refuse the file.
    fn settings(&self) -> Settings<'_> {
        Settings {
            scheme: self.scheme.as_deref().and_then(Scheme::named),
            controls: self.controls.as_deref().and_then(ControlShape::named),
            intervals: self.n.map(|n| n as usize),
            sigma: self.sigma,
            sigmas: numbers(&self.sigmas),
            sigma_chosen: self.sigma_chosen,
            kernel: self.kernel.as_deref(),
        }
    }
}

fn are_numbers(field: &str, of: &Named<Number>) -> Result<(), String> {
    match of.0.iter().find(|(_, value)| !value.0.is_finite()) {
        Some((name, _)) => Err(format!("`{field}.{name}` is no number")),
        None => Ok(()),
    }
}

/// Those before jumps.
fn are_states(prefix: &str, jumps: &[SavedJump]) -> Result<(), String> {
    let state = |(at, jump): (usize, &SavedJump)| {
        are_numbers(&format!("{prefix}jumps[{at}].before"), &jump.before)
    };
    jumps.iter().enumerate().try_for_each(state)
}

/// A time may stand twice where something jumps.
fn twice(jumps: &[SavedJump]) -> Twice {
    Twice::At(jumps.iter().map(|jump| jump.time.0).collect())
}

fn signals<'s>(
    prefix: String,
    twice: Twice,
    (time, states, controls): (&'s Column, &'s Named<Column>, &'s Named<Column>),
) -> Signals<'s> {
    let (states, controls) = (columns(states), columns(controls));
    Signals { prefix, time: &time.0, twice, states, controls }
}

fn jump(it: &SavedJump) -> JumpRecord<'_> {
    JumpRecord { jump: &it.jump, time: it.time.0, before: numbers(&it.before) }
}

fn numbers(of: &Named<Number>) -> Vec<(&str, f64)> {
    of.0.iter().map(|(name, value)| (name.as_str(), value.0)).collect()
}

fn columns(of: &Named<Column>) -> Vec<(&str, &[f64])> {
    of.0.iter().map(|(name, column)| (name.as_str(), column.0.as_slice())).collect()
}
