//! `fdcc simulate` from outside: JSON, control files, exit codes.

use crate::common::{RAMP, expect_exit, fdcc, folder, json, model, number, stderr, stdout};

/// `v' in u - Sgn(v)` from rest.
const BLOCK: &str = "\
model block
param reach = 3
time t in [0, reach]
state v start 0
control u in [-4, 4] guess 0
surface slip = v
dynamics { v' in u - Sgn(slip) }
minimize integral(u^2)
";

const BALL: &str = "\
model ball
time t in [0, 2]
state h start 1
state v start 0
surface ground = h
dynamics {
  h' = v
  v' = -10
}
jump bounce on ground falling { v := -0.5*v }
";

fn near(value: &serde_json::Value, expected: f64) {
    assert!((number(value) - expected).abs() <= 1e-9, "{value}, not {expected}");
}

/// Example (2.3) with its closed form: crosses 0 at 1/3, ends at 5/3, objective 134/81.
#[test]
fn the_document_is_the_one_that_is_promised() {
    let folder = folder("simulate_document", &[]);
    let output = fdcc(&folder, &["simulate", &model("crossing"), "--json", "--times", "0,1"], "");
    expect_exit(&output, 0, "crossing");
    let found = json(&output);
    assert_eq!(found["status"], "completed");
    assert_eq!(found["events"][0]["surface"], "zero");
    assert_eq!(found["events"][0]["kind"], "crosses_up");
    near(&found["events"][0]["time"], 1.0 / 3.0);
    near(&found["events"][0]["state"]["x"], 0.0);
    near(&found["events"][0]["margin"], 1.0);
    near(&found["end"]["time"], 2.0);
    near(&found["end"]["x"], 5.0 / 3.0);
    near(&found["objective"], 134.0 / 81.0);
    near(&found["states"]["x"][1], 2.0 / 3.0);
    assert_eq!(found["time"].as_array().expect("times").len(), 2);
}

#[test]
fn parameters_can_be_set_and_files_are_written() {
    let folder = folder("simulate_files", &[("block.fdc", BLOCK.as_bytes())]);
    let output = fdcc(&folder, &["simulate", "block.fdc", "--set", "reach=1", "--out", "out"], "");
    expect_exit(&output, 0, "block");
    assert!(stdout(&output).contains("starts sliding"), "{}", stdout(&output));
    let table =
        std::fs::read_to_string(folder.join("out/block.sim.csv")).expect("the table is written");
    assert!(table.starts_with("t,v\n0,0\n") && table.ends_with("1,0\n"), "{table}");
    assert!(folder.join("out/block.sim.json").exists());
}

/// `u = 3` for a second gives `v = 2`, then friction stops the block within two more.
#[test]
fn a_table_of_controls_holds_each_row_to_the_next() {
    let files: [(&str, &[u8]); 2] =
        [("block.fdc", BLOCK.as_bytes()), ("u.csv", b"t,u\n0,3\n1,0\n")];
    let folder = folder("simulate_table", &files);
    let output = fdcc(
        &folder,
        &["simulate", "block.fdc", "--control", "u.csv", "--json", "--times", "1,2"],
        "",
    );
    expect_exit(&output, 0, "table");
    let found = json(&output);
    near(&found["states"]["v"][0], 2.0);
    near(&found["states"]["v"][1], 1.0);
    near(&found["objective"], 9.0);
}

/// With `u = 1` the solution is `x = t`; a smooth system has nothing to lose in the replay.
#[test]
fn a_solution_can_be_replayed() {
    let folder = folder("simulate_replay", &[("ramp.fdc", RAMP.as_bytes())]);
    expect_exit(&fdcc(&folder, &["solve", "ramp.fdc", "--out", "."], ""), 0, "solve");
    let output =
        fdcc(&folder, &["simulate", "ramp.fdc", "--control", "ramp.sol.json", "--json"], "");
    expect_exit(&output, 0, "replay");
    assert!((number(&json(&output)["end"]["x"]) - 1.0).abs() < 1e-7);
    assert_eq!(stderr(&output), "");
    let table = fdcc(&folder, &["simulate", "ramp.fdc", "--control", "ramp.csv"], "");
    expect_exit(&table, 0, "the table of a solve can be replayed, too");
    std::fs::write(folder.join("ramp.fdc"), format!("{RAMP}# changed\n"))
        .expect("a file can be written");
    let other = fdcc(&folder, &["simulate", "ramp.fdc", "--control", "ramp.sol.json"], "");
    expect_exit(&other, 0, "a solution of another text is taken");
    assert!(stderr(&other).contains("not the text that was solved"), "{}", stderr(&other));
}

#[test]
fn bad_control_files_say_what_is_wrong() {
    let solution = |times: &str, controls: &str| {
        format!("{{\"free\": {{}}, \"states\": {{}}, \"time\": {times}, \"controls\": {controls}}}")
    };
    let [backwards, short, hole, other, empty] = [
        solution("[0, 2, 1]", "{\"u\": [1, 1]}"),
        solution("[0, 1, 2]", "{\"u\": [1]}"),
        solution("[0, 1]", "{\"u\": [null]}"),
        solution("[0, 1]", "{\"w\": [1]}"),
        solution("[]", "{\"u\": []}"),
    ];
    let cases: [(&str, &str, &str); 20] = [
        ("u.csv", "time,u\n0,1\n", "must be `t`"),
        ("u.csv", "t,w\n0,1\n", "`w` is no control"),
        ("u.csv", "t\n0\n", "no column for the control `u`"),
        ("u.csv", "t,u\n0,1\n0.5\n", "line 3: 1 columns"),
        ("u.csv", "t,u\n0,1\n1,nan\n", "line 3: `nan` of `u` is no number"),
        ("u.csv", "t,u\n1,1\n0,1\n", "times must ascend, but 0 follows 1 in row 2"),
        ("u.csv", "t,u\n", "no row of values"),
        ("u.csv", "", "the file is empty"),
        ("u.csv", "t;u\n0;1\n", "the first line looks like `t,u`"),
        ("u.csv", "0,1\n1,1\n", "the first column is `0`, but must be `t`"),
        ("u.csv", "t,u,u\n0,1,2\n", "two columns `u`"),
        ("u.csv", "t,u\n0,1e400\n", "line 2: `1e400` of `u` is no number"),
        ("u.csv", "t,u\n0,one\n", "line 2: `one` of `u` is no number"),
        ("u.csv", "t,u\n0,1\n0,1\n0,2\n", "line 4: a third row at t = 0; a jump has two sides"),
        ("u.json", &backwards, "times must ascend, but 1 follows 2"),
        ("u.json", &short, "`controls.u` has 1 values where there should be 2"),
        ("u.json", &hole, "value 1 of `controls.u` is no number"),
        ("u.json", &other, "there is no control `u`"),
        ("u.json", &empty, "there is no row of values"),
        ("u.json", "{\"time\": 3}", "not a solution"),
    ];
    for (name, content, message) in cases {
        let files: [(&str, &[u8]); 2] =
            [("block.fdc", BLOCK.as_bytes()), (name, content.as_bytes())];
        let folder = folder("simulate_bad_controls", &files);
        let output = fdcc(&folder, &["simulate", "block.fdc", "--control", name], "");
        expect_exit(&output, 4, message);
        assert!(stderr(&output).contains(message), "{message}: {}", stderr(&output));
    }
}

/// The logarithm has no value beyond `x = 1`, and then its maximum with 0 has none either.
#[test]
fn a_maximum_of_what_has_no_value_ends_a_simulation() {
    for right in ["max(log(x - 1), 0)", "max(0, log(x - 1))", "-min(-log(x - 1), 0)"] {
        let text = format!(
            "time t in [0, 2]\nstate x start 2\ndynamics {{ x' = -1 + {right} }}\nminimize x(end)\n"
        );
        let folder = folder("simulate_undefined", &[("undefined.fdc", text.as_bytes())]);
        let output = fdcc(&folder, &["simulate", "undefined.fdc"], "");
        expect_exit(&output, 2, right);
        assert!(stdout(&output).contains("not finite: `x'` (line 3) at t = 1"), "{output:?}");
    }
}

/// What can be followed is followed, with a word about what is likely a slip.
#[test]
fn times_that_do_not_fit_are_told() {
    let cases = [
        ("t,u\n0,1\n3,2\n", ""),
        ("t,u\n0,1\n4,2\n", "1 row begins after the last time, 3: not used"),
        ("t,u\n0,1\n4,2\n5,2\n", "2 rows begin after the last time, 3: not used"),
        ("t,u\n1,1\n", "the first row begins at 1: used from 0 on"),
        ("\u{feff}t , u\r\n\r\n0 , 1\r\n", ""),
    ];
    for (content, message) in cases {
        let files: [(&str, &[u8]); 2] =
            [("block.fdc", BLOCK.as_bytes()), ("u.csv", content.as_bytes())];
        let folder = folder("simulate_times", &files);
        let output = fdcc(&folder, &["simulate", "block.fdc", "--control", "u.csv"], "");
        expect_exit(&output, 0, content);
        let said = stderr(&output);
        assert!(
            if message.is_empty() { said.is_empty() } else { said.contains(message) },
            "{content}: {said}"
        );
    }
}

/// The line and the name of what has no value, with the trajectory so far.
#[test]
fn a_value_that_does_not_exist_has_its_place() {
    let start = "free c in [-2, -1] guess -1  time t in [0, 1]\nstate x\n  start log(c)\n\
                 dynamics { x' = 1 }\n";
    let rate = "free c in [-2, -1] guess -1\ntime t in [0, 1]\nstate x start 0\n\
                dynamics {\n  x' = log(c) + x\n}\n";
    let guess = "time t in [0, 1]\nstate x start 0\ncontrol u guess log(t - 0.5)\ndynamics {\n  x' \
                 = u\n}\n";
    let surface = "time t in [0, 1]\nstate x start 0.5\nsurface s = sqrt(x - 1)\ndynamics { x' in \
                   1 - Sgn(s) }\n";
    let growth = "time t in [0, 2]\nstate x start 1\ndynamics {\n  x' = x^2\n}\n";
    let cases = [
        (start, "x(start)", 2, 0.0),
        (rate, "x'", 5, 0.0),
        (guess, "x'", 5, 0.0),
        (surface, "s", 3, 0.0),
        (growth, "x'", 4, 1.0),
    ];
    for (text, of, line, time) in cases {
        let folder = folder("simulate_place", &[("model.fdc", text.as_bytes())]);
        let output = fdcc(&folder, &["simulate", "model.fdc", "--json"], "");
        expect_exit(&output, 2, text);
        let found = json(&output);
        let why = &found["not_finite"];
        assert_eq!(
            (&found["status"], &why["of"], &why["line"]),
            (&"not_finite".into(), &of.into(), &line.into())
        );
        assert!((number(&why["time"]) - time).abs() < 1e-6, "{text}: {why}");
        assert!(!found["time"].as_array().expect("times").is_empty(), "{text}");
        let grad = fdcc(&folder, &["grad", "model.fdc", "--of", "x(end)", "--wrt", "x(start)"], "");
        expect_exit(&grad, 2, text);
        assert!(stdout(&grad).contains("NO GRADIENT"), "{text}: {}", stdout(&grad));
    }
}

#[test]
fn what_cannot_be_continued_says_why() {
    let repelling =
        "time t in [0, 1]\nstate x start 0\nsurface edge = x\ndynamics { x' in 2*Sgn(edge) }\n";
    let undefined = "time t in [0, 2]\nstate x start 1\ndynamics {\n  x' = -1/sqrt(x)\n}\n";
    let at_once = "time t in [0, 2]\nstate x start 0\ndynamics {\n  x' = log(x - 1)\n}\n";
    // Any number from 1 to 2 is a rate of q where h rests.
    let resting = "time t in [0, 1]
state h start 0
state v start 0
state q start 0
surface ground = h
dynamics {
  h' = v
  v' = 0
  q' in match ground { below => 1, above => 2 }
}
jump stop on ground falling at most 3 { v := 0 }
";
    let files: [(&str, &[u8]); 5] = [
        ("ball.fdc", BALL.as_bytes()),
        ("resting.fdc", resting.as_bytes()),
        ("repelling.fdc", repelling.as_bytes()),
        ("undefined.fdc", undefined.as_bytes()),
        ("at_once.fdc", at_once.as_bytes()),
    ];
    let folder = folder("simulate_refusals", &files);
    let run = |file: &str| {
        let output = fdcc(&folder, &["simulate", file, "--json"], "");
        expect_exit(&output, 2, file);
        json(&output)
    };
    let zeno = run("ball.fdc");
    assert_eq!(
        (zeno["status"].as_str(), zeno["zeno"]["jump"].as_str()),
        (Some("zeno"), Some("bounce"))
    );
    near(&zeno["zeno"]["limit_time"], 3.0 * 0.2_f64.sqrt());
    let several = run("repelling.fdc");
    assert_eq!(several["not_unique"]["candidates"], serde_json::json!(["up", "down", "slide"]));
    assert_eq!(several["not_unique"]["surface"], "edge");
    let resting = run("resting.fdc");
    assert_eq!(resting["not_unique"]["candidates"], serde_json::json!(["up", "down", "slide"]));
    let undefined = run("undefined.fdc");
    assert_eq!(
        (&undefined["status"], &undefined["not_finite"]["line"]),
        (&"not_finite".into(), &4.into())
    );
    near(&undefined["not_finite"]["time"], 2.0 / 3.0);
    near(&run("at_once.fdc")["not_finite"]["time"], 0.0);
}

#[test]
fn a_time_limit_keeps_the_trajectory_so_far() {
    let text = "time t in [0, 1e6]  state x start 1  state y start 0\ndynamics { x' = 1000*y  y' = \
                -1000*x }\n";
    let folder = folder("simulate_time_limit", &[("fast.fdc", text.as_bytes())]);
    let output = fdcc(
        &folder,
        &["simulate", "fast.fdc", "--json", "--time-limit", "0.05", "--starts", "3"],
        "",
    );
    expect_exit(&output, 2, "the time is up");
    let found = json(&output);
    assert_eq!(found["status"], "time_limit");
    let reached = found["time_limit"]["time"].as_f64().expect("a time");
    assert!(reached > 0.0 && reached < 1e6, "{reached}");
    assert!(stderr(&output).contains("a simulation searches nothing"), "{}", stderr(&output));
}

#[test]
fn wrong_usage_is_told() {
    let folder = folder("simulate_usage", &[("block.fdc", BLOCK.as_bytes())]);
    for (arguments, code) in [
        (vec!["--times", "2,1"], 3),
        (vec!["--times", "7"], 3),
        (vec!["--times", "-1,0"], 3),
        (vec!["--atol", "-1"], 3),
        (vec!["--set", "reach=-1"], 3),
        (vec!["--set", "reach=1e999"], 3),
        (vec!["--control", "absent.csv"], 4),
    ] {
        let output =
            fdcc(&folder, &[&["simulate", "block.fdc"], arguments.as_slice()].concat(), "");
        expect_exit(&output, code, arguments[1]);
    }
}

const HOP: &str = "\
model hop
time t in [0, 1]
state h start 1
state v start 0
control u in [-5, 5]
surface ground = h
dynamics {
  h' = v
  v' = u - 10
}
jump bounce on ground falling at most 1 { v := -v/2 }
end h == 0.3
minimize integral(u^2)
method { N = 10  scheme = midpoint }
";

/// A ball from a height of 1 meets the ground with `v = -sqrt(20)`.
#[test]
fn events_tell_the_states_on_both_sides() {
    let folder = folder("simulate_sides", &[("ball.fdc", BALL.as_bytes())]);
    let output = fdcc(&folder, &["simulate", "ball.fdc", "--json", "--out", "out"], "");
    let event = &json(&output)["events"][0];
    near(&event["before"]["v"], -20.0_f64.sqrt());
    near(&event["after"]["v"], 0.5 * 20.0_f64.sqrt());
    assert_eq!(event["after"], event["state"]);
    let table =
        std::fs::read_to_string(folder.join("out/ball.sim.csv")).expect("the table is written");
    let time = format!("{},", number(&event["time"]));
    assert_eq!(table.lines().filter(|line| line.starts_with(&time)).count(), 2, "{table}");
}

/// The grid has a point at the jump, and the table two rows.
#[test]
fn the_table_of_a_solve_has_both_sides_of_a_jump() {
    let folder = folder("simulate_hop", &[("hop.fdc", HOP.as_bytes())]);
    expect_exit(&fdcc(&folder, &["solve", "hop.fdc", "--out", "."], ""), 0, "hop");
    let read =
        |name: &str| std::fs::read_to_string(folder.join(name)).expect("the file is written");
    let table = read("hop.csv");
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|it| it.parse().expect("a number")).collect())
        .collect();
    let jump =
        rows.windows(2).position(|pair| pair[0][0] == pair[1][0]).expect("two rows at one time");
    let [before, after] = [rows[jump][2], rows[jump + 1][2]];
    assert!(before < -1.0 && (after + 0.5 * before).abs() < 1e-9, "{before}, then {after}");
    assert!(rows[jump][3] == rows[jump - 1][3] && rows[jump][3] != rows[jump + 1][3], "{table}");
    let [of_table, of_solution] = ["hop.csv", "hop.sol.json"].map(|controls| {
        let output = fdcc(&folder, &["simulate", "hop.fdc", "--control", controls, "--json"], "");
        expect_exit(&output, 0, controls);
        number(&json(&output)["end"]["h"])
    });
    // In the table a polynomial is held constant on each interval.
    assert!((of_table - 0.3).abs() < 1e-3 && (of_solution - 0.3).abs() < 1e-7, "{of_table}");
}

/// A force of a millionth of a second between two stages of a step is seen by no method; shorter
/// steps see it.
#[test]
fn steps_can_be_limited() {
    let text =
        "time t in [0, 1]\nstate v start 0\ndynamics { v' = 1e6*exp(-((t - 0.7)/1e-6)^2) }\n";
    let folder = folder("simulate_steps", &[("kick.fdc", text.as_bytes())]);
    let end = |options: &[&str]| {
        let output = fdcc(&folder, &[&["simulate", "kick.fdc", "--json"], options].concat(), "");
        expect_exit(&output, 0, "kick");
        number(&json(&output)["end"]["v"])
    };
    assert!(end(&[]) < 0.1);
    assert!((end(&["--max-step", "1e-5"]) - std::f64::consts::PI.sqrt()).abs() < 1e-6);
    for wrong in ["0", "-1", "nan", "x"] {
        expect_exit(&fdcc(&folder, &["simulate", "kick.fdc", "--max-step", wrong], ""), 3, wrong);
    }
}

/// Regular crossings pile up nowhere, however long the whole time is; what overflows has no value.
#[test]
fn enormous_numbers_end_with_an_honest_status() {
    let clock = "time t in [0, 2e302]\nstate x start 1\nstate v start 0\nsurface s = x\nstate y \
                 start 0\n\
                 dynamics {\n x' = v\n v' = -x\n y' in Sgn(s)\n}\n";
    let push = "time t in [0, 10]\nstate v start 0\ncontrol u in [-1e300, 1e300] guess 1e300\n\
                dynamics { v' = u }\nminimize integral(u^2)\n";
    let slow = "time t in [0, 2e302]\nstate x start 1\nsurface s = x - 2\nstate y start 0\n\
                dynamics {\n x' = 1e-302\n y' in Sgn(s)\n}\n";
    // The number of steps ends the clock on a fast machine, the time on a slow one.
    let cases = [
        ("clock", clock, "time_limit step_limit"),
        ("push", push, "not_finite"),
        ("slow", slow, "completed"),
    ];
    for (name, text, statuses) in cases {
        let folder = folder(&format!("simulate_{name}"), &[("big.fdc", text.as_bytes())]);
        let output = fdcc(&folder, &["simulate", "big.fdc", "--json", "--time-limit", "1"], "");
        let found = json(&output)["status"].as_str().expect("a status").to_owned();
        assert!(statuses.split(' ').any(|it| it == found), "{name}: {found}");
    }
}

/// Where nothing is searched an unknown is a number like a parameter, within its bounds.
#[test]
fn unknowns_are_given_values() {
    let run = "param v = 2 [m/s]\nfree T in [1, 9] [min] guess 3\ntime t in [0, T] [min]\n\
               state x [m] start 0\ndynamics { x' = v }\nminimize x(end)\n";
    let folder = folder("simulate_unknowns", &[("run.fdc", run.as_bytes())]);
    let end = |set: &str| {
        let output = fdcc(&folder, &["simulate", "run.fdc", "--json", "--set", set], "");
        number(&json(&output)["end"]["x"])
    };
    assert_eq!([end("v=2"), end("T=4"), end("T=120[s]")].map(f64::round), [360.0, 480.0, 240.0]);
    let grad = fdcc(&folder, &["grad", "run.fdc", "--json", "--set", "T=4"], "");
    assert_eq!(number(&json(&grad)["gradient"]["v"]).round(), 240.0);
    let far = fdcc(&folder, &["simulate", "run.fdc", "--set", "T=10"], "");
    assert!(stderr(&far).contains("`T` must be in [1, 9] min, not 10"), "{}", stderr(&far));
    let solve = fdcc(&folder, &["solve", "run.fdc", "--set", "T=4"], "");
    assert!(stderr(&solve).contains("`T` is an unknown"), "{}", stderr(&solve));
}

/// The order of the text is one of two, and is said to be.
#[test]
fn jumps_whose_order_matters_are_told() {
    let two = "time t in [0, 1]\nstate x start 0\nstate z start 1\nsurface p = x - 0.5\n\
               surface q = 2*x - 1\ndynamics { x' = 1  z' = 0 }\n\
               jump a on p rising { z := z + 1 }\njump b on q rising { z := 2*z }\n";
    let folder = folder("simulate_orders", &[("two.fdc", two.as_bytes())]);
    let output = fdcc(&folder, &["simulate", "two.fdc"], "");
    let told = "note: `a` and `b` jump together at t = 0.5, and lead elsewhere in the other order";
    assert!(stdout(&output).contains(told), "{}", stdout(&output));
    let document = json(&fdcc(&folder, &["simulate", "two.fdc", "--json"], ""));
    let order = &document["orders"][0];
    assert_eq!(order["jumps"], serde_json::json!(["a", "b"]));
    assert!((number(&order["time"]) - 0.5).abs() < 1e-12, "{order}");
}
