//! A solution as a table: one row per grid point; controls hold from their row to the next. A jump
//! has two rows, before it and after it.

use super::document::Document;
use super::named::Named;
use std::fmt::Write;

/// The text of `MODEL.csv`. Controls repeat their last value in the last row; reports have no
/// value just before a jump.
pub fn csv(document: &Document) -> String {
    let Document { states, controls, report, .. } = document;
    let names = [states, controls, report]
        .into_iter()
        .flat_map(|columns| &columns.0)
        .map(|column| column.0.as_str());
    let mut text = std::iter::once("t").chain(names).collect::<Vec<_>>().join(",") + "\n";
    let cell = |value: f64| format!(",{value}");
    let cells = |columns: &Named<Vec<f64>>, k: usize| -> String {
        let at = |column: &Vec<f64>| column.get(k).or(column.last()).copied().unwrap_or(f64::NAN);
        columns.0.iter().map(|(_, column)| cell(at(column))).collect()
    };
    for (k, t) in document.time.iter().enumerate() {
        for before in document.befores(k) {
            let states = states
                .0
                .iter()
                .map(|(name, _)| cell(before.get(name).copied().unwrap_or(f64::NAN)));
            let (states, gaps) = (states.collect::<String>(), ",".repeat(report.0.len()));
            writeln!(text, "{t}{states}{}{gaps}", cells(controls, k.saturating_sub(1)))
                .expect("a string takes everything");
        }
        writeln!(text, "{t}{}{}{}", cells(states, k), cells(controls, k), cells(report, k))
            .expect("a string takes everything");
    }
    text
}
