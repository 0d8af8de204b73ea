//! `fdcc emit`: the functions of a model in a language that others compile.

use super::options::{Changes, read};
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output::{self, files};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Write the functions of a model with their derivatives as C, also for CasADi
///
/// Right side, objective, path and boundary conditions, each with its value, its Jacobian and its
/// Hessian, as C99 that needs nothing but <math.h>. The head of the file says what each takes.
#[derive(Args)]
pub struct Emit {
    /// The model; `-` is the standard input
    #[arg(value_name = "FILE")]
    file: String,
    /// The language to write
    #[arg(long, value_enum)]
    lang: Language,
    /// Write to this file instead of the standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    changes: Changes,
}

#[derive(Clone, Copy, ValueEnum)]
enum Language {
    /// C99 without dependencies but <math.h>
    C,
}

impl Emit {
    /// Writes it.
    pub fn run(self) -> Exit {
        let model = match read(&self.file, &self.changes) {
            Ok(model) => model,
            Err(exit) => return exit,
        };
        let text = match self.lang {
            Language::C => model.emit_c().map_err(Failure::from),
        };
        match text.and_then(|text| self.write(&text)) {
            Ok(()) => Exit::Fine,
            Err(failure) => failure.report(model.source()),
        }
    }

    fn write(&self, text: &str) -> Result<(), Failure> {
        match &self.out {
            Some(path) => files::write_file(path, text),
            None => {
                output::print(text);
                Ok(())
            }
        }
    }
}
