//! `fdcc solve`: an optimal trajectory, a verdict, and the files asked for.

use super::Exit;
use super::options::{Gap, Options, Prepared, prepare, show};
use crate::log::{Level, Log};
use crate::output::named::Named;
use crate::output::{self, files};
use crate::solver::{Compiled, Failure, Solved};
use crate::watch::catch_interrupts;
use crate::{failure, verdict};
use clap::Args;
use fdcc_compiler::{Model, compile_by_parameters};
use fdcc_runtime::solution::by_parameters;
use std::time::Instant;

/// Find an optimal trajectory
#[derive(Args)]
pub struct Solve {
    /// The model; `-` is the standard input
    #[arg(value_name = "FILE")]
    file: String,
    #[command(flatten)]
    options: Options,
    /// Do not replay the controls on the true system
    #[arg(long, conflicts_with = "confirmed")]
    no_verify: bool,
    /// End with exit code 2 also where the replay does not confirm the answer, or something
    /// contradicts that it is an optimum
    #[arg(long)]
    confirmed: bool,
    #[command(flatten)]
    gap: Gap,
}

/// What the optimum is worth to each parameter.
fn sensitivities(model: &Model, solved: &Solved) -> Named<f64> {
    let (model, problem, outcome) = solved.as_solved(model);
    if model.params.is_empty() || !problem.has_objective {
        return Named::default();
    }
    let Ok(by) = compile_by_parameters(model) else { return Named::default() };
    let found = by_parameters(problem, &outcome.solution, &outcome.trajectory.parameters, &by);
    model.params.iter().map(|param| param.place.name.clone()).zip(found).collect()
}

impl Solve {
    /// Solves and reports.
    pub fn run(self) -> Exit {
        let begin = Instant::now();
        catch_interrupts();
        let prepared = match prepare(&self.file, &self.options) {
            Ok(prepared) => prepared,
            Err(exit) => return exit,
        };
        match self.solve(&prepared, begin) {
            Ok(solved) => self.report(&prepared, &solved),
            Err(failure) => failure.report(&prepared.source),
        }
    }

    fn solve(&self, prepared: &Prepared, begin: Instant) -> Result<Solved, Failure> {
        let compiled = Compiled::new(prepared, begin, self.options.time_limit)?;
        let start = compiled.first_start(&self.options)?;
        if !self.options.json {
            output::print(&verdict::headline(&compiled.problem));
        }
        let mut log = Log::new(self.options.log.unwrap_or(Level::Short));
        let solved = compiled.solve(start, &self.options, &mut log);
        log.finish();
        let mut solved = solved?;
        if solved.is_good() {
            solved.document.sensitivities = sensitivities(&prepared.model, &solved);
        }
        if solved.is_good() && !self.no_verify {
            solved.replay(&prepared.model, self.gap.gap);
        }
        Ok(solved)
    }

    fn report(&self, prepared: &Prepared, solved: &Solved) -> Exit {
        show(failure::diagnostic(solved).iter(), &prepared.source);
        let written = match &self.options.out {
            Some(folder) => files::write(&solved.document, folder, &solved.document.model),
            None => Ok(Vec::new()),
        };
        // The answer is printed whether or not its files could be written.
        if self.options.json {
            output::print(&output::json(&solved.document));
        } else {
            output::print(&verdict::verdict(solved));
        }
        match written {
            Ok(names) if names.is_empty() || self.options.json => solved.exit(self.confirmed),
            Ok(names) => {
                output::print(&format!(" wrote {}\n", names.join("  ")));
                solved.exit(self.confirmed)
            }
            Err(failure) => failure.report(&prepared.source),
        }
    }
}
