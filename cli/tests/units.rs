//! Units from outside: what is typed is in declared units, what is printed says them, files are in
//! SI.

use crate::common::*;

/// A block that is braked: lengths in mm, time in ms, force in N.
const BLOCK: &str = "\
model block
param gap = 3 [mm] in [1, 50]
time t in [0, 2000] [ms]
state x [mm] in [0, inf] start 0
state v [mm/s] start 0
control u [mm/s^2] in [-inf, 12]
surface slip = v
dynamics {
  x' = v
  v' in u - 2 [mm/s^2] * Sgn(slip)
}
end x == 2
end abs(v) <= 1
path x <= gap
minimize integral(u^2)
method { N = 40 smooth sigma = 0.5 }
expect { x(end) == 2 within 0.01 }
";

fn block(test: &str) -> std::path::PathBuf {
    folder(test, &[("block.fdc", BLOCK.as_bytes())])
}

#[test]
fn spans_widths_and_axes_are_in_declared_units() {
    let folder = block("units_shown");
    let output = fdcc(&folder, &["solve", "block.fdc", "--log", "none", "--out", "."], "");
    expect_exit(&output, 0, "solve");
    let verdict = stdout(&output);
    let slip =
        verdict.lines().find(|line| line.starts_with(" slip")).expect("a line of the surface");
    assert!(slip.contains(" ms   (sigma 0.5 mm/s, kernel"), "{slip}");
    let page = std::fs::read_to_string(folder.join("block.html")).expect("a page");
    for told in ["0.5 mm/s around slip", "\"label\":\"t [ms]\"", "x <span class=\"unit\">[mm]<"] {
        assert!(page.contains(told), "{told}");
    }
    let text = std::fs::read_to_string(folder.join("block.sol.json")).expect("a document");
    let document: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(number(&document["method"]["sigma"]), 5e-4, "files are in SI");
    assert_eq!(number(&document["time"].as_array().expect("a list")[40]), 2.0);
}

#[test]
fn numbers_on_the_command_line_are_in_declared_units() {
    let folder = block("units_typed");
    let solve = |more: &[&str]| {
        fdcc(&folder, &[&["solve", "block.fdc", "--log", "none", "--json"], more].concat(), "")
    };
    let both = [
        &["--set", "gap=2.5", "--method", "sigma=1"][..],
        &["--set", "gap=2.5[mm]", "--method", "sigma=1[mm/s]"],
    ];
    let documents = both.map(|more| json(&solve(more)));
    for document in &documents {
        assert!((number(&document["params"]["gap"]) - 2.5e-3).abs() < 1e-15, "{document}");
        assert!((number(&document["method"]["sigma"]) - 1e-3).abs() < 1e-15, "{document}");
    }
    let refused = solve(&["--set", "gap=60"]);
    assert!(stderr(&refused).contains("`gap` must be in [1, 50] mm, not "), "{}", stderr(&refused));
    let refused = solve(&["--method", "sigma=1[mm]"]);
    assert!(stderr(&refused).contains("`sigma` is in mm/s"), "{}", stderr(&refused));
}

#[test]
fn a_sweep_reads_and_prints_declared_units_and_its_rows_are_in_si() {
    let folder = block("units_swept");
    let sweep = ["sweep", "block.fdc", "gap=2.5,3", "sigma=1,0.5", "--log", "none"];
    let table = stdout(&fdcc(&folder, &sweep, ""));
    assert!(table.contains("2.5[mm]") && table.contains("0.5[mm/s]"), "{table}");
    let rows = json(&fdcc(&folder, &[&sweep[..], &["--json"]].concat(), ""));
    assert!((number(&rows[0]["swept"]["gap"]) - 2.5e-3).abs() < 1e-15, "{rows}");
    assert!((number(&rows[1]["swept"]["sigma"]) - 5e-4).abs() < 1e-15, "{rows}");
}

/// The unit behind a list is that of all its numbers, as in a `sweep` block; others have their own.
#[test]
fn a_unit_behind_a_list_is_that_of_all_its_numbers() {
    let block_of = |list: &str| BLOCK.to_owned() + &format!("sweep {{ gap = {list} }}\n");
    for (list, own, expected) in [
        ("gap=0.3,0.4[cm]", "0.3, 0.4 [cm]", [3e-3, 4e-3]),
        ("gap=0.3:0.1:0.4[cm]", "0.3 [cm], 0.4 [cm]", [3e-3, 4e-3]),
        ("gap=3[mm],0.4[cm]", "3 [mm], 0.4 [cm]", [3e-3, 4e-3]),
        ("gap=0.3[cm],4", "0.3 [cm], 4", [3e-3, 4e-3]),
    ] {
        let text = block_of(own);
        let folder = folder("units_listed", &[("block.fdc", text.as_bytes())]);
        for lists in [&[list][..], &[]] {
            let command = [&["sweep", "block.fdc", "--log", "none", "--json"][..], lists].concat();
            let rows = json(&fdcc(&folder, &command, ""));
            for (at, gap) in expected.iter().enumerate() {
                let swept = number(&rows[at]["swept"]["gap"]);
                assert!((swept - gap).abs() < 1e-15, "{lists:?} {own}: {rows}");
            }
        }
    }
}

#[test]
fn expectations_are_compared_in_their_units() {
    let output = fdcc(&block("units_expected"), &["test", "block.fdc"], "");
    expect_exit(&output, 0, "test");
    assert!(stdout(&output).contains("right 2 mm)"), "{}", stdout(&output));
}

#[test]
fn a_setting_without_a_unit_takes_none() {
    let folder = block("units_settings");
    for setting in ["N=20[s]", "tol=1e-6[m]", "steps=2[1]", "max_iter=30[percent]"] {
        let output = fdcc(&folder, &["solve", "block.fdc", "--method", setting], "");
        expect_exit(&output, 3, setting);
        let (key, value) = setting.split_once('=').expect("a setting has a value");
        let words = format!("`{key}` has no unit, so it cannot be `{value}`");
        assert!(stderr(&output).contains(&words), "{}", stderr(&output));
    }
}

/// `x(end)` is in mm and `x(start)` too, so their derivative is in `mm per mm`; the second
/// derivative of `x(end)` by the rate `k`, `t^2 x`, is in mm s^2.
#[test]
fn a_gradient_is_in_declared_units() {
    let text = "param k = 60 [1/min]\ntime t in [0, 1000] [ms]\nstate x [mm] start free in [1, 4]\n\
                dynamics { x' = -k*x }\nstart x == 2\nminimize k\n";
    let folder = folder("units_gradient", &[("decay.fdc", text.as_bytes())]);
    let wrt = ["--wrt", "k,x(start)", "--second"];
    let grad = ["grad", "decay.fdc", "--of", "x(end)"];
    let said = stdout(&fdcc(&folder, &[&grad[..], &wrt].concat(), ""));
    let end = 2.0 * (-1.0_f64).exp();
    assert!(said.starts_with(&format!(" x(end) = {end:.8}")), "{said}");
    let line = |name: &str, number: usize| {
        said.lines().filter(|line| line.starts_with(&format!(" {name}"))).nth(number).unwrap_or("")
    };
    assert!(line("x(start)", 0).ends_with("mm per mm"), "{said}");
    assert!(line("k", 0).contains(&format!("{:.5}", -end / 60.0)), "{said}");
    assert!(line("k", 0).ends_with("mm per 1/min"), "{said}");
    assert!(line("k", 1).contains(&format!("{:.6}", end / 3600.0)), "{said}");
    let document = json(&fdcc(&folder, &[&grad[..], &["--json"]].concat(), ""));
    assert!((number(&document["value"]) - 1e-3 * end).abs() < 1e-9, "documents are in SI");
}

#[test]
fn times_are_in_the_unit_of_time() {
    let folder = block("units_times");
    let times =
        |times: &str| fdcc(&folder, &["simulate", "block.fdc", "--json", "--times", times], "");
    let found = json(&times("0,500,2000"));
    assert_eq!(found["time"], serde_json::json!([0.0, 0.5, 2.0]));
    assert!(stderr(&times("0,2001")).contains("2001 is not between 0 and 2000"));
}

/// What `solve` refuses is no mistake: who checks all models of a folder gets 0.
#[test]
fn what_cannot_be_solved_yet_is_advice() {
    let text = b"time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]\ndynamics { x' = u }\n\
        end x == 0.5\nminimize integral(u^2)\nmethod { scheme fesd }\n";
    let folder = folder("units_advice", &[("waiting.fdc", text)]);
    let arguments = ["check", "waiting.fdc", "--format", "short", "--deny", "warnings"];
    let output = fdcc(&folder, &arguments, "");
    expect_exit(&output, 0, "check");
    assert!(
        stdout(&output).contains("advice[FDC0603]: a model with `scheme = fesd`"),
        "{}",
        stdout(&output)
    );
}

/// A way of 1 m at 10 cm/s takes 10 s, a sixth of a minute.
#[test]
fn the_objective_of_a_sweep_is_in_its_unit() {
    let text = "free T in [0.1, 100] [min] guess 2
time t in [0, T] [min]
state x [cm] start 0
control u [cm/s] in [-10, 10]
dynamics { x' = u }
end x == 1 [m]
minimize T
";
    let folder = folder("units_sweep_objective", &[("way.fdc", text.as_bytes())]);
    let table = stdout(&fdcc(&folder, &["sweep", "way.fdc", "N=20,30", "--log", "none"], ""));
    let row = table.lines().nth(1).expect("a row");
    let cells: Vec<f64> = row.split_whitespace().take(3).filter_map(|it| it.parse().ok()).collect();
    assert!(table.contains("objective [min]") && cells.len() == 3, "{table}");
    assert!(cells[1..].iter().all(|it| (it - 1.0 / 6.0).abs() < 1e-6), "{table}");
}

/// The unit of `d` is found, and not written.
#[test]
fn a_plain_number_that_could_be_meant_in_two_units_is_refused() {
    let text = |declared: &str| {
        format!(
            "{declared}\ntime t in [0, 1] [s]\nstate x [mm] start 0\n\
             control u [mm/s] in [-9000, 9000]\ndynamics {{ x' = u }}\nend x == d\n\
             minimize integral(u^2)\nmethod {{ N = 10 }}\n"
        )
    };
    let (open, given) = (text("param d"), text("param d = 1"));
    let files = [("open.fdc", open.as_bytes()), ("given.fdc", given.as_bytes())];
    let folder = folder("units_found", &files);
    let solved = |file: &str, set: &str| {
        let arguments = ["solve", file, "--set", set, "--json", "--log", "none"];
        json(&fdcc(&folder, &arguments, ""))["objective"].as_f64().expect("a number")
    };
    for (file, set) in [("given.fdc", "d=3"), ("open.fdc", "d=3[mm]")] {
        assert!((solved(file, set) - 9e-6).abs() < 1e-12, "{file} {set}");
    }
    let output = fdcc(&folder, &["solve", "open.fdc", "--set", "d=3"], "");
    expect_exit(&output, 3, "plain");
    assert!(stderr(&output).contains("as in `d=1[mm]`"), "{}", stderr(&output));
}

/// Times in messages are in the unit of time, too.
#[test]
fn a_simulation_says_when_it_ends_in_the_unit_of_time() {
    let text = "time t in [0, 5] [min]\nstate x [cm] start 1 [cm]\n\
                dynamics { x' = x^2 / 1 [cm min] }\n";
    let folder = folder("units_early", &[("early.fdc", text.as_bytes())]);
    let output = fdcc(&folder, &["simulate", "early.fdc"], "");
    assert!(stdout(&output).contains(" min\n end: time = "), "{}", stdout(&output));
    let said = stdout(&output);
    let when = said.split("at t = ").nth(1).and_then(|it| it.split(' ').next());
    let when: f64 = when.and_then(|it| it.parse().ok()).expect("a time");
    assert!((when - 1.0).abs() < 1e-6, "{said}");
}
