//! The three files of a solution.

use super::document::Document;
use super::{csv, html, json};
use crate::solver::Failure;
use std::fs;
use std::path::Path;

/// Writes `NAME.sol.json`, `NAME.csv` and `NAME.html` to a folder, which is made if need be; returns their paths.
pub fn write(document: &Document, folder: &Path, name: &str) -> Result<Vec<String>, Failure> {
    let files = [("sol.json", json(document)), ("csv", csv::csv(document)), ("html", html::html(document))];
    write_all(folder, name, &files)
}

/// Writes files `NAME.ENDING` to a folder, which is made if need be; returns their paths.
pub fn write_all(folder: &Path, name: &str, files: &[(&str, String)]) -> Result<Vec<String>, Failure> {
    let failure =
        |error: std::io::Error| Failure::File(format!("cannot write to {}: {error}", folder.display()));
    fs::create_dir_all(folder).map_err(failure)?;
    let mut paths = Vec::new();
    for (ending, text) in files {
        let path = folder.join(format!("{name}.{ending}"));
        fs::write(&path, text).map_err(failure)?;
        paths.push(path.display().to_string());
    }
    Ok(paths)
}
