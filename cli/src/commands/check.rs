//! `fdcc check`: all diagnostics of each file.

use crate::exit::Exit;
use clap::{Args, ValueEnum};
use fdcc_grammar::{Diagnostic, Severity, SourceFile};

use super::options::seconds;
use super::solver::stopped;
use crate::drawing::render;
use crate::model;
use crate::output::{self, diagnostics, plural, sarif};
use crate::watch::{self, Deadline};
use fdcc::Checked;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Report everything that is wrong with models
#[derive(Args)]
pub struct Check {
    /// Models to check; `-` is the standard input
    #[arg(required = true, value_name = "FILE")]
    files: Vec<String>,
    /// How to report
    #[arg(long, value_enum, default_value_t = Format::Human)]
    format: Format,
    /// Treat warnings as errors
    #[arg(long, value_name = "WHAT")]
    deny: Option<Deny>,
    /// Check again whenever one of the files changes, until Ctrl-C
    #[arg(long)]
    watch: bool,
    /// Look for data files in this folder instead of that of the model
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Give up a file after this many seconds
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    time_limit: Option<f64>,
}

/// More drawings than this nobody looks at; the summary counts all, and the other formats list
/// them.
const MOST_DRAWN: usize = 100;

/// Short enough to feel immediate.
const BETWEEN_LOOKS: Duration = Duration::from_millis(150);

#[derive(Clone, Copy, ValueEnum)]
enum Format {
    /// With the lines of the model
    Human,
    /// One line for each
    Short,
    /// One array
    Json,
    /// For code scanning services
    Sarif,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Deny {
    Warnings,
}

impl Check {
    /// Checks each file and prints what was found.
    pub fn run(self) -> Exit {
        if !self.watch {
            return self.once();
        }
        if self.files.iter().any(|file| file == "-") {
            output::complain("the standard input cannot be watched; name a file");
            return Exit::Usage;
        }
        self.whenever_files_change();
        Exit::Fine
    }

    /// Looks at the files several times a second: they are small, and every system can do it.
    fn whenever_files_change(&self) {
        watch::catch_interrupts();
        let mut before = None;
        while !watch::is_interrupted() && !output::is_closed() {
            let now: Vec<Option<Vec<u8>>> =
                self.files.iter().map(|file| std::fs::read(file).ok()).collect();
            if before.as_ref() != Some(&now) {
                output::clear_terminal();
                self.once();
                before = Some(now);
            }
            std::thread::sleep(BETWEEN_LOOKS);
        }
    }

    fn once(&self) -> Exit {
        let mut exit = Exit::Fine;
        let mut loaded = Vec::new();
        for file in &self.files {
            let deadline = Deadline::after(Instant::now(), self.time_limit);
            match model::check(file, self.data.as_deref(), deadline) {
                Ok(Ok(model)) => {
                    exit = exit.max(self.verdict(&model.diagnostics));
                    loaded.push(model);
                }
                Err(stop) => exit = exit.max(stopped(file, stop)),
                Ok(Err(error)) => {
                    output::complain(&format!("{file} cannot be read: {error}"));
                    exit = Exit::File;
                }
            }
        }
        output::print(&self.report(&loaded));
        exit
    }

    fn verdict(&self, diagnostics: &[Diagnostic]) -> Exit {
        let denied =
            if self.deny == Some(Deny::Warnings) { Severity::Warning } else { Severity::Error };
        let is_wrong = diagnostics.iter().any(|diagnostic| diagnostic.severity >= denied);
        if is_wrong { Exit::ModelError } else { Exit::Fine }
    }

    fn report(&self, loaded: &[Checked]) -> String {
        let found = || {
            loaded
                .iter()
                .flat_map(|it| it.diagnostics.iter().map(|diagnostic| (&*it.source, diagnostic)))
        };
        match self.format {
            Format::Human => {
                let renderer = render::Renderer::for_stdout();
                let drawn: String =
                    found().take(MOST_DRAWN).map(|(file, it)| renderer.render(it, file)).collect();
                drawn + &summary(loaded)
            }
            Format::Short => {
                found().map(|(source, diagnostic)| short(source, diagnostic)).collect()
            }
            Format::Json => output::json(&found().map(diagnostics::entry).collect::<Vec<_>>()),
            Format::Sarif => output::json(&sarif::log(found())),
        }
    }
}

/// `block.fdc:3:8: error[FDC0001]: missing operator between ...`
fn short(source: &SourceFile, diagnostic: &Diagnostic) -> String {
    let place = source.line_column(diagnostic.span().start);
    let severity = diagnostics::severity(diagnostic.severity);
    let Diagnostic { code, message, .. } = diagnostic;
    format!("{}:{}:{}: {severity}[{code}]: {message}\n", source.name, place.line, place.column)
}

/// `2 errors, 1 warning in 3 files; `fdcc fix` repairs 1`
fn summary(loaded: &[Checked]) -> String {
    let count = |severity| {
        let all = loaded.iter().flat_map(|it| it.diagnostics.iter());
        all.filter(|diagnostic| diagnostic.severity == severity).count()
    };
    let kinds = [(Severity::Error, "error"), (Severity::Warning, "warning")];
    let counts = kinds.map(|(severity, noun)| (count(severity), noun));
    let found: Vec<String> =
        counts.iter().filter(|(n, _)| *n > 0).map(|(n, noun)| plural(*n, noun)).collect();
    let found = if found.is_empty() { "nothing wrong".to_owned() } else { found.join(", ") };
    let all: usize = loaded.iter().map(|it| it.diagnostics.len()).sum();
    let shown = if all > MOST_DRAWN {
        format!("; the first {MOST_DRAWN} are shown")
    } else {
        String::new()
    };
    let is_certain = |it: &&Diagnostic| it.fixes.iter().any(|fix| fix.certain);
    let certain = loaded.iter().flat_map(|it| it.diagnostics.iter()).filter(is_certain).count();
    let repairs =
        if certain > 0 { format!("; `fdcc fix` repairs {certain}") } else { String::new() };
    if loaded.is_empty() {
        String::new()
    } else {
        format!("{found} in {}{shown}{repairs}\n", plural(loaded.len(), "file"))
    }
}
