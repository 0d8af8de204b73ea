//! The rows of a sweep: as a table for people, and as compact JSON.

use super::document::{Document, Seconds};
use super::named::Named;
use super::number::aligned;
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
}

#[derive(Serialize)]
#[serde(untagged)]
enum Value<'d> {
    Whole(u64),
    Number(f64),
    Word(&'d str),
}

/// The compact form of a solve.
pub fn row<'d>(swept: &'d Named<String>, document: &'d Document) -> Row<'d> {
    Row {
        swept: swept.0.iter().map(|(name, text)| (name.clone(), value(text))).collect(),
        status: &document.status,
        objective: document.objective,
        free: &document.free,
        iterations: document.iterations,
        kkt_error: document.kkt_error,
        constraint_violation: document.constraint_violation,
        seconds: document.seconds,
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
pub fn table<'d>(rows: impl Iterator<Item = (&'d Named<String>, &'d Document)>) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    for (swept, document) in rows {
        let names = swept.0.iter().map(|(name, _)| name.as_str());
        let found = ["objective"].into_iter().chain(document.free.0.iter().map(|(name, _)| name.as_str()));
        let found = found.map(|name| document.units.title(name));
        let results = ["iterations", "seconds", "status"];
        table.set_header(names.map(str::to_string).chain(found).chain(results.map(str::to_string)));
        table.add_row(cells(swept, document));
    }
    let last = table.column_count().saturating_sub(1);
    table.column_iter_mut().take(last).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    let lines = table.lines().map(|line| line.trim_end().to_string() + "\n");
    lines.collect()
}

fn cells(swept: &Named<String>, document: &Document) -> Vec<String> {
    let values = swept.0.iter().map(|(_, value)| value.clone());
    let free =
        document.free.0.iter().map(|(name, value)| aligned(document.units.scaled(name, *value), DIGITS));
    let rest = [
        document.iterations.to_string(),
        format!("{:.3}", document.seconds.total),
        document.status.replace('_', " "),
    ];
    values.chain([aligned(document.objective, DIGITS)]).chain(free).chain(rest).collect()
}
