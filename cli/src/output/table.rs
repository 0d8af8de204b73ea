//! The rows of a sweep: as a table for people, and as compact JSON.

use super::document::{Document, Seconds};
use super::named::Named;
use super::number::aligned;
use super::optimality::Optimality;
use super::verified::Verification;
use comfy_table::{CellAlignment, Table, presets};
use serde::Serialize;

/// One row as JSON.
#[derive(Serialize)]
pub struct Row<'d> {
    /// What was swept: numbers in SI units, or words.
    swept: Named<Value<'d>>,
    status: &'d str,
    objective: f64,
    free: &'d Named<f64>,
    iterations: usize,
    kkt_error: f64,
    constraint_violation: f64,
    seconds: Seconds,
    /// Whether the replay confirms it and nothing contradicts that it is an optimum; only where
    /// that was asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    confirmed: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    verification: Option<&'d Verification>,
    #[serde(skip_serializing_if = "Option::is_none")]
    optimality: Option<&'d Optimality>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Value<'d> {
    Whole(u64),
    Number(f64),
    Word(&'d str),
}

/// The compact form of a solve, with what the replay says where confirmation was asked.
pub fn row<'d>(swept: &'d Named<String>, document: &'d Document, confirmed: bool) -> Row<'d> {
    Row {
        swept: swept.0.iter().map(|(name, text)| (name.clone(), value(text))).collect(),
        status: &document.status,
        objective: document.objective,
        free: &document.free,
        iterations: document.iterations,
        kkt_error: document.kkt_error,
        constraint_violation: document.constraint_violation,
        seconds: document.seconds,
        confirmed: confirmed.then(|| document.is_confirmed()),
        verification: document.verification.as_ref().filter(|_| confirmed),
        optimality: document.optimality.as_ref().filter(|_| confirmed),
    }
}

fn value(text: &str) -> Value<'_> {
    match (text.parse(), fdcc_compiler::parse_quantity(text)) {
        (Ok(whole), _) => Value::Whole(whole),
        (_, Ok(quantity)) => Value::Number(quantity.value),
        _ => Value::Word(text),
    }
}

/// As many digits as Table 7.1 of the paper has.
const DIGITS: usize = 7;

/// The table: what was swept, then what came out.
pub fn table<'d>(
    rows: impl Iterator<Item = (&'d Named<String>, &'d Document)>,
    confirmed: bool,
) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    for (swept, document) in rows {
        let names = swept.0.iter().map(|(name, _)| name.as_str());
        let found =
            ["objective"].into_iter().chain(document.free.0.iter().map(|(name, _)| name.as_str()));
        let found = found.map(|name| document.units.title(name));
        let results =
            ["iterations", "seconds", "status"].into_iter().chain(confirmed.then_some("confirmed"));
        table.set_header(names.map(str::to_string).chain(found).chain(results.map(str::to_string)));
        let confirmed = confirmed.then(|| answer(document).to_string());
        table.add_row(cells(swept, document).into_iter().chain(confirmed));
    }
    let last = table.column_count().saturating_sub(1 + usize::from(confirmed));
    table
        .column_iter_mut()
        .take(last)
        .for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    let lines = table.lines().map(|line| line.trim_end().to_string() + "\n");
    lines.collect()
}

/// Whether a row is confirmed, and why not.
fn answer(document: &Document) -> &'static str {
    match (&document.verification, &document.optimality) {
        (None, _) => "no: not replayed",
        (Some(it), _) if !it.confirmed => "NO: the true system differs",
        (_, Some(it)) if it.contradicted => "NO: contradicted as an optimum",
        _ => "yes",
    }
}

fn cells(swept: &Named<String>, document: &Document) -> Vec<String> {
    let values = swept.0.iter().map(|(_, value)| value.clone());
    let free = document
        .free
        .0
        .iter()
        .map(|(name, value)| aligned(document.units.scaled(name, *value), DIGITS));
    let rest = [
        document.iterations.to_string(),
        format!("{:.3}", document.seconds.total),
        document.status.replace('_', " "),
    ];
    values.chain([aligned(document.objective, DIGITS)]).chain(free).chain(rest).collect()
}
