//! `fdcc solve`: an optimal trajectory, a verdict, and the files asked for.

use super::Exit;
use super::options::{Options, Prepared, compile, prepare, show};
use crate::log::Log;
use crate::output::document::{Document, Seconds};
use crate::output::{self, csv, html};
use crate::watch::{Deadline, catch_interrupts};
use crate::{verdict, warm};
use clap::Args;
use fdcc_runtime::homotopy::{self, Outcome, Refusal};
use fdcc_runtime::nlp::{Start, Status};
use fdcc_runtime::problem::Problem;
use fdcc_runtime::starts;
use sha2::{Digest, Sha256};
use std::fs;
use std::path::Path;
use std::time::Instant;

/// Find an optimal trajectory
#[derive(Args)]
pub struct Solve {
    /// The model; `-` is the standard input
    #[arg(value_name = "FILE")]
    file: String,
    #[command(flatten)]
    options: Options,
}

/// Everything that came out of a solve.
pub struct Solved {
    pub problem: Problem,
    pub outcome: Outcome,
    pub document: Document,
}

impl Solve {
    /// Solves and reports.
    pub fn run(self) -> Exit {
        let begin = Instant::now();
        match prepare(&self.file, &self.options).and_then(|prepared| self.report(&prepared, begin)) {
            Ok(exit) | Err(exit) => exit,
        }
    }

    fn report(&self, prepared: &Prepared, begin: Instant) -> Result<Exit, Exit> {
        catch_interrupts();
        let mut log = Log::new(self.options.log);
        let solved = solve(prepared, &self.options, begin, &mut log);
        log.finish();
        let solved = solved?;
        if let Some(diagnostic) = verdict::diagnostic(&solved.problem, &solved.outcome) {
            show([diagnostic].iter(), &prepared.source);
        }
        let written = write_files(&solved.document, self.options.out.as_deref())?;
        if self.options.json {
            output::print(&output::json(&solved.document));
        } else {
            output::print(&format!("{}\n", verdict::headline(&solved.problem)));
            output::print(&verdict::verdict(&solved.document, &solved.outcome));
            output::print(&written);
        }
        Ok(exit(&solved.outcome.solution.status))
    }
}

/// The exit code of a status.
pub fn exit(status: &Status) -> Exit {
    if matches!(status, Status::Solved | Status::Acceptable) { Exit::Fine } else { Exit::NotSolved }
}

/// Compiles and solves, from one or several starting points.
pub fn solve(prepared: &Prepared, options: &Options, begin: Instant, log: &mut Log) -> Result<Solved, Exit> {
    let problem = compile(prepared)?;
    let compile_seconds = begin.elapsed().as_secs_f64();
    let first = match &options.warm {
        Some(path) => Some(warm::start(path, &problem)?),
        None => None,
    };
    let deadline = Deadline::after(options.time_limit);
    let mut best: Option<Outcome> = None;
    for index in 0..options.starts {
        let start = starting_point(&problem, first.clone(), index);
        let outcome = homotopy::solve(&problem, start, &mut |progress, sigma| {
            log.iteration(progress, sigma);
            deadline.check()
        });
        let outcome = outcome.map_err(refuse)?;
        if options.starts > 1 {
            log.start(index, &outcome.solution, problem.sense);
        }
        let stop = matches!(outcome.solution.status, Status::Interrupted | Status::TimeLimit);
        if best.as_ref().is_none_or(|best| starts::is_better(&outcome.solution, &best.solution)) {
            best = Some(outcome);
        }
        if stop {
            break;
        }
    }
    let outcome = best.expect("there is at least one start");
    let total = begin.elapsed().as_secs_f64();
    let seconds = Seconds { compile: compile_seconds, solve: total - compile_seconds, total };
    let document = Document::new(&problem, &outcome, &sha256(&prepared.source.text), seconds);
    Ok(Solved { problem, outcome, document })
}

fn starting_point(problem: &Problem, first: Option<Start>, index: u32) -> Option<Start> {
    match index {
        0 => first,
        _ => Some(starts::perturbed(problem, first.map(|start| start.v), index)),
    }
}

fn refuse(refusal: Refusal) -> Exit {
    match refusal {
        Refusal::NotConvex => output::complain(
            "the transcribed problem is not convex, so `solver = convex` cannot treat it; leave `solver` out",
        ),
    }
    Exit::Usage
}

fn sha256(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Writes the three files; returns the line that says so.
fn write_files(document: &Document, folder: Option<&Path>) -> Result<String, Exit> {
    let Some(folder) = folder else { return Ok(String::new()) };
    let files = [
        ("sol.json", output::json(document)),
        ("csv", csv::csv(document)),
        ("html", html::html(document)),
    ];
    let mut names = Vec::new();
    let mut result = fs::create_dir_all(folder);
    for (ending, text) in files {
        let path = folder.join(format!("{}.{ending}", document.model));
        result = result.and_then(|()| fs::write(&path, text));
        names.push(path.display().to_string());
    }
    match result {
        Ok(()) => Ok(format!(" wrote {}\n", names.join("  "))),
        Err(error) => {
            output::complain(&format!("cannot write to {}: {error}", folder.display()));
            Err(Exit::File)
        }
    }
}
