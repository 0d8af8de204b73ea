//! A model in closed loop: each solve from the plan before, as it is and one interval later.
//!
//! `cargo bench -p fdcc-tests --bench closed_loop` prints the table of `docs/performance.md`.

use fdcc_tests::closed_loop::{CASES, Case, Loop, run};

/// Of so many loops the fastest is shown.
const REPEATS: usize = 5;

fn fastest(case: &Case, is_later: bool) -> Loop {
    let runs = (0..REPEATS).map(|_| run(case, is_later));
    runs.reduce(|a, b| if b.seconds < a.seconds { b } else { a }).expect("there is a run")
}

fn main() {
    println!(
        "| model | N | steps | iterations from the plan as it is | one interval later | \
         microseconds as it is | one interval later |\n|---|---|---|---|---|---|---|"
    );
    for case in CASES {
        let [as_it_is, later] = [false, true].map(|is_later| fastest(case, is_later));
        let words = |it: &Loop| format!("{:.1}", it.iterations as f64 / case.steps as f64);
        let microseconds = |it: &Loop| format!("{:.0}", 1e6 * it.seconds / case.steps as f64);
        println!(
            "| {} | {} | {} | {} | {} | {} | {} |",
            case.name,
            case.intervals,
            case.steps,
            words(&as_it_is),
            words(&later),
            microseconds(&as_it_is),
            microseconds(&later)
        );
    }
}
