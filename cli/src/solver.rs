//! One solve as the commands have it: with time limits, seconds, and a document of what came out.

use crate::commands::{Exit, Options, show};
use crate::output;
use crate::output::document::{Document, Seconds};
use crate::output::optimality::Optimality;
use crate::output::saved::Saved;
use crate::output::units::Units;
use crate::output::verified::Verification;
use crate::report::log::Log;
use crate::watch::Deadline;
use fdcc::{Error, Model, Solution, Start};
use fdcc_grammar::{Diagnostic, SourceFile};
use fdcc_runtime::nlp::Stop;
use fdcc_runtime::problem::Problem;
use sha2::{Digest, Sha256};
use std::time::Instant;

/// A problem that is ready to be solved.
pub struct Compiled {
    compiled: fdcc::Compiled,
    begin: Instant,
    seconds: f64,
}

/// Everything that came out of a solve.
pub struct Solved {
    pub solution: Solution,
    pub document: Document,
}

/// Why there was no solve at all.
pub enum Failure {
    /// The model has no meaning for the solver.
    Model(Vec<Diagnostic>),
    /// There is nothing in the model that could be chosen.
    Nothing,
    /// What was asked for cannot be done.
    Usage(String),
    /// A file cannot be used.
    File(String),
    /// There was no time to compile the model.
    Stopped(Stop),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Model(diagnostics) => Failure::Model(diagnostics),
            Error::Nothing => Failure::Nothing,
            Error::Call(what) => Failure::Usage(what),
            Error::Record(_) | Error::Foreign(_) | Error::File(_) => {
                Failure::File(error.to_string())
            }
        }
    }
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

impl Compiled {
    /// Compiles a model; `begin` is when the work on it began. It is given up when a solve would
    /// be.
    pub fn new(model: &Model, begin: Instant, time_limit: Option<f64>) -> Result<Self, Failure> {
        let model = model.clone();
        let compiled = Deadline::after(begin, time_limit).within(move || model.compile());
        let compiled = compiled.map_err(Failure::Stopped)??;
        Ok(Compiled { compiled, begin, seconds: begin.elapsed().as_secs_f64() })
    }

    /// What is solved.
    pub fn problem(&self) -> &Problem {
        self.compiled.problem()
    }

    /// Whether a solve can begin at the solution that `--warm` names.
    pub fn check(&self, start: Start, options: &Options) -> Result<(), Failure> {
        let path = options.warm.as_deref().unwrap_or("-".as_ref()).display();
        self.compiled.check_start(start).map_err(|error| match error {
            Error::Foreign(model) => {
                Failure::File(format!("{path} has no state or control of the model `{model}`"))
            }
            Error::Record(what) => Failure::File(format!("{path}: {what}")),
            other => other.into(),
        })
    }

    /// Solves from `start`, and from variations of it if there are to be several starts.
    pub fn solve(self, start: Start, options: &Options, log: &mut Log) -> Result<Solved, Failure> {
        let Compiled { compiled, begin, seconds } = self;
        let source = compiled.model().source();
        let units = Units::from(compiled.model().meaning());
        log.show_widths_in(&units);
        let log = &*log;
        let deadline = Deadline::after(begin, options.time_limit);
        let solution = compiled.solve(&fdcc::Options {
            starts: options.starts as usize,
            start,
            report: &|report| log.report(report),
            stop: &|| deadline.check(),
            ..fdcc::Options::default()
        })?;
        let total = begin.elapsed().as_secs_f64();
        let seconds = Seconds { compile: seconds, solve: total - seconds, total };
        let document = Document::new(&solution, &sha256(&source.text), units, seconds);
        Ok(Solved { solution, document })
    }
}

impl Solved {
    /// Whether the answer can be used.
    pub fn is_good(&self) -> bool {
        self.solution.is_solved()
    }

    /// Replays the controls on the true system; `asked` is the largest difference that is called
    /// confirmation.
    pub fn replay(&mut self, asked: f64) {
        // A model that cannot be simulated is solved all the same.
        let verified = self.solution.verify().ok();
        let document = &mut self.document;
        document.verification = verified.as_ref().map(|it| Verification::new(it, asked));
        let checks = || Optimality::new(&self.solution.optimality(verified.as_ref()));
        document.optimality = document.optimality.take().map(|_| checks());
    }

    /// How a command with this solve ends; whether it has to be confirmed, too, is the caller's
    /// choice.
    pub fn exit(&self, confirmed: bool) -> Exit {
        let is_fine = self.is_good() && (!confirmed || self.document.is_confirmed());
        if is_fine { Exit::Fine } else { Exit::NotSolved }
    }
}

/// How a document says which text was solved.
pub fn sha256(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}
