//! Feasible sets without an interior, where multipliers grow without end: no run ends solved with a
//! wrong objective. Every optimum has a closed form.

use fdcc_runtime::nlp::Status;
use fdcc_tests::models::{problem, solve};

/// From 0 to 0.8 with speed 1 and thrust at most 1: `T + T^2/2 = 0.8`. `{bounds}` and `{says}` say
/// in two ways where it ends.
const MISSION: &str = "free T in [0.1, 20] guess 2\ntime t in [0, T]\nstate x{bounds} start \
                       0\nstate v start 1\ncontrol u in [-1, 1]\n\
    dynamics {\n  x' = v\n  v' = u\n}\n{says}\nminimize T";

/// One state that follows its control.
fn follows(start: &str, control: &str, rest: &str) -> String {
    format!(
        "time t in [0, 1]\nstate x start {start}\ncontrol u{control}\ndynamics {{ x' = u }}\n{rest}"
    )
}

/// Whether it has to be solved, the text, and the smallest objective.
fn cases() -> Vec<(bool, String, f64)> {
    let mission = |solved, bounds, says| {
        (solved, MISSION.replace("{bounds}", bounds).replace("{says}", says), 2.6f64.sqrt() - 1.0)
    };
    vec![
        // A bound and an end condition that say the same.
        mission(true, " in [-1, 0.8]", "end x == 0.8"),
        mission(true, " in [-1, 0.8]", "end 2*(0.8 - x) == 0"),
        mission(true, " in [-1, 0.8]", "end x^2 == 0.64"),
        mission(true, " in [-1, 0.8]", "end exp(3*x) == exp(2.4)"),
        mission(true, "", "path x^3 <= 0.512\nend x == 0.8"),
        mission(true, "", "path x^3 <= 0.512\nend 2*(0.8 - x) == 0"),
        mission(false, "", "path x^3 <= 0.512\nend 1000*(0.8 - x) == 0"),
        // Here multipliers times what bounds were moved by is about what a solution may owe:
        // rounding decides.
        mission(false, "", "path x^3 <= 0.512\nend x^2 == 0.64"),
        mission(false, "", "path x^3 <= 0.512\nend exp(3*x) == exp(2.4)"),
        // An equality as two opposite inequalities; with 100 steps of the midpoint rule the first
        // differs from 1/3 by 1/120000.
        (
            true,
            follows("0", "", "path x - t^2/2 <= 0\npath t^2/2 - x <= 0\nminimize integral(u^2)"),
            1.0 / 3.0 - 1.0 / 120_000.0,
        ),
        (
            true,
            follows(
                "1",
                " guess 0.5",
                "path x^2 - exp(t) <= 0\npath exp(t) - x^2 <= 0\nminimize integral(u^2)",
            ),
            (1f64.exp() - 1.0) / 4.0,
        ),
        // The same end three times.
        (
            true,
            follows("0", "", "end x == 1\nend 2*x == 2\nend x^2 == 1\nminimize integral(u^2)"),
            1.0,
        ),
        // Squares that must not be positive: there are no multipliers at all.
        (false, follows("1", "", "end x^2 <= 0\nminimize integral((u - 1)^2)"), 4.0),
        (false, follows("1", "", "end x^2 == 0\nminimize integral((u - 1)^2)"), 4.0),
        (false, follows("0", "", "path x^2 <= 0\nminimize integral((u - 1)^2)"), 1.0),
        (false, follows("0", "", "path u^2 <= 0\nminimize integral((u - 1)^2 + x)"), 1.0),
        // Either of two controls is 0: the interior is empty, and the constraints have no
        // independent gradients.
        (
            true,
            follows(
                "0",
                " in [0, 3] guess 0.8\ncontrol w in [0, 3] guess 0.3",
                "path u*w <= 0\nminimize integral((u - 1)^2 + (w - 1)^2)",
            ),
            1.0,
        ),
    ]
}

#[test]
fn no_run_ends_solved_with_a_wrong_objective() {
    let mut wrong = Vec::new();
    for (must_be_solved, text, exact) in cases() {
        for linear in ["auto", "sparse_ldl"] {
            let method = [
                ("N", "100"),
                ("scheme", "midpoint"),
                ("solver", "interior_point"),
                ("linear", linear),
            ];
            let solution = solve(&problem(&text, &[], &method)).solution;
            let (status, error) =
                (solution.status, (solution.objective - exact).abs() / exact.max(1.0));
            let is_right = match status {
                Status::Solved => error <= 1e-5,
                _ => !must_be_solved,
            };
            if !is_right {
                wrong.push(format!("{linear}: {status:?}, off by {error:.1e}\n{text}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}
