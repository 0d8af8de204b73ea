//! `fdcc test`: what is expected, what holds, and what cannot be told yet.

mod common;

use common::*;
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

/// Along `x = t` on four intervals, by hand: the sums of the rectangle, midpoint and trapezoidal rules.
#[test]
fn integrals_are_those_of_the_scheme() {
    let text = ramp("integral(x) == 0.5 within 1\nintegral(x^2) == 0.3 within 1\nintegral(t) == 0 within 1");
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
            assert!((left - expected).abs() < 1e-6, "{scheme}, line {line}: {left} is not {expected}");
        }
    }
}

#[test]
fn each_expectation_is_told_with_its_values() {
    let text = ramp(
        "x(end) == 1 within 1e-6\nx(start) == 1 within 0.5\nx(end) <= 2*goal\nx(end) >= 2\nsensitivity(x(end), goal) == 1",
    );
    let folder = folder("expectations", &[("ramp.fdc", text.as_bytes())]);
    let output = fdcc(&folder, &["test", "ramp.fdc"], "");
    expect_exit(&output, 2, "two fail");
    assert_eq!(stderr(&output), "");
    let printed = stdout(&output);
    let lines: Vec<&str> = printed.lines().collect();
    let words = ["12: ok ", "13: FAILED ", "14: ok ", "15: FAILED ", "16: skipped "];
    for (line, word) in lines.iter().zip(words) {
        assert!(line.starts_with(&format!("ramp.fdc:{word}")), "{line}");
    }
    assert!(lines[1].contains("right 1, tolerance 0.5)"), "{printed}");
    assert!(lines[4].contains("simulation"), "{printed}");
    assert_eq!(lines[5], "2 ok, 2 failed, 1 skipped");
}

#[test]
fn the_worst_of_all_files_decides() {
    let folder = folder(
        "test_exits",
        &[
            ("good.fdc", ramp("x(end) == 1 within 1e-6").as_bytes()),
            ("bad.fdc", ramp("x(end) == 2 within 1e-6").as_bytes()),
            ("skipped.fdc", ramp("sensitivity(x(end), goal) == 1").as_bytes()),
            ("silent.fdc", RAMP.as_bytes()),
            ("stuck.fdc", ramp("x(end) == 9").replace("goal = 1", "goal = 9").as_bytes()),
            ("wrong.fdc", b"state x start\n"),
        ],
    );
    let cases: &[(&[&str], i32, &str)] = &[
        (&["good.fdc"], 0, "1 ok, 0 failed, 0 skipped"),
        (&["bad.fdc"], 2, "0 ok, 1 failed, 0 skipped"),
        (&["skipped.fdc"], 0, "0 ok, 0 failed, 1 skipped"),
        (&["silent.fdc"], 0, "silent.fdc: nothing is expected"),
        (&["stuck.fdc"], 2, "0 ok, 0 failed, 0 skipped, 1 model not solved"),
        (&["wrong.fdc"], 1, ""),
        (&["missing.fdc", "good.fdc"], 4, "1 ok, 0 failed, 0 skipped"),
        (&["good.fdc", "wrong.fdc", "bad.fdc", "good.fdc"], 2, "2 ok, 1 failed, 0 skipped"),
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
    assert_eq!(code, 0);
    let file = &tested[0];
    assert_eq!(
        (&file["file"], &file["model"], &file["status"]),
        (&"ramp.fdc".into(), &"ramp".into(), &"solved".into())
    );
    let (first, second) = (&file["expectations"][0], &file["expectations"][1]);
    assert_eq!((&first["line"], &first["outcome"]), (&12.into(), &"ok".into()));
    assert_eq!((number(&first["right"]), number(&first["tolerance"])), (1.0, 1e-6));
    assert_eq!(second["outcome"], "skipped");
    assert!(second["left"].is_null());
}
