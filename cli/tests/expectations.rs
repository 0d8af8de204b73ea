//! `fdcc test`: what is expected, and what holds.

use crate::common::*;
use serde_json::Value;

/// [`RAMP`] with an `expect` block.
fn ramp(expectations: &str) -> String {
    format!("{RAMP}expect {{\n{expectations}\n}}\n")
}

fn tested(test: &str, text: &str, more: &[&str]) -> (i32, Value) {
    let folder = folder(test, &[("ramp.fdc", text.as_bytes())]);
    let output = fdcc(&folder, &[&["test", "ramp.fdc", "--json"], more].concat(), "");
    (output.status.code().expect("an exit code"), json(&output))
}

/// Along `x = t` on four intervals, by hand: the sums of the rectangle, midpoint and trapezoidal
/// rules.
#[test]
fn integrals_are_those_of_the_scheme() {
    let text = ramp(
        "integral(x) == 0.5 within 1\nintegral(x^2) == 0.3 within 1\nintegral(t) == 0 within 1",
    );
    let lagged = text.replace("implicit_euler", "implicit_euler lagged (x)");
    let cases = [
        ("euler", &text, [0.375, 0.21875, 0.375]),
        ("implicit_euler", &text, [0.625, 0.46875, 0.625]),
        ("implicit_euler", &lagged, [0.375, 0.21875, 0.625]),
        ("midpoint", &text, [0.5, 0.328125, 0.5]),
        ("trapezoid", &text, [0.5, 0.34375, 0.5]),
    ];
    for (scheme, text, expected) in cases {
        let (code, tested) = tested("integrals", text, &["--method", &format!("scheme={scheme}")]);
        assert_eq!(code, 0);
        for (line, expected) in expected.into_iter().enumerate() {
            let left = number(&tested[0]["expectations"][line]["left"]);
            assert!(
                (left - expected).abs() < 1e-6,
                "{scheme}, line {line}: {left} is not {expected}"
            );
        }
    }
}

#[test]
fn each_expectation_is_told_with_its_values() {
    let text = ramp(
        "x(end) == 1 within 1e-6\nx(start) == 1 within 0.5\nx(end) <= 2*goal\nx(end) >= \
         2\nsensitivity(x(end), goal) == 0",
    );
    let folder = folder("expectations", &[("ramp.fdc", text.as_bytes())]);
    let output = fdcc(&folder, &["test", "ramp.fdc"], "");
    expect_exit(&output, 2, "two fail");
    assert_eq!(stderr(&output), "");
    let printed = stdout(&output);
    let lines: Vec<&str> = printed.lines().collect();
    let words = ["12: ok ", "13: FAILED ", "14: ok ", "15: FAILED ", "16: ok "];
    for (line, word) in lines.iter().zip(words) {
        assert!(line.starts_with(&format!("ramp.fdc:{word}")), "{line}");
    }
    assert!(lines[1].contains("right 1, tolerance 0.5)"), "{printed}");
    assert_eq!(lines[5], "3 ok, 2 failed");
}

#[test]
fn the_worst_of_all_files_decides() {
    let folder = folder(
        "test_exits",
        &[
            ("good.fdc", ramp("x(end) == 1 within 1e-6").as_bytes()),
            ("bad.fdc", ramp("x(end) == 2 within 1e-6").as_bytes()),
            ("constant.fdc", ramp("sensitivity(x(end), goal) == 1").as_bytes()),
            ("silent.fdc", RAMP.as_bytes()),
            ("stuck.fdc", ramp("x(end) == 9").replace("goal = 1", "goal = 9").as_bytes()),
            ("wrong.fdc", b"state x start\n"),
        ],
    );
    let cases: &[(&[&str], i32, &str)] = &[
        (&["good.fdc"], 0, "1 ok, 0 failed"),
        (&["bad.fdc"], 2, "0 ok, 1 failed"),
        (&["constant.fdc"], 2, "(left 0, right 1"),
        (&["silent.fdc"], 0, "silent.fdc: nothing is expected"),
        (&["stuck.fdc"], 2, "0 ok, 0 failed, 1 model not solved"),
        (&["wrong.fdc"], 1, ""),
        (&["missing.fdc", "good.fdc"], 4, "1 ok, 0 failed"),
        (&["good.fdc", "wrong.fdc", "bad.fdc", "good.fdc"], 2, "2 ok, 1 failed"),
        (&["good.fdc", "--set", "goal=2"], 2, "left 2, right 1"),
        (&["good.fdc", "--method", "n=2"], 3, ""),
        (&[], 3, ""),
    ];
    for (arguments, code, words) in cases {
        let output = fdcc(&folder, &[&["test"], *arguments].concat(), "");
        expect_exit(&output, *code, &format!("{arguments:?}"));
        assert!(stdout(&output).contains(words), "{arguments:?}: {}", stdout(&output));
    }
}

#[test]
fn json_tells_the_same() {
    let (code, tested) =
        tested("test_json", &ramp("x(end) == 1 within 1e-6\nsensitivity(x(end), goal) == 1"), &[]);
    assert_eq!(code, 2);
    let file = &tested[0];
    assert_eq!(
        (&file["file"], &file["model"], &file["status"]),
        (&"ramp.fdc".into(), &"ramp".into(), &"solved".into())
    );
    let (first, second) = (&file["expectations"][0], &file["expectations"][1]);
    assert_eq!((&first["line"], &first["outcome"]), (&12.into(), &"ok".into()));
    assert_eq!((number(&first["right"]), number(&first["tolerance"])), (1.0, 1e-6));
    assert_eq!((&second["outcome"], number(&second["left"])), (&"failed".into(), 0.0));
}

/// A block that is thrown with `v0` and stopped by friction alone: after `v0/mu`, at `v0^2/(2 mu)`.
const THROWN: &str = "\
model thrown
param mu = 0.5
free v0 in [0.5, 2] guess 1.5
time t in [0, 5]
state x start 0
state v start v0
surface slip = v
dynamics {
  x' = v
  v' in -mu*Sgn(slip)
}
minimize (v0 - 1)^2
expect {
  sliding(slip) == 3 within 1e-6
  sensitivity(x(end), v0) == v0/mu within 1e-6
  sensitivity(x(end), mu) == -2 within 1e-6
  sensitivity(integral(v), v0) + sensitivity(x(end), x(start)) == 3 within 1e-6
  sensitivity(v(end), v(start)) == 0
}
";

#[test]
fn what_is_simulated_is_the_true_system() {
    let folder = folder("simulated", &[("thrown.fdc", THROWN.as_bytes())]);
    let output = fdcc(&folder, &["test", "thrown.fdc"], "");
    expect_exit(&output, 0, "thrown");
    assert!(stdout(&output).ends_with("5 ok, 0 failed\n"), "{}", stdout(&output));
    let crossing = fdcc(&folder, &["test", &model("crossing")], "");
    expect_exit(&crossing, 0, "example (2.3): alpha/(2 + alpha)");
    assert!(
        stdout(&crossing).contains("left 0.333333333, right 0.333333333"),
        "{}",
        stdout(&crossing)
    );
}

/// The smoothed problem has a solution; on the edge of the true system there are three ways on.
#[test]
fn what_the_true_system_does_not_tell_fails_with_its_reason() {
    let text = "model edge\nfree a in [0, 2] guess 1\ntime t in [0, 1]\nstate x start 0\nstate y \
                start 2\nsurface top = x\n\
                dynamics {\n  x' in a*x + y*Sgn(top)\n  y' = 0\n}\nminimize (a - 0.75)^2\n\
                method { smooth sigma = 0.1 grid N = 10 }\n\
                expect {\n  sliding(top) == 0\n  sensitivity(x(end), a) == 0\n  a == 0.75 within \
                1e-6\n}\n";
    let folder = folder("untold", &[("edge.fdc", text.as_bytes())]);
    let output = fdcc(&folder, &["test", "edge.fdc"], "");
    expect_exit(&output, 2, "edge");
    let printed = stdout(&output);
    assert_eq!(
        printed.matches("(the replay on the true system ends at t = 0)").count(),
        2,
        "{printed}"
    );
    assert!(printed.ends_with("1 ok, 2 failed\n"), "{printed}");
    let told = json(&fdcc(&folder, &["test", "edge.fdc", "--json"], ""));
    assert!(told[0]["expectations"][0]["left"].is_null(), "{told}");
    assert_eq!(told[0]["expectations"][0]["why"], "the replay on the true system ends at t = 0");
}

/// Its formula stands wherever it does: a derivative of 0 would be a lie.
#[test]
fn there_is_no_sensitivity_by_a_parameter_that_is_computed() {
    let text = THROWN.replace("param mu = 0.5", "param m = 0.5\nparam mu = m");
    let folder = folder("sensitivity_computed", &[("thrown.fdc", text.as_bytes())]);
    let output = fdcc(&folder, &["test", "thrown.fdc"], "");
    expect_exit(&output, 2, "computed");
    assert!(
        stdout(&output).contains("`mu` is computed from other parameters"),
        "{}",
        stdout(&output)
    );
    let given = fdcc(&folder, &["test", "thrown.fdc", "--set", "mu=0.5"], "");
    expect_exit(&given, 0, "given");
}

#[test]
fn a_sensitivity_is_taken_by_a_parameter_an_unknown_or_a_start() {
    for (by, words) in [
        ("x(end)", "cannot be taken by `x(end)`"),
        ("2*mu", "cannot be taken by `2*mu`"),
        ("v", "`v` has no meaning in a sensitivity"),
        ("nu", "nothing called `nu`"),
    ] {
        let text = THROWN.replace("sensitivity(x(end), mu)", &format!("sensitivity(x(end), {by})"));
        let folder = folder("sensitivity_by", &[("thrown.fdc", text.as_bytes())]);
        let output = fdcc(&folder, &["test", "thrown.fdc"], "");
        expect_exit(&output, 1, by);
        assert!(stderr(&output).contains(words), "{by}: {}", stderr(&output));
    }
}
