//! `fdcc emit`: the functions of a model as C.

use crate::common::*;
use std::fs;

#[test]
fn the_functions_are_printed_or_written() {
    let folder = folder("emit", &[]);
    let racecar = model("racecar");
    let printed = fdcc(&folder, &["emit", &racecar, "--lang", "c"], "");
    expect_exit(&printed, 0, "printed");
    for word in ["racecar_dynamics", "jac_racecar_path", "jac_adj1_racecar_boundary", "pos.x"] {
        assert!(stdout(&printed).contains(word), "no {word}");
    }
    let arguments = ["emit", &racecar, "--lang", "c", "--out", "racecar.c"];
    let written = fdcc(&folder, &arguments, "");
    expect_exit(&written, 0, "written");
    assert!(written.stdout.is_empty() && written.stderr.is_empty(), "{written:?}");
    let text = fs::read_to_string(folder.join("racecar.c")).expect("the file is there");
    assert_eq!(text, stdout(&printed));
}

#[test]
fn parameters_have_the_values_that_are_set() {
    let folder = folder("emit_set", &[]);
    let block = model("block");
    let of = |changes: &[&str]| {
        let output = fdcc(&folder, &[&["emit", &block, "--lang", "c"], changes].concat(), "");
        expect_exit(&output, 0, &format!("{changes:?}"));
        stdout(&output)
    };
    let changed = of(&["--set", "mu=0.625", "--method", "sigma=0.0625"]);
    for number in ["= 0.625;", "= 0.0625;"] {
        assert!(changed.contains(number) && !of(&[]).contains(number), "{number}");
    }
}

#[test]
fn each_phase_has_its_functions() {
    let folder = folder("emit_phases", &[]);
    let output = fdcc(&folder, &["emit", &model("twostage"), "--lang", "c"], "");
    expect_exit(&output, 0, "phases");
    for word in ["twostage_boost_dynamics", "twostage_coast_boundary", "twostage_link1"] {
        assert!(stdout(&output).contains(word), "no {word}");
    }
    assert!(stdout(&output).contains("(end_of_boost, start_of_coast, q, p) -> (cost, g)"));
}

#[test]
fn what_cannot_be_written_is_told() {
    let files = [("wrong.fdc", b"model wrong\nstate x\n".as_slice())];
    let folder = folder("emit_wrong", &files);
    let (block, bounce) = (model("block"), model("bounce"));
    let cases: &[(&[&str], i32, &str)] = &[
        (&[&block], 3, "--lang"),
        (&[&block, "--lang", "fortran"], 3, "possible values: c"),
        (&[&block, "--lang", "c", "--set", "nu=1"], 3, "there is no parameter `nu`"),
        (&[&block, "--lang", "c", "--out", "missing/block.c"], 4, "cannot write to"),
        (&["missing.fdc", "--lang", "c"], 4, "cannot be read"),
        (&["wrong.fdc", "--lang", "c"], 1, "FDC"),
        (&[&bounce, "--lang", "c"], 1, "a model with jumps cannot be written as C yet"),
    ];
    for (arguments, code, words) in cases {
        let output = fdcc(&folder, &[&["emit"], *arguments].concat(), "");
        expect_exit(&output, *code, &format!("{arguments:?}"));
        assert!(stderr(&output).contains(words), "{arguments:?}: {}", stderr(&output));
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
}
