//! From the text of a model to a solved problem, in one call each.

use std::ops::ControlFlow;

use fdcc::DataFiles;
use fdcc_compiler::{Analysis, Files, Model, analyze_with, compile_chain};
use fdcc_grammar::{Diagnostic, ParseCache, Severity};
use fdcc_runtime::nlp::{Solution, Status};
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::solve::{self, ChainOutcome, Outcome, Refusal};

use crate::repository;

/// Pairs of a name and its new value, as `--set` and `--method` take them.
pub type Changes<'a> = &'a [(&'a str, &'a str)];

/// The data files of the examples.
pub fn data_files() -> DataFiles {
    let all = || {
        let folders = ["models", "tests/right", "tests/classics/fits"];
        folders.map(|it| DataFiles::in_folder(repository().join(it)))
    };
    let text = move |name: &str| {
        let texts = all().map(|files| files.text(name));
        texts.into_iter().reduce(Result::or).expect("there is a folder")
    };
    let names = move |pattern: &str| {
        let names = all().map(|files| files.names(pattern));
        names.into_iter().flatten().reduce(|all, more| [all, more].concat()).ok_or("none".into())
    };
    DataFiles::from(text).with_names(names)
}

/// What is found in a text, with the data files of the examples.
pub fn analyze(text: &str) -> Analysis {
    let files = data_files();
    analyze_with(&mut ParseCache::default(), text, Some(&files))
}

/// The meaning of a model without errors, with the data files of the examples.
pub fn meaning(text: &str) -> Model {
    let checked = fdcc::check_with("a test", text.into(), Some(data_files()));
    let is_error = |it: &&Diagnostic| it.severity == Severity::Error;
    let Some(model) = &checked.model else {
        let error = checked.diagnostics.iter().find(is_error);
        panic!("the model has an error: {error:#?}\n{text}");
    };
    model.meaning().clone()
}

/// The model of a text, with other parameters and settings.
pub fn changed(text: &str, parameters: Changes, methods: Changes) -> Model {
    let mut model = meaning(text);
    for (name, value) in parameters {
        model.set_param(name, value).expect("a parameter of the model");
    }
    for (key, value) in methods {
        model.set_method(key, value).expect("a setting of the method");
    }
    model
}

/// The problem of a text.
pub fn problem(text: &str, parameters: Changes, methods: Changes) -> Problem {
    fdcc_compiler::compile(&changed(text, parameters, methods)).expect("the model can be solved")
}

/// Pairs as [`Changes`] want them.
pub fn borrowed(pairs: &[(String, String)]) -> Vec<(&str, &str)> {
    pairs.iter().map(|(name, value)| (name.as_str(), value.as_str())).collect()
}

/// The text of `models/NAME.fdc`; of one whose smoothed problem is the paper's, with its width
/// (`tests/reference`).
pub fn text_of(name: &str) -> String {
    let folders = ["tests/reference", "models"].map(|it| repository().join(it).join(name));
    let [smoothed, written] = folders.map(|it| it.with_extension("fdc"));
    let path = if smoothed.exists() { smoothed } else { written };
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The problem of [`text_of`].
pub fn load(name: &str, parameters: Changes, methods: Changes) -> Problem {
    problem(&text_of(name), parameters, methods)
}

/// The chain of the model itself, or for each sequence of jumps that may happen the one in which
/// they do.
pub fn in_phases(model: &Model) -> Vec<Chained> {
    let of = |jumps: usize, model: Model| {
        let chain = compile_chain(&model).expect("the model can be solved");
        Chained { jumps, model, chain }
    };
    if model.jumps.is_empty() {
        return vec![of(0, model.clone())];
    }
    let all = fdcc_compiler::sequences(model).expect("the model can be solved").all;
    let one = |jumps: &Vec<usize>| {
        of(jumps.len(), fdcc_compiler::with_phases(model, jumps).expect("it can be solved"))
    };
    all.iter().map(one).collect()
}

/// A chain with the model that it is compiled from.
pub struct Chained {
    /// How many jumps happen.
    pub jumps: usize,
    /// What it is compiled from.
    pub model: Model,
    /// Its phases.
    pub chain: Chain,
}

impl Chained {
    /// The models of the phases, with their problems.
    pub fn phases(&self) -> impl Iterator<Item = (&Model, &Problem)> {
        let models: Vec<&Model> = match &self.model.phases[..] {
            [] => vec![&self.model],
            phases => phases.iter().map(|phase| &phase.model).collect(),
        };
        models.into_iter().zip(&self.chain.phases)
    }
}

/// What `compile` says about a model that it understands but cannot treat yet.
pub fn refusal(text: &str) -> Option<Vec<Diagnostic>> {
    fdcc_compiler::compile(&meaning(text)).err()
}

/// Solves from the model's own guess, however it ends.
pub fn solve(problem: &Problem) -> Outcome {
    try_solve(problem).expect("the problem is not refused")
}

/// The solution of the discretised problem of a text, however it ends.
pub fn solved(text: &str) -> Solution {
    solve(&problem(text, &[], &[])).solution
}

/// Fails unless it is solved, with this objective to 1e-6 of it.
pub fn assert_solved(what: &str, solution: &Solution, objective: f64) {
    let difference = (solution.objective - objective).abs();
    assert_eq!(solution.status, Status::Solved, "{what}: {solution:?}");
    assert!(
        difference <= 1e-6 * objective.abs(),
        "{what}: {} instead of {objective}",
        solution.objective
    );
}

/// Solves a chain from its own guess, however it ends.
pub fn solve_chain(chain: &Chain) -> ChainOutcome {
    let found = solve::solve_chain(chain, None, &mut |_, _| ControlFlow::Continue(()));
    found.expect("the chain is not refused")
}

/// Solves from the model's own guess, or is refused.
pub fn try_solve(problem: &Problem) -> Result<Outcome, Refusal> {
    solve::solve(problem, None, &mut |_, _| ControlFlow::Continue(()))
}

/// A solution on the grid that was found for it.
pub struct Refined {
    /// The problem on its last grid.
    pub problem: Problem,
    /// Its solution.
    pub outcome: Outcome,
    /// The sum of the errors of all steps, if they were asked for.
    pub error: Option<f64>,
}

/// Solves a problem of one phase on a grid of our own choice, where it asks for that.
pub fn refine(problem: &Problem, watch: &mut solve::Watch) -> Refined {
    let chain = Chain::single(problem.clone());
    let found = solve::refinement::solve(&chain, None, watch).expect("it is not refused");
    let solve::refinement::Refined { mut chain, outcome, error } = found;
    Refined { problem: chain.phases.swap_remove(0), outcome: outcome.into_single(), error }
}
