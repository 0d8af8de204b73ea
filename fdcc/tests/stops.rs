//! A solve in memory: watched, stopped, begun at another, in parallel.

use fdcc::{Executor, Model, Options, Report, Start, Status, Stop};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

fn model(name: &str) -> Model {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../models");
    Model::from_file(&format!("{folder}/{name}.fdc")).expect("the model is right")
}

#[test]
fn a_solve_is_watched_and_stopped() {
    let seen = AtomicUsize::new(0);
    let options = Options {
        report: &|report| {
            if let Report::Iteration(..) = report {
                seen.fetch_add(1, Ordering::Relaxed);
            }
        },
        stop: &|| match seen.load(Ordering::Relaxed) {
            0..5 => ControlFlow::Continue(()),
            _ => ControlFlow::Break(Stop::Interrupted),
        },
        ..Options::default()
    };
    let solution = model("block").solve(&options).expect("that it is stopped is no error");
    assert_eq!(*solution.status(), Status::Interrupted);
    assert!(!solution.is_solved() && seen.load(Ordering::Relaxed) >= 5);
}

#[test]
fn a_solution_starts_another_directly_and_by_its_record() {
    let model = model("block").with_method("N", 50).expect("a key");
    let first = model.solve(&Options::default()).expect("it can be solved");
    let again = model.with("mu", 0.29).expect("a parameter");
    let record = first.record();
    for start in [Start::Solution(&first), Start::Record(&record)] {
        let options = Options { start, ..Options::default() };
        let solution = again.solve(&options).expect("it can be solved");
        assert!(solution.is_solved());
        let (own, cold) = (&solution.outcome.solution.counts, &first.outcome.solution.counts);
        assert!(own.iterations < cold.iterations, "{} {}", own.iterations, cold.iterations);
    }
}

#[test]
fn jumps_are_kept_where_a_solve_begins_at_a_solution() {
    let model = model("bounce");
    let first = model.solve(&Options::default()).expect("it can be solved");
    assert!(!first.jumps.is_empty() && first.is_solved());
    let options = Options { start: Start::Solution(&first), ..Options::default() };
    let second = model.solve(&options).expect("it can be solved");
    assert!(
        (first.objective() - second.objective()).abs() < 1e-6 * first.objective().abs().max(1.0)
    );
}

#[test]
fn how_many_threads_there_are_makes_no_difference() {
    let model = model("block").with_method("N", 30).expect("a key");
    let solve = |executor| {
        let options = Options { starts: 3, executor, ..Options::default() };
        model.solve(&options).expect("it can be solved").outcome.solution.v
    };
    assert!(solve(Executor::serial()) == solve(Executor::threads(3)));
}

#[test]
fn what_does_not_belong_to_a_model_is_refused() {
    let model = model("block");
    assert!(model.with("nu", 1).is_err() && model.with_method("scheme", "fast").is_err());
    let record = fdcc::Record::default();
    let options = Options { start: Start::Record(&record), ..Options::default() };
    assert!(matches!(model.solve(&options), Err(fdcc::Error::Foreign(_))));
    assert!(matches!(Model::from_file("none.fdc"), Err(fdcc::Error::File(_))));
    assert!(matches!(Model::from_text("x", "state x"), Err(fdcc::Error::Model(_))));
}
