//! Chains of phases, solved: objectives of closed forms, of the literature, and of
//! `tests/peers/phases.py`.

use fdcc_compiler::{analyze, compile_chain};
use fdcc_runtime::solve::refinement;
use fdcc_tests::repository;
use std::ops::ControlFlow;

/// Objectives that differ from the true ones by more than 1e-6 of their size, and why.
const COARSE: &[(&str, f64, &str)] = &[
    ("two_limits", 5e-5, "the control switches between two grid points"),
    ("limit_after_link", 2e-5, "the limit is reached and left between two grid points"),
];

/// What is not solved, and why; an entry that is solved has to go.
const UNSOLVED: &[(&str, &str)] = &[(
    "goddard_arcs",
    "thrust on the singular arc is flat: the tolerance is met on the way, and lost again",
)];

/// The objective of each problem in the table of the peer.
fn objectives() -> Vec<(String, f64)> {
    let path = repository().join("tests/peers/phases.csv");
    let text = std::fs::read_to_string(path).expect("the table is there");
    let rows = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let objectives = rows.filter(|row| row[1] == "objective");
    objectives.map(|row| (row[0].into(), row[2].parse().expect("a number"))).collect()
}

#[test]
fn problems_with_phases_have_the_objectives_of_other_programs() {
    let mut wrong = Vec::new();
    for (name, objective) in objectives() {
        let path = repository().join(format!("tests/classics/phases/{name}.fdc"));
        let Ok(text) = std::fs::read_to_string(path) else { continue };
        let model = analyze(&text).model.unwrap_or_else(|| panic!("{name}: no model"));
        let chain = compile_chain(&model).unwrap_or_else(|why| panic!("{name}: {why:?}"));
        let found = refinement::solve(&chain, None, &mut |_, _| ControlFlow::Continue(()));
        let found = found.expect("it is not refused");
        let solution = &found.outcome.solution;
        let reached = chain.phases[0].sense * solution.objective;
        let difference = (reached - objective).abs() / objective.abs().max(1.0);
        let coarse = COARSE.iter().find(|row| row.0 == name).map_or(1e-6, |row| row.1);
        let is_unsolved = UNSOLVED.iter().any(|row| row.0 == name);
        if solution.status.is_solved() == is_unsolved || difference > coarse {
            wrong.push(format!("{name}: {:?} {reached}, not {objective}", solution.status));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
