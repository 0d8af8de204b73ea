//! Models with phases from the command line: documents, files, starts.

use crate::common::*;
use serde_json::Value;

const HOP: &[u8] = b"model hop\n\
phase up {\n  time t in [0, 1] [s]\n  state h [m] start 0\n  state v [m/s] start 0\n\
  control a in [-4, 4] [m/s^2]\n  dynamics { h' = v  v' = a }\n  minimize integral(a^2)\n}\n\
phase down {\n  time t in [1, 3] [s]\n  state h [m]\n  state v [m/s]\n\
  control a in [-4, 4] [m/s^2]\n  dynamics { h' = v  v' = a }\n  end h == 0\n  end v == 0\n\
  minimize integral(a^2)\n  method { grid N = 40 scheme midpoint }\n}\n\
link up -> down { h := h  v := v + 1 [m/s] }\n\
method { grid N = 20 scheme midpoint }\n";

fn solved(folder: &std::path::Path, arguments: &[&str]) -> Value {
    json(&fdcc(folder, &[&["solve", "hop.fdc", "--json"], arguments].concat(), ""))
}

/// The value of a signal at its first or last point.
fn at(document: &Value, phase: &str, kind: &str, name: &str, is_last: bool) -> f64 {
    let column = document["phases"][phase][kind][name].as_array().expect("a signal");
    let value = if is_last { column.last() } else { column.first() };
    value.and_then(Value::as_f64).expect("a number")
}

#[test]
fn each_phase_has_its_signals_and_links_hold() {
    let folder = folder("phases_signals", &[("hop.fdc", HOP)]);
    let document = solved(&folder, &[]);
    assert_eq!(document["status"], "solved");
    assert_eq!(document["states"], serde_json::json!({}));
    assert_eq!(document["phases"]["up"]["time"].as_array().map(Vec::len), Some(21));
    assert_eq!(document["phases"]["down"]["time"].as_array().map(Vec::len), Some(41));
    let end = |name| at(&document, "up", "states", name, true);
    let start = |name| at(&document, "down", "states", name, false);
    assert!((start("h") - end("h")).abs() < 1e-9);
    assert!((start("v") - end("v") - 1.0).abs() < 1e-9);
    // The costate goes through a link whose reset adds a constant.
    for name in ["h", "v"] {
        let before = at(&document, "up", "costates", name, true);
        let after = at(&document, "down", "costates", name, false);
        assert!((before - after).abs() < 1e-6 * after.abs().max(1.0), "{name}: {before} {after}");
    }
    assert_eq!(document["verification"]["confirmed"], true);
    assert_eq!(document["verification"]["phase_by_phase"], true);
    assert_eq!(document["phases"]["down"]["verification"]["confirmed"], true);
    assert_eq!(document["phases"]["down"]["verification"].get("phase_by_phase"), None);
}

/// A model of phases has its own `expect`.
#[test]
fn a_staged_flight_meets_its_expectation() {
    let folder = folder("phases_twostage", &[]);
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/twostage.fdc");
    let output = fdcc(&folder, &["test", model], "");
    assert!(output.status.success(), "{}", stderr(&output));
}

/// A phase for each file of `--data`, in every form of output: the files stand elsewhere.
#[test]
fn phases_of_files_are_told_by_number_and_file() {
    let folder = folder("phases_of_files", &[]);
    let files = format!("{}/../tests/classics/fits", env!("CARGO_MANIFEST_DIR"));
    let model = classic("fits/cups");
    std::fs::copy(&model, folder.join("cups.fdc")).expect("the model can be copied");
    let lost = fdcc(&folder, &["check", "cups.fdc"], "");
    expect_exit(&lost, 1, "no file beside the copy");
    assert!(stdout(&lost).contains("no file matches `cups_*.csv`"), "{}", stdout(&lost));
    let output = fdcc(&folder, &["solve", "cups.fdc", "--data", &files, "--out", "."], "");
    expect_exit(&output, 0, &stderr(&output));
    let words = stdout(&output);
    assert!(words.contains("cup[3].x in 7 rows of cups_10.csv"), "{words}");
    assert!(folder.join("cups.cup[2].csv").exists(), "{words}");
    let text = std::fs::read_to_string(folder.join("cups.sol.json")).expect("it was written");
    let document: Value = serde_json::from_str(&text).expect("it is JSON");
    for (phase, end) in [("cup[1]", 20.0), ("cup[2]", 30.0), ("cup[3]", 12.0)] {
        let time = column(&document["phases"][phase]["time"]);
        assert_eq!(time.last(), Some(&end), "{phase}");
    }
    assert_eq!(document["residuals"][1]["data"], "cups_2.csv");
    let hot = number(&document["free"]["cup[3].hot"]);
    assert!((hot - 92.0090864).abs() < 1e-5, "{hot}");
}

/// Of many experiments the first are told, and how many more there are; JSON has them all.
#[test]
fn many_phases_are_told_in_a_few_lines() {
    let text = "model decay
free rate in [0.1, 9] guess 1
phase run for each csv(\"run_*.csv\") columns t, x {
  time t in [0, 1]
  free hot in [0.5, 2] guess 1
  state x start hot
  dynamics { x' = -rate*x }
  fit run: x sd 0.1
}";
    let folder = folder("phases_many", &[("decay.fdc", text.as_bytes())]);
    for (count, lines) in [(8, 8), (9, 4), (80, 4)] {
        for at in 1..=count {
            let rows = format!("t,x\n0.5,{}\n1,0.2\n", 0.4 + 0.001 * f64::from(at));
            std::fs::write(folder.join(format!("run_{at}.csv")), rows).expect("written");
        }
        let output = fdcc(&folder, &["solve", "decay.fdc", "--log", "none", "--no-verify"], "");
        let words = stdout(&output);
        let head: Vec<&str> = words.lines().take_while(|it| !it.starts_with(" done")).collect();
        assert_eq!(head.len(), lines, "{words}");
        if lines < count as usize {
            let more = format!(" and {} more phases up to run[{count}]   ", count - 3);
            assert!(head[2].starts_with(" run[3]") && head[3].starts_with(&more), "{words}");
            assert!(head[3].ends_with(" unknowns"), "{words}");
            // The rate and two of these; each has a line of its own, too.
            let result = words.lines().find(|it| it.contains(" objective ")).expect("a line");
            assert!(result.ends_with(&format!("   and {} more", count + 1 - 3)), "{result}");
            let estimates = words.lines().filter(|it| it.starts_with(" est   run["));
            assert_eq!(estimates.count(), count as usize, "{words}");
        }
    }
    let all = json(&fdcc(&folder, &["solve", "decay.fdc", "--json", "--no-verify"], ""));
    assert_eq!(all["phases"].as_object().map(serde_json::Map::len), Some(80));
}

/// What is not solved yet: `tests/tests/chains.rs` says why.
const UNSOLVED: &[&str] = &["goddard_arcs"];

/// Closed forms, publications, CasADi and IPOPT (`tests/peers/phases.py`).
#[test]
fn problems_of_the_literature_meet_their_expectations() {
    let place = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/classics/phases");
    let names = std::fs::read_dir(place)
        .expect("the folder exists")
        .map(|entry| entry.expect("it can be read").file_name().to_string_lossy().into_owned());
    let is_known = |name: &&String| !UNSOLVED.iter().any(|it| name.starts_with(it));
    let names: Vec<String> = names.filter(|name| name.ends_with(".fdc")).collect();
    let known: Vec<&str> = names.iter().filter(is_known).map(String::as_str).collect();
    assert!(known.len() >= 24, "{known:?}");
    let arguments = [&["test"], &known[..]].concat();
    let output = fdcc(std::path::Path::new(place), &arguments, "");
    assert_eq!(output.status.code(), Some(0), "{}", stdout(&output));
}

/// A solution in a file is confirmed as it was when it was found; one whose phases do not fit each
/// other is not.
#[test]
fn a_solution_with_phases_is_verified_from_its_file() {
    let folder = folder("phases_verify", &[("hop.fdc", HOP)]);
    let output = fdcc(&folder, &["solve", "hop.fdc", "--out", "out", "--log", "none"], "");
    expect_exit(&output, 0, "solve");
    let verified = json(&fdcc(&folder, &["verify", "out/hop.sol.json", "hop.fdc", "--json"], ""));
    let solved = std::fs::read_to_string(folder.join("out/hop.sol.json")).expect("it is there");
    let mut solved: Value = serde_json::from_str(&solved).expect("it is JSON");
    for field in ["confirmed", "phase_by_phase", "state_gap", "relative_violation"] {
        assert_eq!(verified["verification"][field], solved["verification"][field], "{field}");
    }
    assert_eq!(verified["phases"]["down"]["verification"]["confirmed"], true);
    assert!(number(&verified["links"]["up -> down: h"]["relative"]) < 1e-9);
    let output = fdcc(&folder, &["verify", "out/hop.sol.json", "hop.fdc"], "");
    assert!(stdout(&output).starts_with(" confirmed on the true system, phase by phase: "));
    // The second phase begins a metre higher than the first one ends.
    let heights = solved["phases"]["down"]["states"]["h"].as_array_mut().expect("a signal");
    heights[0] = serde_json::json!(number(&heights[0]) + 1.0);
    std::fs::write(folder.join("off.sol.json"), solved.to_string()).expect("it is written");
    let off = fdcc(&folder, &["verify", "off.sol.json", "hop.fdc", "--json"], "");
    expect_exit(&off, 2, "verify");
    assert!(number(&json(&off)["links"]["up -> down: h"]["violation"]) > 0.99);
    // One without a phase is refused.
    solved["phases"].as_object_mut().expect("phases").remove("down");
    std::fs::write(folder.join("half.sol.json"), solved.to_string()).expect("it is written");
    let half = fdcc(&folder, &["verify", "half.sol.json", "hop.fdc"], "");
    expect_exit(&half, 4, "verify");
    assert!(stderr(&half).contains("it has no phase `down`"), "{}", stderr(&half));
}

#[test]
fn files_are_written_for_each_phase() {
    let folder = folder("phases_files", &[("hop.fdc", HOP)]);
    let output = fdcc(&folder, &["solve", "hop.fdc", "--out", "out", "--log", "none"], "");
    expect_exit(&output, 0, "solve");
    let table = std::fs::read_to_string(folder.join("out/hop.down.csv")).expect("it is written");
    assert_eq!(table.lines().next(), Some("t,h,v,a"));
    assert_eq!(table.lines().count(), 42);
    let page = std::fs::read_to_string(folder.join("out/hop.html")).expect("it is written");
    assert!(page.contains("<figcaption>h <span class=\"unit\">[m]<"), "{page}");
}

#[test]
fn a_solution_with_phases_is_a_start() {
    let folder = folder("phases_warm", &[("hop.fdc", HOP)]);
    let output = fdcc(&folder, &["solve", "hop.fdc", "--out", "out", "--log", "none"], "");
    expect_exit(&output, 0, "solve");
    let interior = ["--method", "solver=interior_point", "--warm", "out/hop.sol.json"];
    let warm = solved(&folder, &interior);
    let cold = solved(&folder, &interior[..2]);
    let iterations = |of: &Value| of["iterations"].as_u64().expect("a count");
    assert_eq!(warm["status"], "solved");
    assert!(iterations(&warm) < iterations(&cold), "{} {}", warm["iterations"], cold["iterations"]);
    let several = solved(&folder, &["--method", "solver=interior_point", "--starts", "3"]);
    let difference = number(&several["objective"]) - number(&cold["objective"]);
    assert!(difference.abs() < 1e-8 * number(&cold["objective"]), "{difference}");
}

/// A width belongs to the phase that has the surface, not to what the phases share.
#[test]
fn one_phase_with_friction_beside_one_without_is_solved_with_a_width() {
    let text = b"model c
phase a {
  time t in [0, 1]
  state v start 1
  surface s = v
  control u in [-1, 1]
  dynamics { v' in u - 0.5*Sgn(s) }
  path v <= 2
}
phase b {
  time t in [1, 2]
  state v
  control u in [-1, 1]
  dynamics { v' = u }
}
link a -> b { same }
minimize b.v(end)^2
method { N = 20 sigma = 0.1 }
";
    let folder = folder("phases_one_with_friction", &[("c.fdc", text)]);
    let output = fdcc(&folder, &["solve", "c.fdc", "--json"], "");
    let document = json(&output);
    assert_eq!(document["status"], "solved", "{}", stderr(&output));
    let limits = |phase: &str| document["phases"][phase]["path"].as_object().map(|it| it.len());
    assert_eq!((limits("a"), limits("b")), (Some(1), None));
}

fn near(value: &Value, expected: f64) {
    let off = value.as_f64().map(|it| (it - expected).abs());
    assert!(off.is_some_and(|it| it < 1e-9), "{value}, not {expected}");
}

/// A fall of 1 s, half of the speed, and a slide that ends after `9.81/2/5` s.
#[test]
fn phases_are_simulated_one_after_the_other() {
    let text = "model drop
phase fall { time t in [0, 1]  state h start 5  state v start 0
  dynamics { h' = v  v' = -9.81 }  minimize h(end) }
phase slide { time t in [1, 4]  state h  state v  surface slip = v
  dynamics { h' = v  v' in -5*Sgn(slip) }  minimize h(end) }
link fall -> slide { same v := 0.5*v }";
    let folder = folder("phases_simulated", &[("drop.fdc", text.as_bytes())]);
    let output = fdcc(&folder, &["simulate", "drop.fdc", "--json", "--out", "out"], "");
    let document = json(&output);
    let landed = 5.0 - 0.5 * 9.81;
    let rest = landed - 4.905 * 4.905 / 10.0;
    near(&document["phases"]["fall"]["end"]["h"], landed);
    near(&document["phases"]["slide"]["events"][0]["time"], 1.981);
    near(&document["phases"]["slide"]["end"]["h"], rest);
    near(&document["objective"], landed + rest);
    assert_eq!(document["status"], "completed");
    for name in ["sim.json", "sim.html", "fall.sim.csv", "slide.sim.csv"] {
        assert!(folder.join(format!("out/drop.{name}")).exists(), "{name}");
    }
}

/// A solution drives each phase by its own controls; the links hold between them.
#[test]
fn a_solution_with_phases_is_simulated() {
    let folder = folder("phases_driven", &[("hop.fdc", HOP)]);
    let solved = solved(&folder, &["--out", "."]);
    let driven = ["simulate", "hop.fdc", "--control", "hop.sol.json", "--json"];
    let found = json(&fdcc(&folder, &driven, ""));
    for (phase, name) in [("up", "h"), ("up", "v"), ("down", "h"), ("down", "v")] {
        let end = found["phases"][phase]["end"][name].as_f64().expect("a number");
        let plan = at(&solved, phase, "states", name, true);
        assert!((end - plan).abs() < 1e-2, "{phase}.{name}: {end} and {plan}");
    }
    for (arguments, said) in [
        (["--times", "0,1"], "phases have times of their own"),
        (["--control", "hop.csv"], "takes the .sol.json"),
        (["--warm", "hop.sol.json"], "needs a model of one piece"),
    ] {
        let output = fdcc(&folder, &[&["simulate", "hop.fdc"][..], &arguments].concat(), "");
        expect_exit(&output, 3, said);
        assert!(stderr(&output).contains(said), "{}", stderr(&output));
    }
}

/// A solution has its parameters, and the command line the last word.
#[test]
fn parameters_of_a_solution_drive_phases_unless_told_otherwise() {
    let text = "model par\nparam k = 1
phase a { time t in [0, 1]  state x start 1  dynamics { x' = -k } }
phase b { time t in [1, 2]  state x  control u in [-9, 9]  dynamics { x' = u - k }
  end x == 1  minimize integral(u^2) }
link a -> b { same }";
    let folder = folder("phases_params", &[("par.fdc", text.as_bytes())]);
    fdcc(&folder, &["solve", "par.fdc", "--set", "k=2", "--out", ".", "--log", "none"], "");
    let driven = ["simulate", "par.fdc", "--control", "par.sol.json", "--json"];
    let end = |more: &[&str]| {
        let found = json(&fdcc(&folder, &[&driven[..], more].concat(), ""));
        found["phases"]["b"]["end"]["x"].as_f64().expect("a number")
    };
    // The control is 4 on average.
    for (more, expected) in [(&[][..], 1.0), (&["--set", "k=0"], 5.0)] {
        assert!((end(more) - expected).abs() < 1e-6, "{more:?}: {}", end(more));
    }
}

/// An unknown of a solution holds unless the command line has another one.
#[test]
fn unknowns_of_a_solution_drive_phases_unless_told_otherwise() {
    let text = "model turn\nfree k in [0, 5] guess 1
phase a { time t in [0, 1]  state x start 1  dynamics { x' = -k }  end x == 0 }
phase b { time t in [1, 2]  state x  dynamics { x' = k } }
link a -> b { same }  minimize b.x(end)^2";
    let folder = folder("phases_unknowns", &[("turn.fdc", text.as_bytes())]);
    fdcc(&folder, &["solve", "turn.fdc", "--out", ".", "--log", "none"], "");
    let driven = ["simulate", "turn.fdc", "--control", "turn.sol.json", "--json"];
    for (more, expected) in [(&[][..], 0.0), (&["--set", "k=3"], -2.0)] {
        let found = json(&fdcc(&folder, &[&driven[..], more].concat(), ""));
        near(&found["phases"]["a"]["end"]["x"], expected);
    }
}

/// A ball that falls from 1 with g = 2 lands at 1, and rises to 1/4 at 1.5 with e = 1/2; the next
/// phase begins there.
#[test]
fn jumps_within_phases_happen() {
    let text = "phase fall { time t in [0, 1.5]  state h start 1  state v start 0
  surface floor = h  dynamics { h' = v  v' = -2 }
  jump bounce on floor falling { v := -0.5*v } }
phase rise { time t in [1.5, 2.5]  state h  dynamics { h' = 1 } }
link fall -> rise { same }  minimize rise.h(end)^2";
    let folder = folder("phases_jump", &[("ball.fdc", text.as_bytes())]);
    let document = json(&fdcc(&folder, &["simulate", "ball.fdc", "--json"], ""));
    near(&document["phases"]["fall"]["events"][0]["time"], 1.0);
    near(&document["phases"]["rise"]["end"]["h"], 1.25);
    near(&document["objective"], 1.5625);
}

/// What stops in a phase is told, and no later phase is made up.
#[test]
fn a_phase_that_does_not_end_is_the_last() {
    let text = "phase one { time t in [0, 2]  state x start 1  dynamics { x' = -1/sqrt(x) } }
phase two { time t in [2, 3]  state x  dynamics { x' = 1 } }
link one -> two { same }";
    let folder = folder("phases_early", &[("early.fdc", text.as_bytes())]);
    let output = fdcc(&folder, &["simulate", "early.fdc", "--json"], "");
    expect_exit(&output, 2, "it is not defined at 0");
    let document = json(&output);
    assert_eq!(document["status"], "not_finite");
    assert_eq!(document["phases"].as_object().map(serde_json::Map::len), Some(1));
}

/// A ball that bounces in the first of two phases: what is said of it, its files, a replay of these
/// and a start from them.
#[test]
fn jumps_of_phases_are_told_written_and_begun_at() {
    let text = "model windy
free T in [0.3, 3] guess 1
free vx in [0, 20] guess 4
free vy in [-10, 10] guess 1
phase air {
  time t in [0, T]
  state x start 0
  state h start 1.5
  state v start vy
  surface ground = h
  dynamics { x' = vx  h' = v  v' = -9.81 }
  path over: h >= 0
  jump bounce on ground falling at most 1 { v := -0.8*v }
}
phase wind like air {
  time t in [T, T + 0.5]
  dynamics { x' = vx - 1 }
}
link air -> wind { same }
end wind.x == 6
end wind.h == 1
minimize vx^2 + vy^2
";
    let folder = folder("phases_jumps", &[("windy.fdc", text.as_bytes())]);
    let output = fdcc(&folder, &["solve", "windy.fdc", "--out", "."], "");
    expect_exit(&output, 0, &stderr(&output));
    let words = stdout(&output);
    assert!(words.contains("1 jump located"), "{words}");
    assert!(words.contains(" jumps air.bounce at t = 0.90478\n"), "{words}");
    assert!(words.contains("       wind.bounce: objective "), "{words}");
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).expect("it was written");
    let document: Value = serde_json::from_str(&read("windy.sol.json")).expect("it is JSON");
    let jump = &document["phases"]["air"]["jumps"][0];
    assert_eq!(jump["jump"], "bounce");
    let [before, after] = ["before", "after"].map(|side| number(&jump[side]["v"]));
    assert!((after + 0.8 * before).abs() < 1e-9 && after > 0.0, "{before} {after}");
    assert_eq!(document["phases"]["wind"].get("jumps"), None);
    assert_eq!(document["sequences"][0]["jumps"], serde_json::json!(["air.bounce"]));
    assert!(read("windy.html").contains("<td>air.bounce</td>"));
    let replay = fdcc(&folder, &["verify", "windy.sol.json", "windy.fdc"], "");
    expect_exit(&replay, 0, &stderr(&replay));
    assert!(stdout(&replay).contains("time of bounce"), "{}", stdout(&replay));
    let again = fdcc(&folder, &["solve", "windy.fdc", "--warm", "windy.sol.json", "--json"], "");
    let again = json(&again);
    assert!((number(&again["objective"]) - 24.0315807218).abs() < 1e-6);
}

/// As of a model of one piece.
#[test]
fn a_phase_whose_time_runs_backwards_is_refused() {
    let text = b"model back\nparam T = 1\nphase a { time t in [0, T] state x start 0 \
        dynamics { x' = 1 } }\nphase b like a { time t in [T, 2] }\nlink a -> b { same }\n";
    let folder = folder("phases_backwards", &[("back.fdc", text)]);
    let simulate = |set: &str| fdcc(&folder, &["simulate", "back.fdc", "--set", set], "");
    expect_exit(&simulate("T=1.5"), 0, "forwards");
    let output = simulate("T=3");
    expect_exit(&output, 3, "backwards");
    let told = "phase `b`: time runs from 3 to 2; it must not run backwards";
    assert!(stderr(&output).contains(told), "{}", stderr(&output));
}
