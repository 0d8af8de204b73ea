//! What is read of a `.sol.json`: to start from it, to replay it, to verify it.

use super::document::{ControlNodes, Document, MethodUsed};
use super::named::Named;
use super::tried::Happened;
use crate::solver::Failure;
use serde::Deserialize;
use std::fs;
use std::path::Path;

/// A solution as its file has it. A number that was not finite is `null` there.
#[derive(Deserialize)]
pub struct Saved {
    #[serde(default)]
    pub model: String,
    #[serde(default)]
    pub source_sha256: String,
    #[serde(default)]
    pub objective: Option<f64>,
    pub free: Named<Option<f64>>,
    #[serde(default)]
    pub params: Named<Option<f64>>,
    #[serde(default)]
    pub method: SavedMethod,
    #[serde(default)]
    pub time: Vec<Option<f64>>,
    pub states: Named<Column>,
    pub controls: Named<Column>,
    #[serde(default)]
    pub control_nodes: Option<SavedNodes>,
    #[serde(default)]
    pub jumps: Vec<SavedJump>,
}

/// A jump of a solution.
#[derive(Deserialize)]
pub struct SavedJump {
    pub jump: String,
    pub time: Option<f64>,
    /// All states before it.
    #[serde(default)]
    pub before: Named<Option<f64>>,
}

/// What defines controls that are not constant on each interval.
#[derive(Deserialize)]
pub struct SavedNodes {
    pub time: Column,
    pub values: Named<Column>,
}

/// A signal over time.
pub type Column = Vec<Option<f64>>;

/// How it was solved; nothing where the file does not say.
#[derive(Default, Deserialize)]
pub struct SavedMethod {
    pub scheme: Option<String>,
    pub controls: Option<String>,
    #[serde(rename = "N")]
    pub n: Option<u64>,
    pub sigma: Option<f64>,
    /// The smoothing width of each surface.
    #[serde(default)]
    pub sigmas: Named<Option<f64>>,
    /// Whether these were chosen by a solve that came to its end.
    #[serde(default)]
    pub sigma_chosen: bool,
    pub kernel: Option<String>,
}

impl Saved {
    /// Reads a `.sol.json`.
    pub fn read(path: &Path) -> Result<Saved, Failure> {
        let failure = |what: String| Failure::File(format!("{}{what}", path.display()));
        let text = fs::read_to_string(path)
            .map_err(|error| failure(format!(" cannot be read: {error}")))?;
        serde_json::from_str(&text).map_err(|error| failure(format!(" is not a solution: {error}")))
    }
}

impl From<&Document> for Saved {
    fn from(document: &Document) -> Self {
        let MethodUsed { scheme, controls, n, sigma, sigmas, sigma_chosen, kernel, .. } =
            document.method.clone();
        let (scheme, controls, kernel) = (Some(scheme), Some(controls), Some(kernel));
        Saved {
            model: document.model.clone(),
            source_sha256: document.source_sha256.clone(),
            objective: finite(document.objective),
            free: numbers(&document.free),
            params: numbers(&document.params),
            method: SavedMethod {
                scheme,
                controls,
                n: Some(n as u64),
                sigma,
                sigmas: numbers(&sigmas),
                sigma_chosen,
                kernel,
            },
            time: document.time.iter().copied().map(finite).collect(),
            states: columns(&document.states),
            controls: columns(&document.controls),
            control_nodes: document.control_nodes.as_ref().map(saved_nodes),
            jumps: document.jumps.iter().map(saved_jump).collect(),
        }
    }
}

fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

fn numbers(of: &Named<f64>) -> Named<Option<f64>> {
    of.0.iter().map(|(name, value)| (name.clone(), finite(*value))).collect()
}

fn saved_jump(it: &Happened) -> SavedJump {
    SavedJump { jump: it.jump.clone(), time: finite(it.time), before: numbers(&it.before) }
}

fn saved_nodes(nodes: &ControlNodes) -> SavedNodes {
    SavedNodes {
        time: nodes.time.iter().copied().map(finite).collect(),
        values: columns(&nodes.values),
    }
}

fn columns(of: &Named<Vec<f64>>) -> Named<Column> {
    of.0.iter()
        .map(|(name, column)| (name.clone(), column.iter().copied().map(finite).collect()))
        .collect()
}
