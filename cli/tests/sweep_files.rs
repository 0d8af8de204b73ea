//! `fdcc sweep --out` and `fdcc merge`: rows in files, which several processes write, and which
//! another run goes on with.

use crate::common::*;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

const CASES: [&str; 2] = ["goal=0.1:0.1:1.1", "N=4"];

fn ramp(test: &str) -> PathBuf {
    folder(test, &[("ramp.fdc", RAMP.as_bytes())])
}

fn sweep(folder: &Path, more: &[&str]) -> std::process::Output {
    fdcc(folder, &[&["sweep", "ramp.fdc"], &CASES[..], more].concat(), "")
}

/// The table of all rows in a folder.
fn merged(folder: &Path, name: &str) -> String {
    let output = fdcc(folder, &["merge", name], "");
    expect_exit(&output, 0, name);
    stdout(&output)
}

/// The files of rows; beside them stands a page.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|it| it.expect("a file").path());
    let is_rows = |path: &PathBuf| path.extension().is_some_and(|it| it == "jsonl");
    let mut files: Vec<PathBuf> = entries.filter(is_rows).collect();
    files.sort();
    files
}

fn summary(output: &std::process::Output) -> (f64, f64) {
    let summary = json(output);
    (number(&summary["rows"]), number(&summary["before"]))
}

/// The least cost is `goal^2`.
#[test]
fn the_table_is_the_same_however_rows_are_divided() {
    let folder = ramp("merge_parts");
    expect_exit(&sweep(&folder, &["--out", "one"]), 0, "one process");
    for part in ["2/3", "1/3", "3/3"] {
        let output = sweep(&folder, &["--out", "three", "--part", part, "--jobs", "2"]);
        expect_exit(&output, 0, part);
    }
    assert_eq!((files(&folder.join("one")).len(), files(&folder.join("three")).len()), (1, 3));
    let table = merged(&folder, "one");
    assert_eq!(table, merged(&folder, "three"));
    let mut lines = table.lines();
    let names = "row,goal,N,status,objective,iterations,kkt_error,constraint_violation";
    assert_eq!(lines.next(), Some(names));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 11);
    for (at, row) in rows.iter().enumerate() {
        let goal = (at + 1) as f64 / 10.0;
        let [number, of, cost] = [0, 1, 4].map(|it| row[it].parse::<f64>().expect("a number"));
        assert_eq!((number, of, row[2], row[3]), ((at + 1) as f64, goal, "4", "solved"));
        assert!((cost - goal * goal).abs() < 1e-6, "{row:?}");
    }
}

#[test]
fn a_sweep_goes_on_where_it_was_ended() {
    let folder = ramp("merge_resume");
    let run = || summary(&sweep(&folder, &["--out", "runs", "--json"]));
    assert_eq!(run(), (11.0, 0.0));
    let (table, file) = (merged(&folder, "runs"), &files(&folder.join("runs"))[0]);
    assert_eq!(run(), (11.0, 11.0), "nothing is left to do");
    // As when the process is killed while it writes the sixth line.
    let text = fs::read_to_string(file).expect("it can be read");
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    fs::write(file, lines[..5].concat() + &lines[5][..40]).expect("it can be written");
    let torn = fdcc(&folder, &["merge", "runs"], "");
    expect_exit(&torn, 2, "rows are missing");
    assert!(stderr(&torn).contains("6 of 11 rows are missing"), "{}", stderr(&torn));
    assert_eq!(run(), (11.0, 5.0));
    assert_eq!(merged(&folder, "runs"), table);
}

#[test]
fn cases_may_be_added_but_not_changed() {
    let folder = ramp("merge_added");
    let run =
        |goals: &str| fdcc(&folder, &["sweep", "ramp.fdc", goals, "--out", "runs", "--json"], "");
    assert_eq!(summary(&run("goal=1,2")), (2.0, 0.0));
    assert_eq!(summary(&run("goal=1,2,3")), (3.0, 2.0));
    for goals in ["goal=1", "goal=2,1,3"] {
        let output = run(goals);
        expect_exit(&output, 4, goals);
        assert!(stderr(&output).contains("has other values than now"), "{}", stderr(&output));
    }
    assert_eq!(merged(&folder, "runs").lines().count(), 4);
}

#[test]
fn another_model_or_option_is_another_sweep() {
    let folder = ramp("merge_changed");
    expect_exit(&sweep(&folder, &["--out", "runs"]), 0, "before");
    fs::write(folder.join("ramp.fdc"), RAMP.replace("u^2)", "2*u^2)")).expect("it can be written");
    expect_exit(&sweep(&folder, &["--out", "runs"]), 0, "after");
    expect_exit(&sweep(&folder, &["--out", "runs", "--starts", "2"]), 0, "with an option");
    let files = files(&folder.join("runs"));
    assert_eq!(files.len(), 3);
    let output = fdcc(&folder, &["merge", "runs"], "");
    expect_exit(&output, 4, "three sweeps");
    assert!(stderr(&output).contains("rows of several sweeps"), "{}", stderr(&output));
    let first = files[0].display().to_string();
    assert_eq!(merged(&folder, &first).lines().count(), 12);
}

#[test]
fn a_row_that_is_not_solved_is_told_and_not_solved_again() {
    let folder = ramp("merge_unsolved");
    for before in [0.0, 3.0] {
        let arguments = ["sweep", "ramp.fdc", "goal=1,9,2", "--out", "runs", "--json"];
        let output = fdcc(&folder, &arguments, "");
        expect_exit(&output, 2, "goal = 9 is out of reach");
        assert_eq!(summary(&output), (3.0, before));
        assert_eq!(json(&output)["statuses"]["infeasible"], 1);
    }
    assert!(merged(&folder, "runs").contains("\n2,9,infeasible,"));
}

#[test]
fn trajectories_are_written_when_asked_for() {
    let folder = ramp("merge_trajectories");
    let arguments = ["sweep", "ramp.fdc", "goal=1,2", "--out", "all", "--trajectories"];
    expect_exit(&fdcc(&folder, &arguments, ""), 0, "sweep");
    for row in 1..=2 {
        let text = fs::read_to_string(folder.join(format!("all/ramp.{row}.sol.json")));
        let saved: Value = serde_json::from_str(&text.expect("a file")).expect("JSON");
        assert_eq!(number(&saved["params"]["goal"]), f64::from(row));
        assert!(folder.join(format!("all/ramp.{row}.csv")).exists());
        assert!(folder.join(format!("all/ramp.{row}.html")).exists());
    }
}

#[test]
fn what_is_no_file_of_rows_is_told() {
    let folder = folder("merge_wrong", &[("a.b.1-of-1.jsonl", b"{}\n")]);
    fs::create_dir_all(folder.join("empty")).expect("a folder");
    for (path, words) in [
        (".", "line 1 is no row of a sweep"),
        ("empty", "there are no rows"),
        ("missing", "missing"),
    ] {
        let output = fdcc(&folder, &["merge", path], "");
        expect_exit(&output, 4, path);
        assert!(stderr(&output).contains(words), "{path}: {}", stderr(&output));
    }
}
