//! `fdcc sweep`: one row per value, whatever the number of threads.

use crate::common::*;
use serde_json::{Value, json};

fn ramp(test: &str) -> std::path::PathBuf {
    folder(test, &[("ramp.fdc", RAMP.as_bytes())])
}

#[test]
fn the_table_has_a_row_per_value_and_a_column_per_name() {
    let racecar = smoothed_race_car();
    let arguments = ["sweep", &racecar, "sigma=0.2,0.1", "N=40,50", "kernel=sqrt", "--log", "none"];
    let output = fdcc(&folder("sweep_table", &[]), &arguments, "");
    expect_exit(&output, 0, "sweep");
    assert_eq!(stderr(&output), "");
    let table = stdout(&output);
    let rows: Vec<Vec<&str>> =
        table.lines().map(|line| line.split_whitespace().collect()).collect();
    let header = ["sigma", "N", "kernel", "objective", "T", "iterations", "seconds", "status"];
    assert_eq!(rows[0], header);
    assert_eq!(rows.len(), 3, "{table}");
    assert_eq!(rows[1][..3], ["0.2", "40", "sqrt"]);
    assert_eq!(rows[2][..3], ["0.1", "50", "sqrt"]);
    assert!(rows[1..].iter().all(|row| row[7] == "solved"), "{table}");
    let widths: Vec<usize> = table.lines().skip(1).map(str::len).collect();
    assert_eq!(widths[0], widths[1], "the columns are aligned");
}

/// The least cost of reaching `goal` is `goal^2`, and out of reach beyond 4.
#[test]
fn rows_are_compact_json_in_the_order_of_the_values() {
    let arguments = ["sweep", "ramp.fdc", "goal=3[m],1[m],200[cm]", "N=8", "--json"];
    let output = fdcc(&ramp("sweep_json"), &arguments, "");
    expect_exit(&output, 0, "sweep");
    let rows = json(&output);
    let rows = rows.as_array().expect("an array");
    let keys =
        |row: &Value| row.as_object().expect("an object").keys().cloned().collect::<Vec<_>>();
    let mut contract = [
        "swept",
        "status",
        "objective",
        "free",
        "iterations",
        "kkt_error",
        "constraint_violation",
        "seconds",
    ];
    contract.sort_unstable();
    for (row, goal) in rows.iter().zip([3.0, 1.0, 2.0]) {
        assert_eq!(keys(row), contract);
        assert_eq!(number(&row["swept"]["goal"]), goal);
        assert_eq!(row["swept"]["N"], 8);
        assert!((number(&row["objective"]) - goal * goal).abs() < 1e-5, "{row}");
    }
    assert_eq!(rows.len(), 3);
}

#[test]
fn a_row_that_is_not_solved_changes_the_exit_code_and_no_other_row() {
    let output = fdcc(&ramp("sweep_fails"), &["sweep", "ramp.fdc", "goal=1,9,2", "--json"], "");
    expect_exit(&output, 2, "sweep");
    let rows = json(&output);
    let statuses: Vec<&Value> =
        rows.as_array().expect("an array").iter().map(|row| &row["status"]).collect();
    assert_eq!(statuses, [&json!("solved"), &json!("infeasible"), &json!("solved")]);
}

#[test]
fn the_answer_does_not_depend_on_the_number_of_threads() {
    let folder = folder("sweep_jobs", &[]);
    let racecar = smoothed_race_car();
    let rows = |jobs: &str| {
        let arguments = ["sweep", &racecar, "N=30,40,50,60", "--json", "--jobs", jobs];
        without_seconds(json(&fdcc(&folder, &arguments, ""))).to_string()
    };
    let one = rows("1");
    assert_eq!(one, rows("2"));
    assert_eq!(one, rows("4"));
}

/// Keys of the method leave the parameters as they are: it begins where `solve` does.
#[test]
fn a_row_is_what_solve_finds() {
    let folder = folder("sweep_solve", &[]);
    let racecar = smoothed_race_car();
    let swept = json(&fdcc(&folder, &["sweep", &racecar, "N=40", "kernel=sqrt", "--json"], ""));
    let arguments = ["solve", &racecar, "--method", "N=40", "--json"];
    let solved = json(&fdcc(&folder, &arguments, ""));
    for field in ["status", "objective", "free", "iterations", "kkt_error", "constraint_violation"]
    {
        assert_eq!(swept[0][field], solved[field], "{field}");
    }
}

/// `goal^2`, whatever else is in the sweep.
#[test]
fn ranges_and_all_combinations_are_rows() {
    let rows = |arguments: &[&str]| {
        let arguments = [&["sweep", "ramp.fdc", "--json"], arguments].concat();
        let output = fdcc(&ramp("sweep_product"), &arguments, "");
        expect_exit(&output, 0, &format!("{arguments:?}"));
        let rows = json(&output);
        let row = |row: &Value| {
            let (goal, objective) = (number(&row["swept"]["goal"]), number(&row["objective"]));
            assert!((objective - goal * goal).abs() < 1e-6, "{row}");
            (goal, number(&row["swept"]["N"]) as usize)
        };
        rows.as_array().expect("rows").iter().map(row).collect::<Vec<_>>()
    };
    assert_eq!(rows(&["goal=0.5:0.1:0.7", "N=4"]), [(0.5, 4), (0.6, 4), (0.7, 4)]);
    let all = [(1.0, 4), (1.0, 8), (2.0, 4), (2.0, 8), (3.0, 4), (3.0, 8)];
    assert_eq!(rows(&["goal=1:1:3", "N=4,8", "--product"]), all);
}

#[test]
fn the_values_may_stand_in_a_file() {
    let table = "goal,N\n1,4\n\"200[cm]\",8\n";
    let lines = "{\"goal\": 1, \"N\": 4}\n{\"N\": 8, \"goal\": \"200[cm]\"}\n";
    let text = RAMP.replace("goal = 1", "goal = 1 [m]");
    let files = [("ramp.fdc", &*text), ("a.csv", table), ("a.jsonl", lines), ("b.csv", "goal\n")];
    let folder = folder("sweep_values", &files.map(|(name, text)| (name, text.as_bytes())));
    let rows = |file: &str| {
        let arguments = ["sweep", "ramp.fdc", "scheme=euler", "--values", file, "--json"];
        let output = fdcc(&folder, &arguments, "");
        expect_exit(&output, 0, file);
        without_seconds(json(&output))
    };
    let found = rows("a.csv");
    assert_eq!(found, rows("a.jsonl"));
    assert_eq!(found[1]["swept"], json!({"goal": 2.0, "N": 8, "scheme": "euler"}));
    assert!((number(&found[1]["objective"]) - 4.0).abs() < 1e-6, "{found}");
    let wrong = fdcc(&folder, &["sweep", "ramp.fdc", "--values", "b.csv"], "");
    expect_exit(&wrong, 4, "no cases");
    assert!(stderr(&wrong).contains("no case below the names"), "{}", stderr(&wrong));
}

/// A row alone is what it is among others, and costs less than from the guess.
#[test]
fn a_row_begins_at_the_solution_for_the_parameters_of_the_model() {
    let (folder, block) = (folder("sweep_base", &[]), model("block"));
    let rows = |values: &str| {
        let arguments = ["sweep", &block, values, "sigma=0.1", "N=50", "--json"];
        without_seconds(json(&fdcc(&folder, &arguments, "")))
    };
    let (all, alone) = (rows("mu=0.25,0.5,0.2"), rows("mu=0.2"));
    assert_eq!(all[2], alone[0]);
    let arguments = ["solve", &block, "--set", "mu=0.2", "--method", "sigma=0.1"];
    let arguments = [&arguments[..], &["--method", "N=50", "--json"]].concat();
    let guessed = json(&fdcc(&folder, &arguments, ""));
    let difference = number(&alone[0]["objective"]) / number(&guessed["objective"]) - 1.0;
    assert!(difference.abs() < 1e-6, "{difference}");
    assert!(number(&alone[0]["iterations"]) < number(&guessed["iterations"]) / 2.0, "{alone}");
}

#[test]
fn a_continued_sweep_starts_from_the_row_before() {
    let folder = folder("sweep_continue", &[]);
    let turbo = model("turbo");
    let iterations = |more: &[&str]| {
        let arguments =
            [&["sweep", turbo.as_str(), "sigma=0.2,0.2,0.2", "N=40,40,60", "--json"], more]
                .concat();
        let output = fdcc(&folder, &arguments, "");
        expect_exit(&output, 0, &format!("{more:?}"));
        json(&output)
            .as_array()
            .expect("rows")
            .iter()
            .map(|row| number(&row["iterations"]))
            .collect::<Vec<_>>()
    };
    let (apart, continued) = (iterations(&[]), iterations(&["--continue"]));
    assert_eq!(apart[0], continued[0]);
    assert!(continued[1] < apart[1] / 2.0, "the same problem again: {continued:?} and {apart:?}");
}

/// The lists of the model, in the unit that stands behind the last number.
#[test]
fn the_lists_may_stand_in_the_model() {
    let ramp = RAMP.replace("goal = 1", "goal = 1 [m]");
    let text = format!("{ramp}sweep {{ goal = 100, 200 [cm]  N = 4 }}\n");
    let folder = folder("sweep_in_model", &[("ramp.fdc", text.as_bytes())]);
    let rows = json(&fdcc(&folder, &["sweep", "ramp.fdc", "--json"], ""));
    let goals: Vec<&str> =
        [0, 1].map(|row| rows[row]["swept"]["goal"].as_str().unwrap_or_default()).to_vec();
    let objectives = [0, 1].map(|row| number(&rows[row]["objective"]));
    assert!(
        (objectives[0] - 1.0).abs() < 1e-6 && (objectives[1] - 4.0).abs() < 1e-6,
        "{goals:?} {objectives:?}"
    );
}

#[test]
fn wrong_lists_are_explained() {
    let folder = ramp("sweep_usage");
    let cases: &[(&[&str], i32, &str)] = &[
        (&["goal=1,2,3", "N=4,5"], 3, "`goal` has 3, `N` has 2"),
        (&["goal=1,2", "goal=3,4"], 3, "`goal` is swept twice"),
        (&["goal"], 3, "NAME=V1,V2,..."),
        (&["goal=1,,2"], 3, "value 2 of `goal` is empty"),
        (&["goal=one"], 3, "`one`"),
        (&["gaol=1"], 3, "did you mean `goal`?"),
        (&["sigm=1"], 3, "did you mean `sigma`?"),
        (&["scheme=eular"], 3, "did you mean `euler`?"),
        (&["N=0"], 3, "a whole number"),
        (&[], 3, "write a `sweep` block"),
        (&["goal=1", "--jobs", "0"], 3, "--jobs"),
        (&["goal=1", "--jobs", "2", "--continue"], 3, "cannot be used with"),
        (&["goal=1:-1:2"], 3, "from 1 in steps of -1 nobody gets to 2"),
        (&["goal=1:2"], 3, "FIRST:STEP:LAST"),
        (&["goal=1", "--part", "1/2"], 3, "--out"),
        (&["goal=1", "--part", "3/2", "--out", "x"], 3, "as in 1/4 to 4/4"),
        (&["--product", "--values", "x.csv"], 3, "cannot be used with"),
        (&["--values", "missing.csv"], 4, "missing.csv"),
        (&["goal=1,2", "--warm", "missing.json"], 4, "missing.json cannot be read"),
    ];
    for (lists, code, words) in cases {
        let output = fdcc(&folder, &[&["sweep", "ramp.fdc"], *lists].concat(), "");
        expect_exit(&output, *code, &format!("{lists:?}"));
        assert!(stderr(&output).contains(words), "{lists:?}: {}", stderr(&output));
        assert_eq!(stdout(&output), "", "{lists:?}");
    }
}

/// A tent: from the left of the ridge the way to `goal` crosses it once the goal is on the right.
/// With `--json` each certified row says what follows what; the table has a letter for each
/// sequence, and below it what they stand for.
#[test]
fn a_sweep_tells_where_the_sequence_changes() {
    let text = "model tent\nparam goal = 0.5\ntime t in [0, 1]\nstate x start -1\n\
                control u in [-9, 9]\nsurface ridge = x\ndynamics { x' in u - 0.1*Sgn(ridge) }\n\
                end x == goal\nminimize integral(u^2)\n";
    let folder = folder("sweep_sequences", &[("tent.fdc", text.as_bytes())]);
    let sweep = ["sweep", "tent.fdc", "--log", "none"];
    let rows = json(&fdcc(&folder, &[&sweep[..], &["goal=-0.5,0.5,1", "--json"]].concat(), ""));
    let sequence = |row: usize| rows[row]["sequence"]["ridge"].clone();
    assert_eq!(sequence(0), json!(["below"]));
    assert_eq!(sequence(1), json!(["below", "above"]));
    assert_eq!(sequence(2), sequence(1));
    let table = stdout(&fdcc(&folder, &[&sweep[..], &["goal=-0.5,0.5,1"]].concat(), ""));
    let lines: Vec<&str> = table.lines().collect();
    let last = |line: &str| line.split_whitespace().last().unwrap_or_default().to_owned();
    assert_eq!([1, 2, 3].map(|row| last(lines[row])), ["A", "B", "B"], "{table}");
    assert_eq!(lines[4..], [" A  ridge below", " B  ridge below, above"]);
    let alike = stdout(&fdcc(&folder, &[&sweep[..], &["goal=0.5,1"]].concat(), ""));
    let end = " one sequence in all certified rows: ridge below, above\n";
    assert!(alike.ends_with(end) && !alike.contains("sequence\n"), "{alike}");
}
