//! What is compiled once and shared by all variants of a model that differ in values only.

use fdcc_compiler::{Model, ProblemCode};
use fdcc_grammar::Diagnostic;
use fdcc_runtime::problem::Problem;
use std::sync::OnceLock;

/// Compiled when it is first needed.
#[derive(Default)]
pub(super) struct Code {
    problem: OnceLock<ProblemCode>,
}

impl Code {
    /// The problem with the values of the model.
    pub fn problem(&self, model: &Model) -> Result<Problem, Vec<Diagnostic>> {
        if let Some(code) = self.problem.get() {
            return code.problem(model);
        }
        let code = ProblemCode::new(model)?;
        self.problem.get_or_init(|| code).problem(model)
    }
}
