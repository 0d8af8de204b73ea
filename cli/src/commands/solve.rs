//! `fdcc solve`: an optimal trajectory, a verdict, and the files asked for.

use super::options::{Gap, Options, prepare, show};
use super::solver;
use super::written;
use crate::exit::Exit;
use crate::failure::Failure;
use crate::output;
use crate::output::derivatives::Derivative;
use crate::output::named::Named;
use crate::report::log::Level;
use crate::report::{failure, verdict};
use crate::solved::Solved;
use crate::watch::catch_interrupts;
use clap::Args;
use fdcc::Model;
use fdcc_runtime::problem::Chain;
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
    /// How the optimum moves with these parameters: unknowns, switching times, states and controls
    #[arg(long, value_name = "A,B,...", value_delimiter = ',')]
    wrt: Vec<String>,
    #[command(flatten)]
    gap: Gap,
}

impl Solve {
    /// Solves and reports.
    pub fn run(self) -> Exit {
        let begin = Instant::now();
        catch_interrupts();
        let model = match prepare(&self.file, &self.options) {
            Ok(model) => model,
            Err(exit) => return exit,
        };
        match self.solve(&model, begin) {
            Ok(solved) => self.report(&model, &solved),
            Err(failure) => failure.report(model.source()),
        }
    }

    fn solve(&self, model: &Model, begin: Instant) -> Result<Solved, Failure> {
        if let Some(name) = self.wrt.iter().find(|it| !model.has_param(it)) {
            return Err(Failure::Usage(model.meaning().no_param(name)));
        }
        let headline = |chain: &Chain| {
            if !self.options.json {
                output::print_lines(&verdict::headline(chain));
            }
        };
        let mut solved = solver::solve(model, &self.options, begin, Level::Short, headline)?;
        if solved.solution.status().is_solved() {
            solved.document.sensitivities = Named::of(solved.solution.sensitivities());
            let by = |name: &String| (name.clone(), Derivative::new(&solved.solution, name));
            solved.document.derivatives = self.wrt.iter().map(by).collect();
        }
        if solved.solution.status().is_solved() && !self.no_verify {
            let gap = self.gap.of(&solved.solution.problem.method);
            solved.replay(gap);
        }
        Ok(solved)
    }

    fn report(&self, model: &Model, solved: &Solved) -> Exit {
        show(failure::diagnostic(solved).iter(), model.source());
        let written = match &self.options.out {
            Some(folder) => written::write(&solved.document, folder, &solved.document.model),
            None => Ok(Vec::new()),
        };
        // The answer is printed whether or not its files could be written.
        if self.options.json {
            output::print(&output::json(&solved.document));
        } else {
            output::print_lines(&verdict::verdict(solved));
        }
        solver::wrote(written, self.options.json, solved.exit(self.confirmed), model.source())
    }
}
