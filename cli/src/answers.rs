//! What the command says and writes of the answers of the library, for front ends in other
//! languages: the same words, and the same documents.

use crate::commands::USUAL_GAP;
use crate::commands::solver::document;
use crate::drawing::render::Renderer;
use crate::failure::Failure;
use crate::output::derivatives::Derivative;
use crate::output::document::{Document, Seconds};
use crate::output::named::Named;
use crate::output::optimality::on_the_true_system;
use crate::output::rows::Row;
use crate::output::simulation_of_phases::PhasesDocument;
use crate::output::{self, gradient as gradients, saved, simulation as simulations};
use crate::page::notebook;
use fdcc::{Gradient, Model, Record, Simulation, SimulationOfPhases, Solution};
use fdcc_grammar::{Diagnostic, SourceFile};
use std::path::Path;
use std::sync::OnceLock;

/// A solution with what is said of it: its sensitivities and its replay on the true system, both
/// computed when they are first needed.
pub struct Answer {
    solution: Solution,
    seconds: Seconds,
    document: OnceLock<Document>,
}

impl Answer {
    /// Of a solution; `seconds` are those of compiling and of solving.
    pub fn new(solution: Solution, [compile, solve]: [f64; 2]) -> Self {
        let seconds = Seconds { compile, solve, total: compile + solve };
        Answer { solution, seconds, document: OnceLock::new() }
    }

    /// The solution.
    pub fn solution(&self) -> &Solution {
        &self.solution
    }

    fn document(&self) -> &Document {
        self.document.get_or_init(|| {
            let mut document = document(&self.solution, self.seconds);
            if self.solution.status().is_solved() {
                document.sensitivities = Named::of(self.solution.sensitivities());
                let accuracy = self.solution.problem.method.accuracy;
                document.replay(&self.solution, accuracy.unwrap_or(USUAL_GAP));
            }
            document
        })
    }

    /// Whether the replay confirms it and nothing contradicts that it is an optimum.
    pub fn is_confirmed(&self) -> bool {
        self.document().is_confirmed()
    }

    /// What the replay says where `gap` is the largest difference that is called confirmation, as
    /// the object `verification` of the document: `null` where nothing can be replayed.
    pub fn verification(&self, gap: f64) -> String {
        let mut document = self.document().clone();
        document.replay(&self.solution, gap);
        output::json(&document.verification)
    }

    /// How the optimum moves with a parameter, as an entry of `derivatives` in the document.
    ///
    /// # Errors
    ///
    /// Why it has no such derivative, in words.
    pub fn derivative(&self, parameter: &str) -> Result<String, String> {
        match Derivative::new(&self.solution, parameter) {
            Derivative::None(why) => Err(why),
            found => Ok(output::json(&found)),
        }
    }

    /// The text of a `.sol.json`.
    pub fn json(&self) -> String {
        output::json(self.document())
    }

    /// What it looks like, as a part of an HTML page: what is certain of it, and a plot of each
    /// state and control.
    pub fn html(&self) -> String {
        notebook::fragment(&self.json())
    }

    /// What the replay says of it, and what contradicts that it is an optimum.
    pub fn words(&self) -> String {
        on_the_true_system(self.document())
    }
}

/// A solution that was read from a `.sol.json`.
pub struct Saved(saved::Saved);

impl Saved {
    /// Reads a file.
    ///
    /// # Errors
    ///
    /// A file that cannot be read or is no solution, in words.
    pub fn read(path: &Path) -> Result<Self, String> {
        saved::Saved::read(path).map(Saved).map_err(|failure| match failure {
            Failure::File(message) => message,
            _ => unreachable!("a solution depends on nothing but its file"),
        })
    }

    /// What a replay and another solve need of it, lent.
    pub fn record(&self) -> Record<'_> {
        self.0.record()
    }
}

/// What stands in a row of `fdcc sweep --json` of a solution, but for what was swept; `seconds` are
/// those of compiling and of solving. Where `gap` is given it is replayed, as with `--confirmed`.
pub fn row(solution: &Solution, [compile, solve]: [f64; 2], gap: Option<f64>) -> String {
    let mut document = document(solution, Seconds { compile, solve, total: compile + solve });
    if let Some(gap) = gap.filter(|_| solution.status().is_solved()) {
        document.replay(solution, gap);
    }
    output::json(&Row::new(&[], &document, gap.is_some()).scalars)
}

/// Diagnostics as `fdcc check` draws them, without colours.
pub fn drawn(diagnostics: &[Diagnostic], source: &SourceFile) -> String {
    let renderer = Renderer::plain();
    diagnostics.iter().map(|it| renderer.render(it, source)).collect()
}

/// Diagnostics as `fdcc check --format json` prints them.
pub fn diagnostics(diagnostics: &[Diagnostic], source: &SourceFile) -> String {
    let entries: Vec<_> =
        diagnostics.iter().map(|it| output::diagnostics::entry((source, it))).collect();
    output::json(&entries)
}

/// The document that `fdcc simulate --json` prints.
pub fn simulation(simulated: &Simulation, model: &Model) -> String {
    output::json(&simulations::SimulationDocument::new(simulated, model))
}

/// The same of a model with phases.
pub fn simulation_of_phases(simulated: &SimulationOfPhases, model: &Model) -> String {
    output::json(&PhasesDocument::new(simulated, model))
}

/// The document that `fdcc grad --json` prints of the derivatives of the expression `of`; with
/// second derivatives if they are wanted.
pub fn gradient(of: &str, found: &Gradient, has_second: bool, model: &Model) -> String {
    let document = gradients::GradientDocument::new(of, found, has_second, model);
    output::json(&document.in_units(model.into()))
}
