//! A solution as a table: one row per grid point; controls hold from their row to the next.

use super::document::Document;
use std::fmt::Write;

/// The text of `MODEL.csv`. Controls repeat their last value in the last row.
pub fn csv(document: &Document) -> String {
    let columns = document.states.0.iter().chain(&document.controls.0).chain(&document.report.0);
    let columns: Vec<_> = columns.collect();
    let mut text = String::from("t");
    for (name, _) in &columns {
        text.push(',');
        text.push_str(name);
    }
    text.push('\n');
    for (k, t) in document.time.iter().enumerate() {
        write!(text, "{t}").expect("a string takes everything");
        for (_, column) in &columns {
            let value = column.get(k).or(column.last()).copied().unwrap_or(f64::NAN);
            write!(text, ",{value}").expect("a string takes everything");
        }
        text.push('\n');
    }
    text
}
