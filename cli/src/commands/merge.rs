//! `fdcc merge`: the rows of all parts of a sweep as one table.

use crate::exit::Exit;
use crate::failure::Failure;
use crate::output;
use crate::sweep::merge::Merged;
use clap::Args;
use fdcc_grammar::SourceFile;
use std::path::PathBuf;

/// Make one CSV table of the rows that `fdcc sweep --out` wrote
///
/// A line for each row, in their order, with what was swept and what came out, in SI units; the
/// same bytes however the rows were divided among processes. Rows that are missing are told, with
/// exit code 2.
#[derive(Args)]
pub struct Merge {
    /// Folders with files of rows, or these files
    #[arg(value_name = "DIR", required = true)]
    paths: Vec<PathBuf>,
}

impl Merge {
    /// Prints the table.
    pub fn run(self) -> Exit {
        let exit = self.merge();
        exit.unwrap_or_else(|failure| failure.report(&SourceFile::new("merge", "")))
    }

    fn merge(&self) -> Result<Exit, Failure> {
        let merged = Merged::new(&self.paths)?;
        merged.write(&mut |line| output::print(line))?;
        Ok(match merged.missing() {
            None => Exit::Fine,
            Some((many, first)) => {
                let rows = merged.rows();
                output::complain(&format!("{many} of {rows} rows are missing, first row {first}"));
                Exit::NotSolved
            }
        })
    }
}
