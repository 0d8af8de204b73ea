//! `fdcc plot`: signals of a solution for papers, as SVG or PDF.

use super::report::wrote;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output::files;
use crate::page::arrays::{Array, arrays};
use crate::page::figures::{Figure, figures};
use crate::page::plots::{Portrait, portraits};
use crate::page::svg::{self, Row};
use crate::page::{json::Json, pdf};
use clap::Args;
use std::path::PathBuf;

/// Draw signals of a solution as SVG or PDF
#[derive(Args)]
pub struct Plot {
    /// The .sol.json of a solve, or the .sim.json of a simulation
    #[arg(value_name = "SOLUTION")]
    solution: PathBuf,
    /// What to draw: a state, an array of them as a map of colours, a control, a path condition, a
    /// report, a `plot` of the model, `costate(x)`, `multiplier(c)`, `impulse(c)`, `residual(x)` or
    /// `hamiltonian`; repeatable; all states and controls if left out
    #[arg(long, value_name = "NAME")]
    signal: Vec<String>,
    /// Draw it over this signal instead of over the time
    #[arg(long, value_name = "NAME", requires = "signal")]
    over: Option<String>,
    /// Where the picture is written: a name that ends in .svg or .pdf
    #[arg(long, value_name = "FILE.svg")]
    out: PathBuf,
}

impl Plot {
    /// Reads the solution and writes the picture.
    pub fn run(self) -> Exit {
        wrote(self.write(), &self.out)
    }

    fn write(&self) -> Result<(), Failure> {
        let ending = self.out.extension().and_then(|it| it.to_str()).unwrap_or_default();
        if !["svg", "pdf"].contains(&ending) {
            let message = "`--out` needs a name that ends in .svg or .pdf: one of them is written";
            return Err(Failure::Usage(message.into()));
        }
        let document = [Json::read(&self.solution)?];
        let all = figures(&document);
        let portraits = portraits(&document, &all);
        if let Some(asked) = self.asked(&portraits) {
            return self.save(ending, &svg::portrait(&document[0], &all, asked));
        }
        let arrays = arrays(&document, &all);
        let wanted = self.wanted(&all, &arrays)?;
        let picture = match (&self.over, &wanted[..]) {
            (None, wanted) => svg::over_time(&document[0], &all, wanted),
            (Some(over), [Row::Curves(of)]) => {
                svg::over_another(&document[0], of, find(&all, over)?)
            }
            (Some(_), _) => {
                let why = "`--over` is for one `--signal`, and not for an array of them";
                return Err(Failure::Usage(why.into()));
            }
        };
        self.save(ending, &picture)
    }

    fn save(&self, ending: &str, picture: &str) -> Result<(), Failure> {
        match ending {
            "pdf" => files::write_file(&self.out, pdf::of(picture)),
            _ => files::write_file(&self.out, picture),
        }
    }

    /// The only thing that is to be drawn, if it is a picture of the model.
    fn asked<'p>(&self, portraits: &'p [Portrait]) -> Option<&'p Portrait> {
        let [name] = &self.signal[..] else { return None };
        portraits.iter().find(|it| self.over.is_none() && it.name == *name)
    }

    fn wanted<'f>(&self, all: &'f [Figure], arrays: &'f [Array]) -> Result<Vec<Row<'f>>, Failure> {
        if self.signal.is_empty() {
            return Ok(svg::usual(all, arrays));
        }
        let row = |name: &String| match arrays.iter().find(|it| it.signal() == *name) {
            Some(array) => Ok(Row::Map(array)),
            None => find(all, name).map(Row::Curves).map_err(|_| none(name, all, arrays)),
        };
        self.signal.iter().map(row).collect()
    }
}

fn none(name: &str, all: &[Figure], arrays: &[Array]) -> Failure {
    let known = arrays.iter().map(Array::signal).chain(all.iter().map(Figure::signal));
    let known: Vec<String> = known.collect();
    Failure::Usage(format!("no signal `{name}`; there are: {}", known.join(", ")))
}

fn find<'f>(all: &'f [Figure], name: &str) -> Result<&'f Figure, Failure> {
    let found = all.iter().find(|figure| figure.signal() == name);
    found.ok_or_else(|| none(name, all, &[]))
}
