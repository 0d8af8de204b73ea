//! `fdcc fix`: applies the repairs that diagnostics propose.

use crate::exit::Exit;
use clap::Args;
use fdcc::language::repair;
use fdcc_grammar::{Diagnostic, Severity, SourceFile};

use super::rewrite;
use crate::output::{self, plural};

/// Repair what is certain in models, and print what was changed
#[derive(Args)]
pub struct Fix {
    /// Models to repair; `-` is the standard input, and then the result goes to the standard output
    #[arg(required = true, value_name = "FILE")]
    files: Vec<String>,
    /// Apply what is likely, too
    #[arg(long = "unsafe")]
    unsafely: bool,
}

impl Fix {
    /// Repairs each file.
    pub fn run(self) -> Exit {
        rewrite::each(&self.files, |file, source| self.repair(file, source))
    }

    fn repair(&self, file: &str, source: &SourceFile) -> Exit {
        let text = repair(&source.text, self.unsafely);
        let written = rewrite::replace(file, source, &text);
        if file != "-" && written == Exit::Fine {
            rewrite::show(source, &text);
        }
        written.max(verdict(source, &fdcc::check(&source.name, text.into()).diagnostics))
    }
}

/// What is left to be done by hand.
fn verdict(source: &SourceFile, left: &[Diagnostic]) -> Exit {
    let errors = left.iter().filter(|it| it.severity == Severity::Error).count();
    let likely = left.iter().filter(|it| !it.fixes.is_empty()).count();
    let proposals = if likely > 0 {
        format!("; `--unsafe` has a proposal for {likely}")
    } else {
        String::new()
    };
    if errors > 0 || likely > 0 {
        output::tell(&format!("{}: {} left{proposals}\n", source.name, plural(errors, "error")));
    }
    if errors > 0 { Exit::ModelError } else { Exit::Fine }
}
