//! One solve: compile, choose the starting points, run the solver, keep the best outcome.

use crate::commands::{Exit, Options, Prepared, show};
use crate::jumps::{self, Unrolled};
use crate::log::Log;
use crate::output;
use crate::output::document::{Document, Seconds};
use crate::output::saved::Saved;
use crate::output::units::Units;
use crate::output::verified::Verification;
use crate::search::{Found, Search};
use crate::verification::verify;
use crate::warm;
use crate::watch::Deadline;
use fdcc::bounds;
use fdcc::parallel;
use fdcc_compiler::Model;
use fdcc_grammar::{Diagnostic, SourceFile};
use fdcc_runtime::nlp::{Start, Stop};
use fdcc_runtime::problem::{Linear, Problem, often_called};
use fdcc_runtime::solve::Outcome;
use fdcc_runtime::transcribe::unknowns;
use sha2::{Digest, Sha256};
use std::time::Instant;

/// A problem that is ready to be solved.
pub struct Compiled {
    /// Of a model with jumps, what holds between them.
    pub problem: Problem,
    /// The model, if it has jumps.
    jumps: Option<Model>,
    source_sha256: String,
    units: Units,
    begin: Instant,
    seconds: f64,
}

/// Where a solve begins, if not at the guess.
pub enum Beginning {
    /// At this point.
    Point(Start),
    /// At a solution with jumps, where the same jumps happen.
    Solution(Box<Saved>),
}

/// Everything that came out of a solve.
pub struct Solved {
    pub problem: Problem,
    pub outcome: Outcome,
    pub document: Document,
    /// What the solver saw of a model with jumps.
    pub unrolled: Option<Unrolled>,
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

impl Compiled {
    /// Compiles a model; `begin` is when the work on it began. It is given up when a solve would
    /// be.
    pub fn new(
        prepared: &Prepared,
        begin: Instant,
        time_limit: Option<f64>,
    ) -> Result<Self, Failure> {
        let prepared = prepared.clone();
        let compiled = move || Compiled::patiently(&prepared, begin);
        Deadline::after(begin, time_limit).within(compiled).map_err(Failure::Stopped)?
    }

    fn patiently(prepared: &Prepared, begin: Instant) -> Result<Self, Failure> {
        let problem = fdcc_compiler::compile(&prepared.model).map_err(Failure::Model)?;
        refuse_senseless(&problem)?;
        let source_sha256 = sha256(&prepared.source.text);
        let units = Units::from(&prepared.model);
        let jumps = (!prepared.model.jumps.is_empty()).then(|| prepared.model.clone());
        if jumps.is_none() {
            make_machine_code(&problem);
        }
        Ok(Compiled {
            problem,
            jumps,
            source_sha256,
            units,
            begin,
            seconds: begin.elapsed().as_secs_f64(),
        })
    }

    /// The start that `--warm` names, if any.
    pub fn first_start(&self, options: &Options) -> Result<Option<Beginning>, Failure> {
        let Some(path) = &options.warm else { return Ok(None) };
        let start = warm::from_file(path, &self.problem)?;
        Ok(Some(match &self.jumps {
            Some(_) => Beginning::Solution(Box::new(Saved::read(path)?)),
            None => Beginning::Point(start),
        }))
    }

    /// The end of another solve as the start of this one.
    pub fn start_from(&self, before: &Solved) -> Beginning {
        match &self.jumps {
            Some(_) => Beginning::Solution(Box::new(Saved::from(&before.document))),
            None => Beginning::Point(warm::from_solved(before, &self.problem)),
        }
    }

    /// Solves from `start`, or from the guess, and from variations of it if there are to be several
    /// starts.
    pub fn solve(
        self,
        start: Option<Beginning>,
        options: &Options,
        log: &mut Log,
    ) -> Result<Solved, Failure> {
        log.show_widths_in(&self.units);
        let deadline = Deadline::after(self.begin, options.time_limit);
        let search = Search { starts: options.starts as usize, deadline, log };
        let found = match (&self.jumps, start) {
            (Some(model), Some(Beginning::Solution(earlier))) => {
                jumps::solve(model, &self.problem, Some(&earlier), search)?
            }
            (Some(model), _) => jumps::solve(model, &self.problem, None, search)?,
            (None, Some(Beginning::Point(start))) => search.solve(&self.problem, Some(start))?,
            (None, _) => search.solve(&self.problem, None)?,
        };
        let total = self.begin.elapsed().as_secs_f64();
        let seconds = Seconds { compile: self.seconds, solve: total - self.seconds, total };
        Ok(found.document(self.source_sha256, self.units, seconds))
    }
}

impl Found {
    fn document(self, source_sha256: String, units: Units, seconds: Seconds) -> Solved {
        let Found { problem, outcome, error, spread, jumps, tried, is_cut, unrolled } = self;
        let document = Document::new(&problem, &outcome, &source_sha256, seconds);
        let sequences_left_out = is_cut;
        let document = Document {
            units,
            step_errors: error,
            starts: spread,
            jumps,
            sequences: tried,
            sequences_left_out,
            ..document
        };
        Solved { problem, outcome, document, unrolled }
    }
}

impl Solved {
    /// What the solver saw: model, problem and outcome. Of a model with jumps, its pieces side by
    /// side.
    pub fn as_solved<'s>(&'s self, model: &'s Model) -> (&'s Model, &'s Problem, &'s Outcome) {
        match &self.unrolled {
            Some(it) => (&it.model, &it.problem, &it.outcome),
            None => (model, &self.problem, &self.outcome),
        }
    }

    /// Whether the answer can be used.
    pub fn is_good(&self) -> bool {
        self.outcome.solution.status.is_solved()
    }

    /// Replays the controls on the true system; `asked` is the largest difference that is called
    /// confirmation.
    pub fn replay(&mut self, model: &Model, asked: f64) {
        let saved = Saved::from(&self.document);
        // A model that cannot be simulated is solved all the same.
        let verified = verify(model, &self.problem, &saved).ok();
        self.document.set_verification(verified.map(|it| Verification::new(&it, asked)));
    }

    /// How a command with this solve ends; whether it has to be confirmed, too, is the caller's
    /// choice.
    pub fn exit(&self, confirmed: bool) -> Exit {
        let is_fine = self.is_good() && (!confirmed || self.document.is_confirmed());
        if is_fine { Exit::Fine } else { Exit::NotSolved }
    }
}

/// Makes the machine code that every solve needs, so that it counts as compiling.
fn make_machine_code(problem: &Problem) {
    let functions = often_called(problem);
    let prepare = |i: usize| functions[i].0.prepare(functions[i].1);
    parallel::in_order(functions.len(), parallel::processors(), prepare, |()| false);
}

/// More need more memory than a computer has to spare: about 1 kB each.
const MOST_UNKNOWNS: usize = 8_000_000;

/// What a solver cannot begin with.
fn refuse_senseless(problem: &Problem) -> Result<(), Failure> {
    if let Some(diagnostic) = bounds::empty(problem) {
        return Err(Failure::Model(vec![diagnostic]));
    }
    match unknowns(problem) {
        0 => Err(Failure::Nothing),
        many if is_too_dense(problem, many) => Err(Failure::Usage(format!(
            "`linear = riccati` treats all {} unknowns of an interval as dense; leave it out, or \
             choose fewer `steps`",
            many / problem.method.intervals
        ))),
        many if many > MOST_UNKNOWNS => Err(Failure::Usage(format!(
            "{many} unknowns are too many; N = {}",
            problem.method.intervals
        ))),
        _ => Ok(()),
    }
}

/// More numbers in the blocks of the recursion than a computer has room for. Where nobody asks for
/// it, it is not chosen then.
const MOST_DENSE: usize = 200_000_000;

fn is_too_dense(problem: &Problem, unknowns: usize) -> bool {
    let each = unknowns / problem.method.intervals;
    problem.method.linear == Linear::Riccati && unknowns.saturating_mul(each) > MOST_DENSE
}

pub fn sha256(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}
