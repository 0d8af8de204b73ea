//! The rows of a sweep as JSON: in an array, and one on each line of a file.

use super::document::{Document, Seconds};
use super::named::Named;
use super::optimality::Optimality;
use super::sequence::{self, Sequence};
use super::verification::Verification;
use fdcc::language::parse_quantity;
use fdcc::names::is_solved;
use serde::{Deserialize, Serialize};

/// What came out of a row, in numbers and words.
#[derive(Clone, Serialize, Deserialize)]
pub struct Scalars {
    /// What was swept: numbers in SI units, or words.
    pub swept: Named<Value>,
    pub status: String,
    /// Nothing where it is not finite.
    pub objective: Option<f64>,
    pub free: Named<Option<f64>>,
    pub iterations: usize,
    pub kkt_error: Option<f64>,
    pub constraint_violation: Option<f64>,
    pub seconds: Seconds,
    /// Whether the replay confirms it and nothing contradicts that it is an optimum; only where
    /// that was asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub confirmed: Option<bool>,
    /// What follows what, where it is certified.
    #[serde(default = "Named::default", skip_serializing_if = "Named::is_empty")]
    pub sequence: Sequence,
}

/// A value that was swept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    Whole(u64),
    Number(f64),
    Word(String),
}

/// A row with what its replay says, where that was asked.
#[derive(Serialize)]
pub struct Row {
    #[serde(flatten)]
    pub scalars: Scalars,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub verification: Option<Verification>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub optimality: Option<Optimality>,
}

/// A row in a file of rows.
#[derive(Serialize, Deserialize)]
pub struct Line {
    /// Counted from 1.
    pub row: usize,
    /// How many there are in the whole sweep.
    pub rows: usize,
    /// Stands for the values of the row as they were given.
    pub key: String,
    #[serde(flatten)]
    pub scalars: Scalars,
}

/// How a sweep into a file ended.
#[derive(Serialize)]
pub struct Summary {
    pub rows: usize,
    /// How many of them had been solved before.
    pub before: usize,
    pub statuses: Named<usize>,
    /// Of this run.
    pub seconds: f64,
    pub file: String,
}

impl Row {
    /// Of a solve, with what the replay says where confirmation was asked.
    pub fn new(swept: &[(&str, &str)], document: &Document, confirmed: bool) -> Self {
        let finite = |value: f64| Some(value).filter(|it| it.is_finite());
        let free = document.free.0.iter().map(|(name, value)| (name.clone(), finite(*value)));
        // A plain number is in the declared unit of its parameter, which may be another than SI.
        let si = |name: &str, text: &str| match (value(text), document.params.get(name)) {
            (Value::Word(word), _) => Value::Word(word),
            (Value::Whole(it), Some(si)) if it as f64 == *si => Value::Whole(it),
            (_, Some(si)) => Value::Number(*si),
            (given, None) => given,
        };
        let scalars = Scalars {
            swept: swept.iter().map(|(name, it)| ((*name).to_owned(), si(name, it))).collect(),
            status: document.status.clone(),
            objective: finite(document.objective),
            free: free.collect(),
            iterations: document.iterations,
            kkt_error: finite(document.kkt_error),
            constraint_violation: finite(document.constraint_violation),
            seconds: document.seconds,
            confirmed: confirmed.then(|| document.is_confirmed()),
            sequence: sequence::of(document),
        };
        Row {
            scalars,
            verification: document.verification.clone().filter(|_| confirmed),
            optimality: document.optimality.clone().filter(|_| confirmed),
        }
    }
}

fn value(text: &str) -> Value {
    match (text.parse(), parse_quantity(text)) {
        (Ok(whole), _) => Value::Whole(whole),
        (_, Ok(quantity)) => Value::Number(quantity.value),
        _ => Value::Word(text.to_owned()),
    }
}

impl Scalars {
    /// Whether it can be used, and is confirmed if that was asked.
    pub fn is_fine(&self) -> bool {
        is_solved(&self.status) && self.confirmed != Some(false)
    }
}

impl Line {
    /// The line with its end.
    pub fn text(&self) -> String {
        serde_json::to_string(self).expect("our own types have text keys only") + "\n"
    }

    /// Reads a line.
    pub fn read(text: &[u8]) -> Option<Self> {
        serde_json::from_slice(text).ok()
    }
}

/// The values of a case that is a JSON object, each as somebody would write it in the language.
///
/// # Errors
///
/// A text that is no object of numbers and words, in words.
pub fn case(line: &str) -> Result<Vec<(String, String)>, String> {
    let object: Named<serde_json::Value> =
        serde_json::from_str(line).map_err(|error| format!("this is no JSON object: {error}"))?;
    let value = |(name, value): (String, serde_json::Value)| match value {
        serde_json::Value::Number(number) => Ok((name, number.to_string())),
        serde_json::Value::String(word) => Ok((name, word)),
        _ => Err(format!("`{name}` needs a number or a text")),
    };
    object.0.into_iter().map(value).collect()
}
