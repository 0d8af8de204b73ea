//! `fdcc verify`: a solution against the true system. The solutions are written by hand, so that
//! all differences are known.

use crate::common::{
    RAMP, column, expect_exit, fdcc, folder, json, number, smoothed_race_car, stderr, stdout,
};
use serde_json::Value;
use std::path::Path;

/// Friction of 1 on a block of mass 1, pulled by .5 (sticks), by 3 (reaches 2), by 0 (stops after
/// two more).
const PULLED: &str = "\
model pulled
time t in [0, 5]
state x start 0
state v start 0
control u in [-4, 4]
surface slip = v
dynamics {
  x' = v
  v' in u - Sgn(slip)
}
end v == 0
minimize integral(u^2)
";

const PULLED_SOLUTION: &str = r#"{"model": "pulled", "objective": 9.25, "free": {}, "params": {},
  "time": [0, 1, 2, 3, 4, 5], "states": {"x": [0, 0, 1, 2.5, 3, 3], "v": [0, 0, 2, 1, 0, 0]},
  "controls": {"u": [0.5, 3, 0, 0, 0]}}"#;

/// `x = t - t^2` has its top, .25, in the middle of the only interval.
const ARC: &str = "\
model arc
param top = 0.2
param pull = -2
time t in [0, 1]
state x start 0
state v start free
control u in [-9, 9]
dynamics {
  x' = v
  v' = u + pull
}
path low: x <= top
end x == 0
minimize v(start)
";

const ARC_SOLUTION: &str = r#"{"model": "arc", "free": {}, "params": {"top": 0.2, "pull": -2},
  "time": [0, 1], "states": {"x": [0, 0], "v": [1, -1]}, "controls": {"u": [0]}}"#;

fn near(value: &Value, expected: f64) {
    assert!((number(value) - expected).abs() <= 1e-9, "{value}, not {expected}");
}

fn verified(folder: &Path, arguments: &[&str], code: i32) -> Value {
    let output = fdcc(folder, &[&["verify"], arguments, &["--json"]].concat(), "");
    expect_exit(&output, code, &format!("{arguments:?}"));
    json(&output)
}

#[test]
fn modes_and_events_are_those_of_the_closed_form() {
    let files =
        [("pulled.fdc", PULLED.as_bytes()), ("pulled.sol.json", PULLED_SOLUTION.as_bytes())];
    let folder = folder("verify_modes", &files);
    let found = verified(&folder, &["pulled.sol.json"], 0);
    assert_eq!(
        (&found["status"], &found["verification"]["confirmed"]),
        (&"completed".into(), &true.into())
    );
    let expected = [("held", 0.0, 1.0), ("above", 1.0, 4.0), ("held", 4.0, 5.0)];
    let slip = found["surfaces"]["slip"].as_array().expect("spans");
    assert_eq!(slip.len(), expected.len(), "{slip:?}");
    for (span, (mode, from, to)) in slip.iter().zip(expected) {
        assert_eq!(span["mode"], mode);
        near(&span["from"], from);
        near(&span["to"], to);
    }
    near(&found["verification"]["objective"], 9.25);
    near(&found["objective"], 9.25);
    near(&found["verification"]["state_gap"], 0.0);
    assert_eq!(found["verification"]["events"], found["events"].as_array().expect("events").len());
}

/// A solution that is off by 1 of 3 at t = 2 and ends off by .25.
#[test]
fn the_gap_of_each_state_has_its_time() {
    let wrong = PULLED_SOLUTION.replace("[0, 0, 2, 1, 0, 0]", "[0, 0, 3, 1, 0, 0.25]");
    let files = [("pulled.fdc", PULLED.as_bytes()), ("pulled.sol.json", wrong.as_bytes())];
    let folder = folder("verify_gap", &files);
    let found = verified(&folder, &["pulled.sol.json"], 2);
    near(&found["state_gaps"]["v"]["gap"], 1.0 / 3.0);
    near(&found["state_gaps"]["v"]["time"], 2.0);
    near(&found["state_gaps"]["x"]["gap"], 0.0);
    near(&found["conditions"]["end v == 0"]["violation"], 0.0);
    assert_eq!(
        verified(&folder, &["pulled.sol.json", "--gap", "0.4"], 0)["verification"]["asked"],
        0.4
    );
    let said = stdout(&fdcc(&folder, &["verify", "pulled.sol.json"], ""));
    assert!(
        said.starts_with(
            " NOT CONFIRMED on the true system: `v` differs by 1, 0.333333 of its motion"
        ),
        "{said}"
    );
}

#[test]
fn path_conditions_are_looked_at_between_the_grid_points() {
    let files = [("arc.fdc", ARC.as_bytes()), ("arc.sol.json", ARC_SOLUTION.as_bytes())];
    let folder = folder("verify_between", &files);
    let found = verified(&folder, &["arc.sol.json"], 2);
    let worst = &found["verification"]["worst"];
    assert_eq!(worst["condition"], "low");
    near(&worst["violation"], 0.05);
    near(&worst["time"], 0.5);
    near(&worst["state"]["x"], 0.25);
    near(&found["verification"]["state_gap"], 0.0);
    let said = stdout(&fdcc(&folder, &["verify", "arc.sol.json"], ""));
    assert!(said.contains("violates `low` by 0.05"), "{said}");
    assert!(said.contains("worst at t = 0.5: x = 0.25"), "{said}");
}

/// With half the pull, half the speed at the start gives half the height; bounds move with their
/// parameters.
#[test]
fn parameters_and_open_starts_are_those_of_the_solution() {
    let other = ARC_SOLUTION
        .replace(r#""top": 0.2, "pull": -2"#, r#""top": 0.125, "pull": -1"#)
        .replace("[1, -1]", "[0.5, -0.5]");
    let files = [("arc.fdc", ARC.as_bytes()), ("arc.sol.json", other.as_bytes())];
    let folder = folder("verify_parameters", &files);
    verified(&folder, &["arc.sol.json"], 0);
    let replay = ["simulate", "arc.fdc", "--control", "arc.sol.json", "--times", "0.5", "--json"];
    near(&json(&fdcc(&folder, &replay, ""))["states"]["x"][0], 0.125);
    let changed = [&replay[..], &["--set", "pull=-3"]].concat();
    let x = &json(&fdcc(&folder, &changed, ""))["states"]["x"][0];
    near(x, 0.25 - 0.375);
}

/// `solve` and `verify` say the same of the same solution; `--gap` is an option of both.
#[test]
fn a_solve_and_its_verification_agree() {
    let folder = folder("verify_agrees", &[]);
    let solve = ["solve", &smoothed_race_car(), "--out", ".", "--json", "--log", "none"];
    let solved = json(&fdcc(&folder, &solve, ""));
    let found = verified(&folder, &["racecar.sol.json", &smoothed_race_car()], 2);
    assert_eq!(found["verification"], solved["verification"]);
    assert_eq!(found["same_source"], true);
    let generous = json(&fdcc(&folder, &[&solve[..], &["--gap", "0.5"]].concat(), ""));
    assert_eq!(generous["verification"]["confirmed"], true);
    assert_eq!(column(&generous["time"]), column(&solved["time"]));
}

#[test]
fn the_model_is_found_or_asked_for() {
    let files = [
        ("out/pulled.sol.json", PULLED_SOLUTION.as_bytes()),
        ("other.fdc", PULLED.as_bytes()),
        ("ramp.fdc", RAMP.as_bytes()),
    ];
    let folder = folder("verify_model", &[]);
    std::fs::create_dir(folder.join("out")).expect("a folder can be made");
    for (name, content) in files {
        std::fs::write(folder.join(name), content).expect("a file can be written");
    }
    let cases: &[(&[&str], i32, &str)] = &[
        (&["out/pulled.sol.json"], 4, "its model pulled.fdc is neither beside it nor here"),
        (&["out/pulled.sol.json", "absent.fdc"], 4, "absent.fdc cannot be read"),
        (&["out/pulled.sol.json", "other.fdc"], 0, "other.fdc is not the text that was solved"),
        (
            &["out/pulled.sol.json", "ramp.fdc"],
            4,
            "its time runs from 0 to 5, that of the model from 0 to 1",
        ),
        (&["absent.sol.json"], 4, "absent.sol.json cannot be read"),
        (&["other.fdc"], 4, "other.fdc is not a solution"),
        (&["out/pulled.sol.json", "other.fdc", "--gap", "-1"], 3, "not negative"),
        (&[], 3, ""),
    ];
    for (arguments, code, message) in cases {
        let output = fdcc(&folder, &[&["verify"], *arguments].concat(), "");
        expect_exit(&output, *code, &format!("{arguments:?}"));
        assert!(stderr(&output).contains(message), "{arguments:?}: {}", stderr(&output));
    }
    std::fs::copy(folder.join("other.fdc"), folder.join("pulled.fdc"))
        .expect("a file can be copied");
    expect_exit(&fdcc(&folder, &["verify", "out/pulled.sol.json"], ""), 0, "the current folder");
}

/// On the edge the state could go up, down or stay.
#[test]
fn a_replay_that_does_not_reach_the_end_is_no_confirmation() {
    let edge = "model edge\ntime t in [0, 2]\nstate x start -1\ncontrol u in [-9, 9]\nsurface top \
                = x\n\
                dynamics { x' in u + 2*Sgn(top) }\nminimize integral(u^2)\n";
    let solution = r#"{"model": "edge", "free": {}, "time": [0, 1, 2], "states": {"x": [-1, 0, 0]},
        "controls": {"u": [3, 0]}}"#;
    let folder = folder(
        "verify_edge",
        &[("edge.fdc", edge.as_bytes()), ("edge.sol.json", solution.as_bytes())],
    );
    let found = verified(&folder, &["edge.sol.json"], 2);
    assert_eq!(found["status"], "not_unique");
    assert_eq!(
        (&found["verification"]["completed"], &found["verification"]["state_gap"]),
        (&false.into(), &Value::Null)
    );
    near(&found["not_unique"]["time"], 1.0);
    let said = stdout(&fdcc(&folder, &["verify", "edge.sol.json"], ""));
    assert!(said.contains("does not reach the end") && said.contains("several ways"), "{said}");
}

/// Falls for a second and comes back with half the speed for another one.
const DROP: &str = "\
model drop
free e in [0, 1] guess 0.5
time t in [0, 1.75]
state h start 4.905
state v start 0
surface ground = h
dynamics {
  h' = v
  v' = -9.81
}
jump bounce on ground falling at most 1 { v := -e*v }
minimize e
";

/// A jump that comes a thousandth too late is off by a thousandth, not by the height of the jump;
/// one that does not come at all is.
#[test]
fn jumps_are_compared_with_jumps() {
    let late = 1.001;
    let (before, after) = (0.5 / late, (1.375 - late) / (1.75 - late) * 0.75);
    let states =
        |t: f64, height: f64, speed: f64| (height + speed * t - 4.905 * t * t, speed - 9.81 * t);
    let points = [
        (4.905, 0.0),
        states(before, 4.905, 0.0),
        (0.0, 4.905),
        states(after, 0.0, 4.905),
        states(0.75, 0.0, 4.905),
    ];
    let column = |of: fn(&(f64, f64)) -> f64| {
        points.iter().map(of).map(|it| it.to_string()).collect::<Vec<_>>().join(", ")
    };
    let solution = |jumps: &str| {
        format!(
            r#"{{"model": "drop", "free": {{"e": 0.5}}, "params": {{}},
              "time": [0, 0.5, {late}, 1.375, 1.75],
              "states": {{"h": [{}], "v": [{}]}}, "controls": {{}}{jumps}}}"#,
            column(|it| it.0),
            column(|it| it.1)
        )
    };
    let with = solution(r#", "jumps": [{"jump": "bounce", "time": 1.001}]"#);
    let folder = folder(
        "verify_jumps",
        &[
            ("drop.fdc", DROP.as_bytes()),
            ("with.sol.json", with.as_bytes()),
            ("without.sol.json", solution("").as_bytes()),
        ],
    );
    let document = verified(&folder, &["with.sol.json", "--gap", "7e-4"], 0);
    let gap = |state: &str| number(&document["state_gaps"][state]["gap"]);
    assert!((gap("time of bounce") - 0.001 / 1.75).abs() < 1e-9, "{document}");
    assert!(gap("h") < 1e-7 && gap("v") < 1e-7, "{document}");
    let document = verified(&folder, &["without.sol.json", "--gap", "7e-4"], 2);
    assert!(number(&document["verification"]["state_gap"]) > 7e-4, "{document}");
}

/// `x = t` passes a peak or a band of 2e-4 where no point of the replay is, or one on its flank.
#[test]
fn path_conditions_are_watched_between_the_points() {
    for (at, path) in [
        (0.5047, "exp(-((x - 0.5047)/1e-4)^2) <= 0.5"),
        (0.50371, "exp(-((x - 0.50371)/1e-4)^2) <= 0.5"),
        (0.50033, "1/(1 + ((x - 0.50033)/1e-4)^2) <= 0.5"),
        (0.50371, "((x - 0.50371)/1e-4)^2 >= 1"),
        (0.50371, "exp(-((x - c)/w)^2) <= 0.5"),
    ] {
        let text = format!(
            "\
model spike
param c = 0.50371
param w = 1e-4
time t in [0, 1]
state x start 0
state y start 2*c + w
control u in [-2, 2]
dynamics {{ x' = u  y' = 0 }}
path bump: {path}
end x == 1
minimize integral(u^2)
method {{ N = 10 }}
"
        );
        let folder = folder("verify_spike", &[("spike.fdc", text.as_bytes())]);
        expect_exit(&fdcc(&folder, &["solve", "spike.fdc", "--out", "."], ""), 0, "spike");
        let output = fdcc(&folder, &["verify", "spike.sol.json", "spike.fdc", "--json"], "");
        let found = json(&output);
        let bump = &found["conditions"]["bump"];
        assert_eq!(found["verification"]["confirmed"], false, "{path}");
        assert!(number(&bump["violation"]) > 0.49, "{path}: {bump}");
        assert!((number(&bump["time"]) - at).abs() < 1e-5, "{path}: {bump}");
        let state = &found["verification"]["worst"]["state"];
        assert!((number(&state["x"]) - at).abs() < 1e-7, "{path}: {state}");
    }
}
