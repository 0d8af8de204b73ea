//! `fdcc report`: the page of one solution, or of several side by side.

use crate::exit::Exit;
use crate::failure::Failure;
use crate::output::files;
use crate::output::{complain, print};
use crate::page::{self, json::Json};
use clap::Args;
use std::path::{Path, PathBuf};

/// A page tells so many curves apart.
const MOST: usize = 8;

/// Write a page of solutions, side by side
#[derive(Args)]
pub struct Report {
    /// The .sol.json of one or several solves, or documents of other runs, such as a .sim.json
    #[arg(value_name = "SOLUTION", required = true)]
    solutions: Vec<PathBuf>,
    /// Where the page is written
    #[arg(long, value_name = "FILE", default_value = "report.html")]
    out: PathBuf,
}

impl Report {
    /// Reads the solutions and writes the page.
    pub fn run(self) -> Exit {
        wrote(self.write(), &self.out)
    }

    fn write(&self) -> Result<(), Failure> {
        let count = self.solutions.len();
        if count > MOST {
            let message = format!("{count} solutions: a page has room for {MOST}");
            return Err(Failure::Usage(message));
        }
        let documents: Vec<Json> =
            self.solutions.iter().map(|path| Json::read(path)).collect::<Result<_, _>>()?;
        let names = names(&self.solutions);
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        files::write_file(&self.out, page::page(&documents, &names))
    }
}

/// Says which file was written, or why there is none.
pub fn wrote(written: Result<(), Failure>, path: &Path) -> Exit {
    match written {
        Ok(()) => {
            print(&format!(" wrote {}\n", path.display()));
            Exit::Fine
        }
        Err(failure) => failed(&failure),
    }
}

/// Says why there is no picture of a solution.
fn failed(failure: &Failure) -> Exit {
    let (Failure::Usage(message) | Failure::File(message)) = failure else {
        unreachable!("a picture needs no model")
    };
    complain(message);
    if matches!(failure, Failure::Usage(_)) { Exit::Usage } else { Exit::File }
}

/// The names of the files, or their whole paths where these are the same.
fn names(paths: &[PathBuf]) -> Vec<String> {
    let short = |path: &Path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        name.strip_suffix(".sol.json").map(str::to_owned).unwrap_or(name)
    };
    let all: Vec<String> = paths.iter().map(|path| short(path)).collect();
    let is_unique = |name: &String| all.iter().filter(|it| *it == name).count() == 1;
    match all.iter().all(is_unique) {
        true => all,
        false => paths.iter().map(|path| path.display().to_string()).collect(),
    }
}
