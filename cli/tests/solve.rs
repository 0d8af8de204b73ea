//! `fdcc solve`: what it answers, on which stream, and how it ends.

use crate::common::*;
use serde_json::Value;
use std::path::Path;

fn ramp(test: &str) -> std::path::PathBuf {
    folder(test, &[("ramp.fdc", RAMP.as_bytes())])
}

fn solved(folder: &Path, arguments: &[&str]) -> Value {
    let output = fdcc(folder, &[&["solve", "--json", "--log", "none"], arguments].concat(), "");
    expect_exit(&output, 0, &format!("{arguments:?}"));
    json(&output)
}

#[test]
fn the_document_has_the_fields_and_sizes_of_the_contract() {
    let document = solved(&ramp("document"), &["ramp.fdc"]);
    assert_eq!(document["fdcc"], env!("CARGO_PKG_VERSION"));
    assert_eq!(document["model"], "ramp");
    assert_eq!(document["source_sha256"].as_str().map(str::len), Some(64));
    assert_eq!(document["status"], "solved");
    assert_eq!(document["params"], serde_json::json!({ "goal": 1.0 }));
    assert_eq!(document["method"]["scheme"], "implicit_euler");
    assert_eq!(document["method"]["N"], 4);
    for number in ["objective", "state_gap", "constraint_violation", "events"] {
        assert!(document["verification"][number].is_number(), "{number}");
    }
    for number in ["iterations", "kkt_error", "constraint_violation", "regularizations"] {
        assert!(document[number].is_number(), "{number}");
    }
    for seconds in ["compile", "solve", "total"] {
        assert!(number(&document["seconds"][seconds]) >= 0.0);
    }
    assert_eq!(column(&document["time"]), [0.0, 0.25, 0.5, 0.75, 1.0]);
    let lengths =
        [("states", "x", 5), ("costates", "x", 5), ("controls", "u", 4), ("report", "double", 5)];
    for (group, name, length) in lengths {
        assert_eq!(column(&document[group][name]).len(), length, "{group}");
    }
}

/// With `J(t, x) = (1 - x)^2 / (1 - t)`, `dJ/dx = -2` along `x = t`.
#[test]
fn the_answer_is_that_of_the_closed_form() {
    for solver in ["convex", "interior_point"] {
        let method = format!("solver={solver}");
        let document = solved(&ramp(solver), &["ramp.fdc", "--method", &method]);
        assert_eq!(document["method"]["solver"], *solver);
        assert_eq!(document["global"], solver == "convex");
        let close = |value: f64, expected: f64| {
            assert!((value - expected).abs() < 1e-6, "{solver}: {value} is not {expected}");
        };
        close(number(&document["objective"]), 1.0);
        let columns = |group: &str, name: &str| column(&document[group][name]);
        columns("states", "x")
            .iter()
            .zip(columns("report", "double"))
            .for_each(|(x, twice)| close(twice, 2.0 * x));
        columns("states", "x")
            .iter()
            .zip(column(&document["time"]))
            .for_each(|(x, t)| close(*x, t));
        columns("controls", "u").iter().for_each(|u| close(*u, 1.0));
        columns("costates", "x").iter().for_each(|costate| close(*costate, -2.0));
    }
}

#[test]
fn maximize_reports_the_objective_as_written() {
    let text = RAMP.replace("minimize integral(u^2)", "maximize 3 - integral(u^2)");
    let folder = folder("maximize", &[("ramp.fdc", text.as_bytes())]);
    let document = solved(&folder, &["ramp.fdc"]);
    assert!((number(&document["objective"]) - 2.0).abs() < 1e-6);
    assert!((column(&document["costates"]["x"])[0] - 2.0).abs() < 1e-5);
}

#[test]
fn two_runs_differ_in_seconds_only() {
    let folder = folder("determinism", &[]);
    let racecar = smoothed_race_car();
    for more in [&[][..], &["--starts", "3", "--seed", "7"]] {
        let arguments = [&[racecar.as_str(), "--method", "N=40"], more].concat();
        let [first, second] = [(); 2].map(|()| without_seconds(solved(&folder, &arguments)));
        assert_eq!(first.to_string(), second.to_string());
    }
}

#[test]
fn the_three_files_hold_the_same_numbers_to_the_last_bit() {
    let folder = folder("files", &[]);
    let racecar = smoothed_race_car();
    let arguments = [racecar.as_str(), "--method", "N=40", "--out", "new/folder"];
    let printed = solved(&folder, &arguments);
    let read = |ending: &str| {
        let path = folder.join(format!("new/folder/racecar.{ending}"));
        std::fs::read_to_string(path).expect("the file was written")
    };
    let saved: Value = serde_json::from_str(&read("sol.json")).expect("a JSON file");
    assert_eq!(saved, printed);
    // Printing what was read gives the text again: no digit was lost or added.
    assert_eq!(
        serde_json::to_string_pretty(&saved).expect("JSON") + "\n",
        reordered(&read("sol.json"), &saved)
    );
    let table = read("csv");
    let mut lines = table.lines();
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    assert_eq!(names[..3], ["t", "pos.x", "pos.y"]);
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect())
        .collect();
    assert_eq!(rows.len(), 41);
    for (at, name) in names.iter().enumerate() {
        let groups = [&saved["states"][*name], &saved["controls"][*name], &saved["report"][*name]];
        let expected = groups.into_iter().find(|value| value.is_array()).unwrap_or(&saved["time"]);
        let expected = column(expected);
        for (k, row) in rows.iter().enumerate() {
            // A control has no value of its own at the end.
            let expected = expected.get(k).or(expected.last()).expect("a value");
            assert_eq!(row[at].to_bits(), expected.to_bits(), "{name} in row {k}");
        }
    }
}

/// A [`Value`] sorts its keys, the file has them in the order of the model; the numbers are
/// compared in their own order.
fn reordered(text: &str, value: &Value) -> String {
    let mut sorted: Vec<&str> = text.lines().map(str::trim).collect();
    let printed = serde_json::to_string_pretty(value).expect("JSON") + "\n";
    let mut own: Vec<&str> = printed.lines().map(str::trim).collect();
    let strip = |lines: &mut Vec<&str>| {
        lines.iter_mut().for_each(|line| *line = line.trim_end_matches(','));
        lines.sort_unstable();
    };
    strip(&mut sorted);
    strip(&mut own);
    assert_eq!(sorted, own);
    printed
}

#[test]
fn parameters_take_units_and_settings_take_words() {
    let folder = folder("overrides", &[]);
    let block = model("block");
    let arguments = [
        block.as_str(),
        "--set",
        "m=200[g]",
        "--set",
        "mu = 0.2",
        "--method",
        "N=40",
        "--method",
        "scheme=midpoint",
        "--method",
        "sigma=0.05",
    ];
    let document = solved(&folder, &arguments);
    assert_eq!(document["params"], serde_json::json!({ "m": 0.2, "mu": 0.2 }));
    assert_eq!(
        (&document["method"]["N"], &document["method"]["scheme"]),
        (&40.into(), &"midpoint".into())
    );
    let arguments =
        [block.as_str(), "--method", "sigma=0.05", "--method", "kernel=tanh", "--method", "N=40"];
    let document = solved(&folder, &arguments);
    assert_eq!(document["method"]["sigma"], 0.05);
    assert_eq!(document["method"]["sigmas"], serde_json::json!({ "slip": 0.05 }));
    assert_eq!(document["method"]["kernel"], "tanh");
}

/// The first line of the iteration table shows where the solve began: at the guess `T = 15`, or at
/// the solution.
#[test]
fn a_warm_start_begins_at_the_earlier_solution_on_any_grid() {
    let folder = folder("warm", &[]);
    let turbo = model("turbo");
    solved(&folder, &[&turbo, "--method", "N=40", "--method", "sigma=0.5", "--out", "."]);
    let first_objective = |more: &[&str]| {
        let output =
            fdcc(&folder, &[&["solve", turbo.as_str(), "--log", "full"], more].concat(), "");
        expect_exit(&output, 0, &format!("{more:?}"));
        let table = stderr(&output);
        let line = table.lines().nth(1).expect("a first iteration");
        line.split_whitespace().nth(1).expect("an objective").parse::<f64>().expect("a number")
    };
    assert_eq!(first_objective(&["--method", "N=40"]), 15.0);
    let others = [&["--method", "N=40"], &["--method", "N=64"], &["--method", "scheme=trapezoid"]];
    for other in others.into_iter().chain([&["--method", "sigma=0.2"]]) {
        let begin = first_objective(&[&["--warm", "turbo.sol.json"][..], other].concat());
        assert!((13.0..14.0).contains(&begin), "{other:?} begins at {begin}");
    }
}

/// `ridge` names no width, and nothing certifies its optimum: the second solve begins with that
/// which the first chose.
#[test]
fn a_warm_start_takes_the_widths_that_were_chosen() {
    let (folder, ridge) = (folder("chosen", &[]), classic("switched/ridge"));
    let uncertified = |more: &[&str]| {
        let first = ["solve", "--json", "--log", "none", &ridge, "--method", "N=80"];
        let output = fdcc(&folder, &[&first[..], more].concat(), "");
        expect_exit(&output, 2, "uncertified");
        assert_eq!(json(&output)["status"], "uncertified");
        json(&output)
    };
    let cold = uncertified(&["--out", "."]);
    let warm = uncertified(&["--warm", "ridge.sol.json"]);
    assert_eq!(cold["method"]["sigmas"], warm["method"]["sigmas"]);
    let number = |document: &Value, key: &str| document[key].as_f64().expect("a number");
    assert!((number(&cold, "objective") - number(&warm, "objective")).abs() < 1e-6);
    let (before, after) = (number(&cold, "iterations"), number(&warm, "iterations"));
    assert!(after < 0.5 * before, "{after} iterations instead of {before}");
    // A width that somebody named is not taken: it may be a wide one.
    let wide =
        solved(&folder, &[&ridge, "--method", "N=80", "--method", "sigma=0.5", "--out", "."]);
    assert!((number(&cold, "objective") - number(&wide, "objective")).abs() > 1e-3);
    let warm = uncertified(&["--warm", "ridge.sol.json"]);
    assert!((number(&cold, "objective") - number(&warm, "objective")).abs() < 1e-6);
}

#[test]
fn the_table_is_as_long_as_asked_for() {
    let folder = folder("log", &[]);
    let turbo = model("turbo");
    let lines = |level: &str| {
        let output = fdcc(&folder, &["solve", &turbo, "--log", level, "--method", "N=40"], "");
        expect_exit(&output, 0, level);
        assert!(stdout(&output).contains("local optimum"));
        stderr(&output).lines().count()
    };
    let (none, short, full) = (lines("none"), lines("short"), lines("full"));
    assert_eq!(none, 0);
    assert!(0 < short && short < full, "{short} and {full} lines");
}

#[test]
fn several_starts_are_listed_and_the_best_is_kept() {
    let folder = folder("starts", &[]);
    let turbo = model("turbo");
    // With a width that is named, what is listed and what is kept solve the same problem.
    let method = ["--method", "N=40", "--method", "sigma=0.05"];
    let arguments = ["solve", &turbo, "--starts", "3", "--seed", "5", "--json"];
    let output = fdcc(&folder, &[&arguments[..], &method].concat(), "");
    expect_exit(&output, 0, "starts");
    let said = stderr(&output);
    let objectives: Vec<f64> = said
        .lines()
        .filter(|line| line.trim_start().starts_with("start "))
        .map(|line| {
            line.split_whitespace().last().expect("an objective").parse().expect("a number")
        })
        .collect();
    assert_eq!(objectives.len(), 3, "{said}");
    let best = objectives.iter().copied().fold(f64::INFINITY, f64::min);
    let document = json(&output);
    assert!((number(&document["objective"]) - best).abs() < 1e-6 * best);
    assert_eq!(document["method"]["seed"], 5);
}

#[test]
fn exit_codes_and_words_are_those_of_the_contract() {
    let folder = folder(
        "solve_exits",
        &[
            ("ramp.fdc", RAMP.as_bytes()),
            ("static.fdc", b"param a = 1\n"),
            ("timeless.fdc", b"state x start 0\ndynamics { x' = 1 }\n"),
            ("still.fdc", b"time t in [0, 1]\n"),
            ("fall.fdc", b"time t in [0, 1]\nstate x start 0\ndynamics { x' = 1 }\n"),
            ("waits.fdc", RAMP.replace("goal = 1", "goal").as_bytes()),
            (
                "other.sol.json",
                br#"{"time": [0, 1], "states": {"y": [0, 1]}, "controls": {}, "free": {}}"#,
            ),
            ("broken.sol.json", b"{"),
        ],
    );
    let [bounce, twostage] = ["bounce", "twostage"].map(model);
    let racecar = smoothed_race_car();
    let cases: &[(&[&str], i32, &str)] = &[
        (
            &["ramp.fdc"],
            0,
            "global optimum of the discretised problem, confirmed on the true system",
        ),
        (
            &["ramp.fdc", "--no-verify"],
            0,
            "global optimum of the discretised problem, not replayed on the true system",
        ),
        (&["ramp.fdc", "--method", "solver=interior_point"], 0, "local optimum"),
        (&["static.fdc"], 1, "no state, control or `free` unknown"),
        (&["still.fdc"], 1, "no state, control or `free` unknown"),
        (&["fall.fdc"], 0, "feasible trajectory"),
        (&["ramp.fdc", "--method", "N=1"], 0, "global optimum"),
        (&["ramp.fdc", "--method", "N=1000000000000"], 3, "`N = 1000000000000` is too large"),
        (&["timeless.fdc"], 1, "FDC0407"),
        (&["waits.fdc"], 1, "FDC0408"),
        (&["waits.fdc", "--set", "goal=1"], 0, "global optimum"),
        (&[&bounce], 0, "jumps bounce at t = 0.548709"),
        (&[&bounce, "--method", "scheme=midpoint"], 0, "local optimum of the true system"),
        (
            &[&bounce, "--warm", "other.sol.json"],
            4,
            "has no state or control of the model `bounce`",
        ),
        (&[&bounce, "--method", "scheme=radau2", "--method", "controls=linear"], 0, "bounce"),
        (&[&twostage], 0, "confirmed on the true system"),
        (&[&racecar, "--set", "w=-1"], 1, "FDC0401"),
        (&["ramp.fdc", "--set", "goal=5"], 2, "FDC0602"),
        (&["ramp.fdc", "--set", "gaol=1"], 3, "did you mean `goal`?"),
        (&["ramp.fdc", "--set", "goal"], 3, "NAME=VALUE"),
        (&["ramp.fdc", "--set", "goal=far"], 3, "`far`"),
        (&["ramp.fdc", "--method", "n=10"], 3, "did you mean `N`?"),
        (&["ramp.fdc", "--method", "scheme=eular"], 3, "did you mean `euler`?"),
        (&[&racecar, "--method", "solver=convex"], 3, "not convex"),
        (&["ramp.fdc", "--time-limit", "-1"], 3, "seconds"),
        (&["ramp.fdc", "--starts", "0"], 3, "--starts"),
        (&["ramp.fdc", "--out", "ramp.fdc"], 4, "cannot write"),
        (&["ramp.fdc", "--warm", "missing.json"], 4, "missing.json cannot be read"),
        (&["ramp.fdc", "--warm", "broken.sol.json"], 4, "is not a solution"),
        (
            &["ramp.fdc", "--warm", "other.sol.json"],
            4,
            "has no state or control of the model `ramp`",
        ),
        (&[&racecar, "--method", "N=40", "--method", "max_iter=3"], 2, "iteration limit"),
        (&[&racecar, "--method", "N=8000", "--time-limit", "0.5"], 2, "time limit"),
    ];
    for (arguments, code, words) in cases {
        let output = fdcc(&folder, &[&["solve", "--log", "none"], *arguments].concat(), "");
        expect_exit(&output, *code, &format!("{arguments:?}"));
        let all = stdout(&output) + &stderr(&output);
        assert!(all.contains(words), "{arguments:?}: {all}");
        assert!(!all.replace("optimality", "").contains("optimal "), "{all}");
    }
}

#[test]
fn nothing_but_json_is_on_the_standard_output() {
    let folder = ramp("only_json");
    let racecar = smoothed_race_car();
    let cases: &[(&[&str], i32, &str)] = &[
        (&["ramp.fdc", "--log", "full", "--out", "."], 0, "solved"),
        (&["ramp.fdc", "--set", "goal=5"], 2, "infeasible"),
        (&[&racecar, "--method", "N=40", "--method", "max_iter=3"], 2, "iteration_limit"),
        (&[&racecar, "--method", "N=8000", "--time-limit", "0.5"], 2, "time_limit"),
    ];
    for (arguments, code, status) in cases {
        let output = fdcc(&folder, &[&["solve", "--json"], *arguments].concat(), "");
        expect_exit(&output, *code, &format!("{arguments:?}"));
        assert_eq!(json(&output)["status"], *status);
    }
}

#[test]
fn a_model_from_the_standard_input_is_solved() {
    let output = fdcc(&ramp("standard_input"), &["solve", "-", "--json"], RAMP);
    expect_exit(&output, 0, "-");
    assert_eq!(json(&output)["model"], "ramp");
}

/// Controls that are not constant come with the values that define them, and their replay follows
/// them.
#[test]
fn controls_of_every_shape_are_written_and_replayed() {
    let model = "model swing\nparam k = 2\ntime t in [0, 4]\nstate x start 1\nstate v start \
                 0\ncontrol u in [-3, 3]\n\
                 dynamics {\n  x' = v\n  v' = -k*x + u\n}\nend x == 0\nend v == 0\nminimize \
                 integral(u^2)\n";
    let folder = folder("control_shapes", &[("swing.fdc", model.as_bytes())]);
    for (shape, count) in [("constant", 0), ("linear", 21), ("polynomial", 60)] {
        let controls = format!("controls={shape}");
        let method = ["--method", "scheme=radau3", "--method", "N=20", "--method", &controls];
        let document = solved(&folder, &[&["swing.fdc", "--out", shape], &method[..]].concat());
        assert_eq!(document["method"]["controls"], shape);
        assert_eq!(document["controls"]["u"].as_array().expect("one for each interval").len(), 20);
        let nodes = document["control_nodes"]["values"]["u"].as_array().map_or(0, Vec::len);
        assert_eq!(nodes, count, "{shape}");
        assert_eq!(
            document["verification"]["confirmed"], true,
            "{shape}: {}",
            document["verification"]
        );
        assert_eq!(document["hamiltonian"].as_array().expect("one for each interval").len(), 20);
        assert!(
            document["hamiltonian_check"]["deviation"].as_f64().expect("a number") < 0.01,
            "{shape}"
        );
        let optimum = |k: &str| {
            let document = solved(&folder, &[&["swing.fdc", "--set", k], &method[..]].concat());
            document["objective"].as_f64().expect("a number")
        };
        let difference = (optimum("k=2.001") - optimum("k=1.999")) / 0.002;
        let worth = document["sensitivities"]["k"].as_f64().expect("a number");
        assert!((worth - difference).abs() < 1e-5, "{shape}: {worth} and {difference}");
        let verified = fdcc(&folder, &["verify", &format!("{shape}/swing.sol.json"), "--json"], "");
        assert_eq!(json(&verified)["verification"]["confirmed"], true, "{shape}");
    }
}

/// `x = goal t` moves by `t`; a name that is mistyped is no parameter, and what has a kink no
/// derivative.
#[test]
fn how_the_optimum_moves_is_told() {
    let folder = ramp("moves");
    let document = solved(&folder, &["ramp.fdc", "--wrt", "goal"]);
    let moved = &document["derivatives"]["goal"];
    let x = column(&moved["states"]["x"]);
    let pairs = x.iter().zip(column(&moved["time"]));
    pairs.for_each(|(by, t)| assert!((by - t).abs() < 1e-6, "{by} at {t}"));
    assert!(document["free"] == moved["free"] && moved["junctions"] == serde_json::json!([]));
    let told = fdcc(&folder, &["solve", "ramp.fdc", "--log", "none", "--wrt", "goal"], "");
    assert!(stdout(&told).contains(" by    goal: states and controls move"), "{}", stdout(&told));
    let wrong = fdcc(&folder, &["solve", "ramp.fdc", "--wrt", "gaol"], "");
    expect_exit(&wrong, 3, "no parameter");
    assert!(stderr(&wrong).contains("did you mean `goal`?"), "{}", stderr(&wrong));
    let kinked = "param a = 0 time t in [0, 1] state x start 0 control u end x == 1
        dynamics { x' = u + abs(a) } minimize integral(u^2)";
    std::fs::write(folder.join("kinked.fdc"), kinked).expect("it can be written");
    let document = solved(&folder, &["kinked.fdc", "--wrt", "a"]);
    assert!(document["derivatives"]["a"].is_null(), "{}", document["derivatives"]);
}

/// The headline, the table, the verdict and the document tell which order was found; few long
/// intervals are replayed as closely as many short ones.
#[test]
fn the_order_that_was_found_is_told() {
    let model = "model swing\ntime t in [0, 4]\nstate x start 1\nstate v start 0\ncontrol u in \
                 [-3, 3]\n\
                 dynamics {\n  x' = v\n  v' = -2*x + u\n}\nend x == 0\nend v == 0\nminimize \
                 integral(u^2)\n\
                 method {\n  grid N = auto scheme radau\n  controls = polynomial\n  solver = \
                 interior_point\n}\n";
    let folder = folder("order_found", &[("swing.fdc", model.as_bytes())]);
    let arguments = ["swing.fdc", "--method", "tolerance=1e-8", "--out", "out"];
    let output = fdcc(&folder, &[&["solve", "--log", "full"], &arguments[..]].concat(), "");
    expect_exit(&output, 0, "the verdict");
    let (told, table) = (stdout(&output), stderr(&output));
    assert!(
        told.contains(" radau  N 10 ") && told.contains(" intervals of radau5, errors"),
        "{told}"
    );
    assert!(table.contains(" 10x3 ") && table.contains("x5 "), "{table}");
    let document = solved(&folder, &arguments);
    assert_eq!(document["method"]["scheme"], "radau5");
    assert!(number(&document["step_errors"]) <= 1e-8);
    assert!(number(&document["method"]["N"]) < 30.0);
    assert_eq!(document["verification"]["confirmed"], true, "{}", document["verification"]);
    let verified = fdcc(&folder, &["verify", "out/swing.sol.json", "--json"], "");
    assert_eq!(json(&verified)["verification"]["confirmed"], true);
    let given = fdcc(&folder, &["solve", "swing.fdc", "--method", "N=20"], "");
    expect_exit(&given, 3, "a given grid");
    assert!(
        stderr(&given).contains("write the number of stages, such as `radau3`"),
        "{}",
        stderr(&given)
    );
}

/// The earlier solution is cut at its jumps, each piece for itself.
#[test]
fn a_solution_with_jumps_is_a_warm_start() {
    let folder = folder("solve_warm_jumps", &[]);
    let bounce = model("bounce");
    let midpoint = ["solve", &bounce, "--method", "scheme=midpoint", "--log", "none", "--json"];
    let solve = |more: &[&str]| {
        let output = fdcc(&folder, &[&midpoint, more].concat(), "");
        expect_exit(&output, 0, &format!("{more:?}"));
        json(&output)
    };
    let cold = solve(&["--out", "."]);
    let near = solve(&["--set", "e=0.81"]);
    let warm = solve(&["--set", "e=0.81", "--warm", "bounce.sol.json", "--method", "N=200"]);
    // Those of the search for the true optimum, which has a start of its own, are not counted.
    let iterations = |it: &Value| number(&it["sequences"][0]["iterations"]);
    let [cold, near, warm] =
        [cold, near, warm].map(|it| (number(&it["objective"]), iterations(&it), it));
    assert!((near.0 - warm.0).abs() < 1e-6 * near.0 && near.0 < cold.0, "{} {}", near.0, warm.0);
    assert!(warm.1 < 0.7 * near.1, "{} iterations instead of {}", warm.1, near.1);
    assert_eq!(warm.2["jumps"][0]["jump"], "bounce");
    let other = solve(&["--warm", "bounce.sol.json", "--method", "N=50"]);
    assert!((number(&other["objective"]) - cold.0).abs() < 1e-3 * cold.0, "another grid");
    let sweep = ["sweep", &bounce, "e=0.7,0.8", "--continue", "--log", "none"];
    expect_exit(&fdcc(&folder, &sweep, ""), 0, "one after the other");
}

/// While friction is smoothed, `v' = -(mu g/sigma) v` near rest: `v` decays and is never 0.
#[test]
fn where_friction_alone_has_to_bring_something_to_rest_exactly_that_is_said_and_helps() {
    const SLED: &str = include_str!("../../tests/right/sled_on_ice.fdc");
    const SMOOTHED: [&str; 6] = ["solve", "--log", "none", "--no-verify", "--method", "sigma=0.01"];
    let advice = "end abs(slip) <= 0.0004";
    let [followed, free] = [advice, ""].map(|end| SLED.replace("end v == 0", end));
    let folder = folder(
        "rest",
        &[
            ("sled.fdc", SLED.as_bytes()),
            ("followed.fdc", followed.as_bytes()),
            ("free.fdc", free.as_bytes()),
        ],
    );
    for (arguments, code, is_said) in [
        (&["sled.fdc", "--method", "N=50", "--method", "max_iter=300"][..], 2, true),
        (&["followed.fdc"], 0, false),
        (&["free.fdc", "--method", "max_iter=3"], 2, false),
    ] {
        let output = fdcc(&folder, &[&SMOOTHED[..], arguments].concat(), "");
        expect_exit(&output, code, &format!("{arguments:?}"));
        assert_eq!(stdout(&output).contains(advice), is_said, "{arguments:?}: {}", stdout(&output));
    }
}
