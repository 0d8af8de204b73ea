//! The sweep of `docs/performance.md` where IPOPT ran, too: every run is solved, and its optimality
//! error, recomputed by other code, is within the tolerance.

use fdcc_runtime::nlp::Status;
use fdcc_tests::models::{problem, solve};
use fdcc_tests::optimality::residuals;
use fdcc_tests::repository;
use std::thread;

/// One run, with the width of the layer, then that of the track, the friction and the first final
/// time; what is wrong with it.
fn wrong(
    text: &str,
    (sigma, steps): (&str, &str),
    [width, friction, duration]: [&str; 3],
) -> Option<String> {
    let text = text.replace("guess 6\n", &format!("guess {duration}\n"));
    let problem =
        problem(&text, &[("w", width), ("muN", friction)], &[("N", steps), ("sigma", sigma)]);
    let outcome = solve(&problem);
    let (status, objective) = (&outcome.solution.status, outcome.solution.objective);
    let error = residuals(&problem, &outcome).error(objective);
    let is_right = *status == Status::Solved && error <= problem.method.tol;
    (!is_right)
        .then(|| format!("{sigma} {steps} {width} {friction} {duration}: {status:?}, {error:e}"))
}

fn all_wrong(sigma: &str, steps: &str) -> Vec<String> {
    let file = repository().join("tests/reference/racecar.fdc");
    let text = std::fs::read_to_string(file).expect("the model is there");
    assert!(text.contains("guess 6\n"));
    let mut found = Vec::new();
    for width in ["0.3", "0.5", "1", "2"] {
        for friction in ["1", "4"] {
            for duration in ["4", "6", "10"] {
                found.extend(wrong(&text, (sigma, steps), [width, friction, duration]));
            }
        }
    }
    found
}

#[test]
fn every_run_of_the_sweep_is_optimal_to_its_tolerance() {
    let widths = ["0.1", "0.05", "0.025"].map(|sigma| {
        thread::spawn(move || ["250", "1000"].map(|steps| all_wrong(sigma, steps)).concat())
    });
    let found: Vec<String> =
        widths.into_iter().flat_map(|it| it.join().expect("no panic")).collect();
    assert!(found.is_empty(), "{found:#?}");
}
