//! Right models from mechanics, robotics, electronics, biology, chemistry, economics and transport:
//! they can be solved, or simulated where nothing is to be minimised. That they draw neither errors
//! nor warnings is tested in `semantics.rs`.

use fdcc_compiler::{Model, compile, compile_simulation};
use fdcc_runtime::nlp::Status;
use fdcc_runtime::problem::Problem;
use fdcc_runtime::simulate::{self, Controls, Options, System, simulate};
use fdcc_tests::documents;
use fdcc_tests::models::{meaning, try_solve};

/// What is not solved yet, and why.
const UNSOLVED: &[(&str, &str)] = &[
    (
        "gripper",
        "the same as the sled; it was called solved, at an objective 10 % too high, while \
         multipliers discounted every error",
    ),
    (
        "sled_on_ice",
        "stops under friction alone: there is no feasible point while friction is smoothed",
    ),
    ("two_stage", "phases"),
];

/// Whether the model has a solution, or a trajectory if it has no objective.
fn is_solved(model: &Model) -> bool {
    let solved = match model.objective {
        Some(_) => compile(model).ok().map(|problem| is_optimised(&problem)),
        None => compile_simulation(model).ok().map(|system| is_simulated(&system)),
    };
    solved.unwrap_or(false)
}

fn is_optimised(problem: &Problem) -> bool {
    try_solve(problem).is_ok_and(|outcome| outcome.solution.status == Status::Solved)
}

fn is_simulated(system: &System) -> bool {
    let simulation = simulate(system, &Controls::Guess, &Options::default());
    matches!(simulation.status, simulate::Status::Completed)
}

#[test]
fn right_models_are_solved() {
    let models = documents("tests/right", "fdc");
    assert!(models.len() >= 60);
    let unsolved = models.iter().filter(|(_, text)| !is_solved(&meaning(text)));
    let unsolved: Vec<&str> = unsolved.map(|(name, _)| name.as_str()).collect();
    assert_eq!(unsolved, UNSOLVED.iter().map(|row| row.0).collect::<Vec<_>>());
}

#[test]
fn right_models_say_what_they_are() {
    for (name, text) in documents("tests/right", "fdc") {
        assert_eq!(meaning(&text).name, name);
        assert!(text.starts_with("#! "), "{name} begins with a line that says what it is");
    }
}
