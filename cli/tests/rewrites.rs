//! `fdcc fmt`, `fdcc fix` and `fdcc check --watch` from outside: what they write, what they leave
//! alone, how they end.

use crate::common::*;
use std::fs;

const WIDE: &str = "param a=1\nparam  bb = 2\n";
const TIDY: &str = "param a  = 1\nparam bb = 2\n";
const BROKEN: &str = "param a =\n";
const EQUATION: &str = "time t in [0, 1]\nstate v start 1\ndynamics { v' = -Sgn(v) }\n";
const INCLUSION: &str = "time t in [0, 1]\nstate v start 1\ndynamics { v' in -Sgn(v) }\n";

#[test]
fn fmt_writes_the_canonical_layout() {
    let place = folder("fmt", &[("wide.fdc", WIDE.as_bytes()), ("broken.fdc", BROKEN.as_bytes())]);
    let checked = fdcc(&place, &["fmt", "--check", "wide.fdc"], "");
    expect_exit(&checked, 1, "a difference");
    let difference = "--- wide.fdc\n+++ wide.fdc\n@@ -1,2 +1,2 @@\n-param a=1\n-param  bb = \
                      2\n+param a  = 1\n+param bb = 2\n";
    assert_eq!(stdout(&checked), difference);
    assert_eq!(fs::read_to_string(place.join("wide.fdc")).expect("it is there"), WIDE);

    let written = fdcc(&place, &["fmt", "wide.fdc", "broken.fdc"], "");
    expect_exit(&written, 1, "one of them is broken");
    assert!(
        stderr(&written).contains("FDC0002")
            && stderr(&written).contains("broken.fdc is left as it is")
    );
    assert_eq!(fs::read_to_string(place.join("wide.fdc")).expect("it is there"), TIDY);
    assert_eq!(fs::read_to_string(place.join("broken.fdc")).expect("it is there"), BROKEN);
    expect_exit(&fdcc(&place, &["fmt", "--check", "wide.fdc"], ""), 0, "nothing left to do");
    expect_exit(&fdcc(&place, &["fmt", "missing.fdc"], ""), 4, "no such file");
}

#[test]
fn the_standard_input_goes_to_the_standard_output() {
    let place = folder("stdin", &[]);
    assert_eq!(stdout(&fdcc(&place, &["fmt", "-"], WIDE)), TIDY);
    assert_eq!(stdout(&fdcc(&place, &["fix", "-"], EQUATION)), INCLUSION);
}

#[test]
fn fix_repairs_what_is_certain_and_prints_the_difference() {
    let wrong = format!("{EQUATION}param unused = 1\n");
    let place =
        folder("fix", &[("block.fdc", wrong.as_bytes()), ("broken.fdc", BROKEN.as_bytes())]);
    let fixed = fdcc(&place, &["fix", "block.fdc"], "");
    expect_exit(&fixed, 0, "no error is left");
    assert!(
        stdout(&fixed).contains("-dynamics { v' = -Sgn(v) }\n+dynamics { v' in -Sgn(v) }\n"),
        "{}",
        stdout(&fixed)
    );
    assert!(
        stderr(&fixed).contains("0 errors left; `--unsafe` has a proposal for 1"),
        "{}",
        stderr(&fixed)
    );
    let text = || fs::read_to_string(place.join("block.fdc")).expect("it is there");
    assert_eq!(text(), format!("{INCLUSION}param unused = 1\n"));
    assert_eq!(stdout(&fdcc(&place, &["fix", "block.fdc"], "")), "");
    fdcc(&place, &["fix", "--unsafe", "block.fdc"], "");
    assert_eq!(text(), format!("{INCLUSION}param _unused = 1\n"));
    expect_exit(&fdcc(&place, &["fix", "broken.fdc"], ""), 1, "an error is left");
}

#[cfg(unix)]
#[test]
fn watching_checks_again_when_a_file_changes_and_ends_with_ctrl_c() {
    use std::io::{BufRead, BufReader};
    let place = folder("watch", &[("model.fdc", EQUATION.as_bytes())]);
    let mut child = start(&place, &["check", "--watch", "--format", "short", "model.fdc"]);
    let mut lines = BufReader::new(child.stdout.take().expect("the output is piped")).lines();
    let mut next = || lines.next().expect("another line").expect("text");
    assert!(next().contains("error[FDC0201]"));
    fs::write(place.join("model.fdc"), INCLUSION.replace("time", "tme"))
        .expect("the file can be written");
    assert!(next().contains("error[FDC0005]"));
    let interrupted = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .expect("kill runs");
    assert!(interrupted.success());
    assert_eq!(child.wait().expect("it ends").code(), Some(0));
    expect_exit(&fdcc(&place, &["check", "--watch", "-"], ""), 3, "the standard input");
}
