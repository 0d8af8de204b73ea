//! The files of a solution.

use crate::failure::Failure;
use crate::output::document::Document;
use crate::output::{csv, files, json};
use crate::page;
use std::path::Path;

/// Writes `NAME.sol.json`, `NAME.csv` (one for each phase, if there are any) and `NAME.html` to a
/// folder, which is made if need be; returns their paths.
pub fn write(document: &Document, folder: &Path, name: &str) -> Result<Vec<String>, Failure> {
    let solution = json(document);
    let page = page::of(&solution);
    let mut all = vec![("sol.json".to_owned(), solution)];
    all.extend(tables(document));
    all.push(("html".to_owned(), page));
    let all: Vec<(&str, String)> =
        all.iter().map(|(ending, text)| (ending.as_str(), text.clone())).collect();
    files::write_all(folder, name, &all)
}

/// `NAME.csv`, or `NAME.PHASE.csv` for each phase.
fn tables(document: &Document) -> Vec<(String, String)> {
    if document.phases.is_empty() {
        return vec![("csv".into(), csv::csv(document))];
    }
    let phases = document.phases.0.iter();
    phases.map(|(name, phase)| (format!("{name}.csv"), csv::csv(&phase.0))).collect()
}
