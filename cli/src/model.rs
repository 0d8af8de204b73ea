//! Model files: read, unless that takes too long, and checked by the library.

use crate::watch::Deadline;
use fdcc::{Checked, DataFiles};
use fdcc_grammar::{Diagnostic, SourceFile};
use fdcc_runtime::nlp::Stop;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// More is not even read; the parser complains about far less.
const MOST_BYTES: u64 = 64 << 20;

/// Reads and checks a file, unless it takes too long; `-` is the standard input. Data files are
/// those in a folder, or beside the model.
pub fn check(
    path: &str,
    data: Option<&Path>,
    deadline: Deadline,
) -> Result<io::Result<Checked>, Stop> {
    let path = path.to_owned();
    let files = data.map_or_else(|| DataFiles::beside(&path), DataFiles::in_folder);
    deadline.within(move || Ok(fdcc::check_with(name(&path), bytes(&path)?, Some(files))))
}

/// The text of a file, and what is wrong if it is none.
pub fn read(path: &str) -> io::Result<(SourceFile, Option<Diagnostic>)> {
    Ok(fdcc::text(name(path), bytes(path)?))
}

fn name(path: &str) -> &str {
    if path == "-" { "<stdin>" } else { path }
}

fn bytes(path: &str) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    match path {
        "-" => io::stdin().take(MOST_BYTES).read_to_end(&mut bytes)?,
        _ => File::open(path)?.take(MOST_BYTES).read_to_end(&mut bytes)?,
    };
    Ok(bytes)
}
