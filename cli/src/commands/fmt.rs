//! `fdcc fmt`: models in the canonical layout.

use crate::exit::Exit;
use clap::Args;
use fdcc_grammar::{SourceFile, format};

use super::rewrite;

/// Lay out models in the canonical way
#[derive(Args)]
pub struct Fmt {
    /// Models to lay out; `-` is the standard input, and then the result goes to the standard
    /// output
    #[arg(required = true, value_name = "FILE")]
    files: Vec<String>,
    /// Write nothing; print what would change, and exit with 1 if there is anything
    #[arg(long)]
    check: bool,
}

impl Fmt {
    /// Lays out each file.
    pub fn run(self) -> Exit {
        rewrite::each(&self.files, |file, source| match format(&source.text) {
            Ok(text) if self.check => compare(source, &text),
            Ok(text) => rewrite::replace(file, source, &text),
            Err(diagnostics) => rewrite::refuse(source, &diagnostics),
        })
    }
}

fn compare(source: &SourceFile, text: &str) -> Exit {
    rewrite::show(source, text);
    if *source.text == *text { Exit::Fine } else { Exit::ModelError }
}
