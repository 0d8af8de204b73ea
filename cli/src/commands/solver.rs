//! One solve as the commands have it: with time limits, seconds, and a document of what came out.

use super::options::{Options, show};
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output;
use crate::output::document::{Document, Seconds};
use crate::output::reach::Reach;
use crate::output::saved::Saved;
use crate::output::units::Units;
use crate::report::log::{Level, Log};
use crate::solved::Solved;
use crate::watch::Deadline;
use fdcc::{Error, Model, Solution, Start};
use fdcc_grammar::SourceFile;
use fdcc_runtime::nlp::Stop;
use fdcc_runtime::problem::Chain;
use sha2::{Digest, Sha256};
use std::time::Instant;

/// A problem that is ready to be solved.
pub struct Compiled {
    compiled: fdcc::Compiled,
    begin: Instant,
    seconds: f64,
}

impl Failure {
    /// Says it on the standard error.
    pub fn report(&self, source: &SourceFile) -> Exit {
        match self {
            Failure::Model(diagnostics) => {
                show(diagnostics.iter(), source);
                Exit::ModelError
            }
            Failure::Nothing => {
                output::complain(&format!(
                    "{}: nothing to solve: the model has no state, control or `free` unknown",
                    source.name
                ));
                Exit::ModelError
            }
            Failure::Usage(message) => {
                output::complain(message);
                Exit::Usage
            }
            Failure::File(message) => {
                output::complain(message);
                Exit::File
            }
            Failure::Stopped(stop) => stopped(&source.name, *stop),
        }
    }
}

/// Says that there is no result, because there was no time to make sense of the model.
pub fn stopped(name: &str, stop: Stop) -> Exit {
    let why = match stop {
        Stop::Interrupted => "interrupted",
        Stop::TimeLimit => "the time limit was reached",
    };
    output::complain(&format!("{name}: {why} while it was read and compiled"));
    Exit::NotSolved
}

/// The solution that `--warm` names, if any.
pub fn warm(options: &Options) -> Result<Option<Saved>, Failure> {
    options.warm.as_deref().map(Saved::read).transpose()
}

/// Compiles a model and solves it from where `--warm` says; `begin` is when the work on it began.
/// `ready` sees its phases before it is solved; `level` is how much is told where no option says.
pub fn solve(
    model: &Model,
    options: &Options,
    begin: Instant,
    level: Level,
    ready: impl FnOnce(&Chain),
) -> Result<Solved, Failure> {
    let compiled = Compiled::new(model, begin, options.time_limit)?;
    let saved = warm(options)?;
    let record = saved.as_ref().map(Saved::record);
    let start = record.as_ref().map_or(Start::Guess, Start::Record);
    compiled.check(start, options)?;
    ready(compiled.compiled.chain());
    let mut log = Log::new(options.log.unwrap_or(level));
    let solved = compiled.solve(start, options, &mut log);
    log.finish();
    solved
}

/// How a command ends that has printed its result: says which files were written, unless it has
/// printed JSON, or why they were not.
pub fn wrote(
    files: Result<Vec<String>, Failure>,
    is_json: bool,
    exit: Exit,
    source: &SourceFile,
) -> Exit {
    match files {
        Ok(names) if names.is_empty() || is_json => exit,
        Ok(names) => {
            output::print(&format!(" wrote {}\n", names.join("  ")));
            exit
        }
        Err(failure) => failure.report(source),
    }
}

impl Compiled {
    /// Compiles a model; `begin` is when the work on it began. It is given up when a solve would
    /// be.
    pub fn new(model: &Model, begin: Instant, time_limit: Option<f64>) -> Result<Self, Failure> {
        let model = model.clone();
        let compiled = Deadline::after(begin, time_limit).within(move || model.compile());
        let compiled = compiled.map_err(Failure::Stopped)??;
        Ok(Compiled { compiled, begin, seconds: begin.elapsed().as_secs_f64() })
    }

    /// Whether a solve can begin at the solution that `--warm` names.
    pub fn check(&self, start: Start, options: &Options) -> Result<(), Failure> {
        self.compiled.check_start(start).map_err(|error| wrong_start(error, options))
    }

    /// Solves from `start`, and from variations of it if there are to be several starts.
    pub fn solve(self, start: Start, options: &Options, log: &mut Log) -> Result<Solved, Failure> {
        let Compiled { compiled, begin, seconds } = self;
        log.show_widths_in(&Units::from(compiled.model()));
        let log = &*log;
        let deadline = Deadline::after(begin, options.time_limit);
        let options = fdcc::Options {
            starts: options.starts as usize,
            start,
            report: &|report| log.report(report),
            stop: &|| deadline.check(),
            ..fdcc::Options::default()
        };
        let solution = compiled.solve(&options)?;
        let reach = solution.reach(&options);
        let total = begin.elapsed().as_secs_f64();
        let seconds = Seconds { compile: seconds, solve: total - seconds, total };
        let mut document = document(&solution, seconds);
        document.convergence = log.convergence();
        document.reach = reach.map(Reach::from);
        Ok(Solved { solution, document })
    }
}

/// Why there is no solution, where it may be the file that `--warm` names.
pub fn wrong_start(error: Error, options: &Options) -> Failure {
    let path = options.warm.as_deref().unwrap_or("-".as_ref()).display();
    match error {
        Error::Foreign(model) => {
            Failure::File(format!("{path} has no state or control of the model `{model}`"))
        }
        Error::Record(what) => Failure::File(format!("{path}: {what}")),
        other => other.into(),
    }
}

/// The document of a solution, before it is replayed.
pub fn document(solution: &Solution, seconds: Seconds) -> Document {
    let model = solution.model();
    let (sha256, units) = (sha256(&model.source().text), Units::from(model));
    Document::new(solution, &sha256, units, seconds)
        .with_phases(solution)
        .with_estimates(solution.estimates())
}

/// How a document says which text was solved.
pub fn sha256(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}
