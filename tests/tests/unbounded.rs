//! An objective without end is told to be `unbounded`, and soon; what only falls far is not.

use fdcc_runtime::nlp::Status;
use fdcc_tests::models::{problem, solve};

/// A state without bounds that a control without bounds moves; what is minimised, and what else is
/// declared.
const CASES: [(&str, &str, &str); 12] = [
    ("linear", "", "x(end)"),
    ("linear and small", "", "1e-6*x(end)"),
    ("linear, to one side", "control w in [-inf, 3]", "integral(w)"),
    ("quadratic", "", "-integral(u^2)"),
    ("cubic, from a flat point", "", "integral(u^3)"),
    ("quartic, from a flat point", "", "-integral(u^4)"),
    ("exponential", "", "-integral(exp(u))"),
    ("a saddle", "control w", "integral(u*w)"),
    ("beyond a conjugate point", "", "integral(u^2 - 10*x^2)"),
    ("a root", "control w in [0, inf] guess 1", "-integral(sqrt(w + 1)) + integral(u^2)"),
    ("a parameter", "free p guess 1", "integral(u^2) + p"),
    ("a start", "state y start free", "y(start) + integral(u^2)"),
];

const METHODS: [&str; 2] = ["", "scheme radau3"];

fn assert_unbounded(what: &str, text: &str, methods: &[&str]) {
    for method in methods {
        let text = format!("{text} method {{ N = 20 {method} }}");
        let solution = solve(&problem(&text, &[], &[])).solution;
        assert_eq!(solution.status, Status::Unbounded, "{what}, {method}: {solution:?}");
        let iterations = solution.counts.iterations;
        assert!(iterations <= 150, "{what}, {method}: {iterations} iterations");
    }
}

#[test]
fn what_falls_without_end_is_unbounded() {
    for (what, more, objective) in CASES {
        let y = if more.contains("state y") { "y' = u" } else { "" };
        let text = format!(
            "time t in [0, 1] state x start 0 control u {more} dynamics {{ x' = u {y} }}\n\
             minimize {objective}"
        );
        assert_unbounded(what, &text, &METHODS);
    }
}

#[test]
fn a_time_without_end_is_unbounded() {
    let text = "free T in [0.1, inf] guess 1 time t in [0, T] state x start 0\n\
                control u in [-1, 1] dynamics { x' = u } minimize integral(u^2) - T";
    assert_unbounded("free time", text, &METHODS);
}
