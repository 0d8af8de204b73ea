//! Solving once more after a small change of a parameter: from the guess, and from the solution
//! before the change.
//!
//! `cargo bench -p fdcc-tests --bench warm` prints the table of `docs/performance.md`.

use std::ops::ControlFlow;
use std::time::Instant;

use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::{Chain, Problem, Solver};
use fdcc_runtime::solve::warm_start::again;
use fdcc_runtime::solve::{self, Outcome};
use fdcc_tests::models::{Changes, load};

/// A model, the settings it is solved with, a parameter, its values before and after.
type Case = (&'static str, Changes<'static>, &'static str, &'static str, &'static str);

const CASES: &[Case] = &[
    ("racecar", &[("N", "250")], "muN", "1", "1.01"),
    ("racecar", &[("N", "250")], "muN", "1", "1.05"),
    ("racecar", &[("N", "1000")], "muN", "1", "1.01"),
    ("racecar", &[("N", "1000")], "muN", "1", "1.05"),
    ("racecar", &[("N", "1000")], "w", "0.5", "0.505"),
    ("racecar", &[("N", "1000")], "w", "0.5", "0.525"),
    ("block", &[], "mu", "0.3", "0.303"),
    ("block", &[], "mu", "0.3", "0.315"),
    ("turbo", &[("sigma", "0.1")], "v_turbo", "10", "10.1"),
    ("coulomb_rest", &[("sigma", "0.01")], "mu", "0.5", "0.505"),
];

/// Of so many runs the fastest is shown.
const REPEATS: usize = 3;

fn main() {
    println!(
        "| model | change | | objective | iterations | factorisations | seconds \
         |\n|---|---|---|---|---|---|---|"
    );
    for (model, settings, parameter, before, after) in CASES {
        let solved = solve(&load(model, &[(parameter, before)], settings), None).0;
        let mut problem = load(model, &[(parameter, after)], settings);
        problem.method.solver = Solver::InteriorPoint;
        let change = format!("{parameter} = {before} to {after}");
        let intervals = problem.method.intervals();
        let warm = again(&Chain::single(problem.clone()), &solved.solution, &[]);
        for (name, start) in [("from the guess", None), ("warm", Some(warm))] {
            let (outcome, seconds) = fastest(&problem, &start);
            let (solution, status) = (&outcome.solution, &outcome.solution.status);
            let (objective, counts) = (solution.objective, solution.counts);
            println!(
                "| {model}, N = {intervals} | {change} | {name}, {status:?} | {objective:.8} | {} \
                 | {} | {seconds:.3} |",
                counts.iterations, counts.factorizations
            );
        }
    }
}

fn fastest(problem: &Problem, start: &Option<Start>) -> (Outcome, f64) {
    let runs = (0..REPEATS).map(|_| solve(problem, start.clone()));
    runs.reduce(|a, b| if b.1 < a.1 { b } else { a }).expect("there is a run")
}

fn solve(problem: &Problem, start: Option<Start>) -> (Outcome, f64) {
    let begin = Instant::now();
    let outcome = solve::solve(problem, start, &mut |_, _| ControlFlow::Continue(()));
    (outcome.expect("neither is the conic solver"), begin.elapsed().as_secs_f64())
}
