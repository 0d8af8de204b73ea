//! One solve: compile, choose the starting points, run the solver, keep the best outcome.

use crate::bounds;
use crate::commands::{Exit, Options, Prepared, show};
use crate::log::Log;
use crate::output;
use crate::output::document::{Document, Ended, Seconds};
use crate::output::units::Units;
use crate::parallel;
use crate::warm;
use crate::watch::Deadline;
use fdcc_grammar::{Diagnostic, SourceFile};
use fdcc_runtime::homotopy::{Outcome, Refusal};
use fdcc_runtime::nlp::{Start, Status};
use fdcc_runtime::problem::Problem;
use fdcc_runtime::refine::{self, Refined};
use fdcc_runtime::starts;
use fdcc_runtime::transcribe::unknowns;
use sha2::{Digest, Sha256};
use std::time::Instant;

/// A problem that is ready to be solved.
pub struct Compiled {
    pub problem: Problem,
    source_sha256: String,
    units: Units,
    begin: Instant,
    seconds: f64,
}

/// Everything that came out of a solve.
pub struct Solved {
    pub problem: Problem,
    pub outcome: Outcome,
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
        }
    }
}

impl Compiled {
    /// Compiles a model; `begin` is when the work on it began.
    pub fn new(prepared: &Prepared, begin: Instant) -> Result<Self, Failure> {
        let problem = fdcc_compiler::compile(&prepared.model).map_err(Failure::Model)?;
        refuse_senseless(&problem)?;
        let source_sha256 = sha256(&prepared.source.text);
        let units = Units::from(&prepared.model);
        Ok(Compiled { problem, source_sha256, units, begin, seconds: begin.elapsed().as_secs_f64() })
    }

    /// The start that `--warm` names, if any.
    pub fn first_start(&self, options: &Options) -> Result<Option<Start>, Failure> {
        options.warm.as_ref().map(|path| warm::from_file(path, &self.problem)).transpose()
    }

    /// Solves from `start`, or from the guess, and from variations of it if there are to be several starts.
    pub fn solve(self, start: Option<Start>, options: &Options, log: &mut Log) -> Result<Solved, Failure> {
        let problem = self.problem;
        let deadline = Deadline::after(self.begin, options.time_limit);
        let all = match options.starts {
            1 => vec![run(&problem, start, deadline, log)?],
            starts => from_many(&problem, start, starts as usize, deadline, log)?,
        };
        let spread: Vec<Ended> =
            if all.len() > 1 { all.iter().map(Ended::new).collect() } else { Vec::new() };
        spread.iter().enumerate().for_each(|(index, ended)| log.ended(index, ended));
        let best = |a: Refined, b: Refined| {
            if starts::is_better(&b.outcome.solution, &a.outcome.solution) { b } else { a }
        };
        let Refined { problem, outcome, error } =
            all.into_iter().reduce(best).expect("there is at least one start");
        let total = self.begin.elapsed().as_secs_f64();
        let seconds = Seconds { compile: self.seconds, solve: total - self.seconds, total };
        let document = Document::new(&problem, &outcome, &self.source_sha256, seconds);
        let document = Document { units: self.units, step_errors: error, starts: spread, ..document };
        Ok(Solved { problem, outcome, document })
    }
}

impl Solved {
    /// Whether the answer can be used.
    pub fn is_good(&self) -> bool {
        matches!(self.outcome.solution.status, Status::Solved | Status::Acceptable)
    }

    /// How a command with this solve ends.
    pub fn exit(&self) -> Exit {
        if self.is_good() { Exit::Fine } else { Exit::NotSolved }
    }
}

/// More need more memory than computers have.
const MOST_UNKNOWNS: usize = 20_000_000;

/// What a solver cannot begin with.
fn refuse_senseless(problem: &Problem) -> Result<(), Failure> {
    if let Some(diagnostic) = bounds::empty(problem) {
        return Err(Failure::Model(vec![diagnostic]));
    }
    match unknowns(problem) {
        0 => Err(Failure::Nothing),
        many if many > MOST_UNKNOWNS => {
            Err(Failure::Usage(format!("{many} unknowns are too many; N = {}", problem.method.intervals)))
        }
        _ => Ok(()),
    }
}

/// From the start as it is given and from variations of it, in parallel.
fn from_many(
    problem: &Problem,
    start: Option<Start>,
    starts: usize,
    deadline: Deadline,
    log: &Log,
) -> Result<Vec<Refined>, Failure> {
    let one = |index: usize| {
        let start = match index {
            0 => start.clone(),
            _ => Some(starts::perturbed(problem, start.clone().map(|start| start.v), index as u32)),
        };
        run(problem, start, deadline, &mut log.of_start(index))
    };
    let ends = |found: &Result<Refined, Failure>| found.as_ref().map_or(true, is_stopped);
    parallel::in_order(starts, parallel::processors(), one, ends).into_iter().collect()
}

fn is_stopped(found: &Refined) -> bool {
    matches!(found.outcome.solution.status, Status::Interrupted | Status::TimeLimit)
}

fn run(
    problem: &Problem,
    start: Option<Start>,
    deadline: Deadline,
    log: &mut Log,
) -> Result<Refined, Failure> {
    let found = refine::solve(problem, start, &mut |progress, level| {
        log.iteration(progress, level);
        deadline.check()
    });
    found.map_err(|Refusal::NotConvex| {
        Failure::Usage(
            "the discretised problem is not convex, so `solver = convex` cannot treat it; leave `solver` out"
                .into(),
        )
    })
}

pub fn sha256(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}
