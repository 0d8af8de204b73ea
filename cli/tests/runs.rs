//! Pages of runs that are no solve: simulations, closed loops, sweeps; and what a terminal shows.

use crate::common::*;
use std::fs;
use std::path::Path;

fn page(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The embedded description of what is drawn.
fn drawing(page: &str) -> serde_json::Value {
    let (_, rest) = page.split_once("id=\"page\">").expect("what is drawn");
    serde_json::from_str(rest.split_once("</script>").expect("it ends").0).expect("JSON")
}

#[test]
fn a_simulation_has_a_page_with_its_events() {
    let folder = folder("simulated_page", &[]);
    let output = fdcc(&folder, &["simulate", &model("bounce"), "--out", "."], "");
    expect_exit(&output, 0, "simulate");
    assert!(stdout(&output).contains("./bounce.sim.html"), "{}", stdout(&output));
    let page = page(&folder, "bounce.sim.html");
    assert!(page.contains("Simulated to the end, 2 events"));
    assert!(page.contains("key-0\">simulation</span>"));
    let again = format!("<pre>fdcc simulate {} --out results", model("bounce"));
    assert!(page.contains(&again) && !page.contains("fdcc solve"));
    let drawn = drawing(&page);
    let marks: Vec<f64> =
        drawn["marks"].as_array().expect("marks").iter().map(|it| number(&it["time"])).collect();
    // Falls from 1.5 m without a speed: sqrt(2*1.5/g).
    assert!(marks.len() == 2 && (marks[0] - (3.0f64 / 9.81).sqrt()).abs() < 1e-6, "{marks:?}");
}

/// A fall of 1 s, half of the speed, and a slide that stops after `9.81/2/5` s.
const DROP: &str = "model drop
phase fall { time t in [0, 1]  state h start 5  state v start 0
  dynamics { h' = v  v' = -9.81 }  plot speed: v over h }
phase slide { time t in [1, 4]  state h  state v  surface slip = v
  dynamics { h' = v  v' in -5*Sgn(slip) } }
link fall -> slide { same v := 0.5*v }";

/// One axis for all phases, with the link and the event marked; `report` and `plot` draw the same.
#[test]
fn a_simulation_of_phases_has_a_page_and_pictures() {
    let folder = folder("simulated_phases", &[("drop.fdc", DROP.as_bytes())]);
    expect_exit(&fdcc(&folder, &["simulate", "drop.fdc", "--out", "."], ""), 0, "simulate");
    let report = ["report", "drop.sim.json", "--out", "again.html"];
    expect_exit(&fdcc(&folder, &report, ""), 0, "report");
    for name in ["drop.sim.html", "again.html"] {
        let page = page(&folder, name);
        assert!(page.contains("Simulated to the end, 2 phases, 1 event"), "{name}");
        assert!(page.contains("<td>slide</td><td>slip</td><td>enters sliding</td>"), "{name}");
        let drawn = drawing(&page);
        let marks = drawn["marks"].as_array().expect("marks").iter();
        let marks: Vec<_> = marks.map(|it| (number(&it["time"]), text_of(&it["what"]))).collect();
        assert_eq!(marks.len(), 2, "{marks:?}");
        assert!((marks[0].0 - 1.981).abs() < 1e-9 && marks[0].1 == "slip: enters sliding");
        assert_eq!(marks[1], (1.0, "slide"));
        assert_eq!(drawn["figures"][0]["curves"].as_array().map(Vec::len), Some(2));
        assert_eq!(drawn["portraits"][0]["name"], "speed");
    }
    let plot = ["plot", "drop.sim.json", "--signal", "v", "--out", "v.svg"];
    expect_exit(&fdcc(&folder, &plot, ""), 0, "plot");
    // A phase each: between them the speed jumps.
    let lines = page(&folder, "v.svg").matches("stroke=\"#1F5FA8\"").count();
    assert_eq!(lines, 2);
}

/// The phase that does not reach its last time is named.
#[test]
fn a_phase_that_ends_early_is_told_on_the_page() {
    let text = DROP.replace("v' = -9.81", "v' = -1/sqrt(h - 4)");
    let folder = folder("simulated_phases_early", &[("drop.fdc", text.as_bytes())]);
    expect_exit(&fdcc(&folder, &["simulate", "drop.fdc", "--out", "."], ""), 0, "simulate");
    let text = text.replace("[0, 1]", "[0, 9]").replace("[1, 4]", "[9, 10]");
    fs::write(folder.join("drop.fdc"), text).expect("written");
    expect_exit(&fdcc(&folder, &["simulate", "drop.fdc", "--out", "."], ""), 2, "simulate");
    let page = page(&folder, "drop.sim.html");
    let title = "Simulated, 1 phase, 0 events; ended early: not finite in phase fall";
    assert!(page.contains(title), "{page}");
}

fn text_of(it: &serde_json::Value) -> &str {
    it.as_str().expect("a text")
}

/// The derivatives come first; `fdcc report` makes the same page of the document.
#[test]
fn a_gradient_has_a_page_with_its_derivatives() {
    let folder = folder("gradient_page", &[]);
    let output = fdcc(&folder, &["grad", &model("crossing"), "--out", "."], "");
    expect_exit(&output, 0, "grad");
    assert!(stdout(&output).contains("./crossing.grad.html"), "{}", stdout(&output));
    let text = page(&folder, "crossing.grad.html");
    assert!(text.contains("Exact gradient of objective: it can be trusted"));
    let table = text.find("<h2>Derivatives of objective</h2>").expect("a table");
    assert!(table < text.find("<h2>States</h2>").expect("the trajectory"));
    assert!(text.contains(">discretised (") && text.contains("<h2>Events</h2>"));
    assert!(text.contains("class=\"open\">? open</b><span>The discretised gradient is off by"));
    assert_eq!(drawing(&text)["figures"][0]["name"], "x");
    let report = ["report", "crossing.grad.json", "--out", "again.html"];
    expect_exit(&fdcc(&folder, &report, ""), 0, "report");
    assert!(page(&folder, "again.html").contains("<h2>Derivatives of objective</h2>"));
}

/// The replay beside the plan, and what differs; also of phases.
#[test]
fn a_verification_has_a_page_with_the_replay() {
    let folder = folder("verified_page", &[("ramp.fdc", RAMP.as_bytes())]);
    let hop = format!("{}/../models/twostage.fdc", env!("CARGO_MANIFEST_DIR"));
    for (name, file) in [("ramp", "ramp.fdc"), ("twostage", &hop)] {
        expect_exit(&fdcc(&folder, &["solve", file, "--out", ".", "--log", "none"], ""), 0, name);
        let verify = ["verify", &format!("{name}.sol.json"), file, "--out", "."];
        let output = fdcc(&folder, &verify, "");
        expect_exit(&output, 0, name);
        assert!(stdout(&output).contains(&format!("./{name}.verify.html")), "{}", stdout(&output));
        let text = page(&folder, &format!("{name}.verify.html"));
        assert!(
            text.contains("<h1 class=\"certain\">The solution is confirmed on the true system")
        );
        assert!(text.contains("<h2>Replay less solution"), "{name}");
        let figures = drawing(&text)["figures"].clone();
        assert_eq!(figures[0]["curves"][1]["kind"], "replay", "{name}");
        let report = ["report", &format!("{name}.verify.json"), "--out", "again.html"];
        expect_exit(&fdcc(&folder, &report, ""), 0, "report");
    }
}

/// It goes to 1, in ten steps of 0.1.
const LOOP: &str = "\
model follow
time t in [0, 1]
state x start 0
control u in [-2, 2]
dynamics { x' = u }
minimize integral((x - 1)^2 + 0.01*u^2)
method { N = 10 scheme = implicit_euler }
";

#[test]
fn a_closed_loop_writes_a_page_and_a_table() {
    let folder = folder("loop_page", &[("follow.fdc", LOOP.as_bytes())]);
    let mpc = ["mpc", "follow.fdc", "--steps", "7", "--method", "tol=1e-7", "--out", "run"];
    let output = fdcc(&folder, &mpc, "");
    expect_exit(&output, 0, "mpc");
    assert!(stdout(&output).contains(" wrote run/follow.mpc.json"), "{}", stdout(&output));
    let page = page(&folder, "run/follow.mpc.html");
    assert!(page.contains("In closed loop: 7 steps, all are solved"));
    assert!(page.contains("fdcc mpc follow.fdc --steps 7 --method tol=1e-7 --out results</pre>"));
    let drawn = drawing(&page);
    let names: Vec<&str> = drawn["figures"]
        .as_array()
        .expect("figures")
        .iter()
        .filter_map(|it| it["name"].as_str())
        .collect();
    assert_eq!(names, ["x", "u", "iterations", "seconds"]);
    let table = fs::read_to_string(folder.join("run/follow.mpc.csv")).expect("a table");
    assert_eq!(table.lines().next(), Some("t,x,u,status,iterations,seconds"));
    assert_eq!(table.lines().count(), 8);
}

/// The page of the sweep in a folder.
fn sweep_page(folder: &Path) -> String {
    let mut entries = fs::read_dir(folder).expect("a folder").map(|it| it.expect("a file").path());
    let page = entries.find(|it| it.extension().is_some_and(|it| it == "html"));
    fs::read_to_string(page.expect("there is a page")).expect("it can be read")
}

#[test]
fn a_sweep_has_a_picture_that_marks_what_failed() {
    let folder = folder("sweep_page", &[("ramp.fdc", RAMP.as_bytes())]);
    // With |u| <= 4 nothing gets to 5.
    let output = fdcc(&folder, &["sweep", "ramp.fdc", "goal=1,3,5", "--out", "runs"], "");
    expect_exit(&output, 2, "one row is infeasible");
    let page = sweep_page(&folder.join("runs"));
    assert!(page.contains("2 of 3 rows can be used, 1 not solved"), "{page}");
    assert!(page.contains("<pre>fdcc sweep ramp.fdc goal=1,3,5 --out results</pre>"), "{page}");
    assert_eq!(page.matches("<svg").count(), 1);
    let arguments = ["sweep", "ramp.fdc", "goal=1,2", "N=4,8", "--product", "--out", "grid"];
    expect_exit(&fdcc(&folder, &arguments, ""), 0, "a product");
    assert!(sweep_page(&folder.join("grid")).contains("over goal and N"));
    let parts = |part: &str| {
        let arguments = ["sweep", "ramp.fdc", "goal=1,2,3", "--out", "parts", "--part", part];
        expect_exit(&fdcc(&folder, &arguments, ""), 0, part);
        sweep_page(&folder.join("parts"))
    };
    assert!(parts("1/2").contains("2 of 3 rows can be used, 1 not there yet"));
    assert!(parts("2/2").contains("3 of 3 rows can be used"));
}

/// A row says in SI what was given in a unit of its own.
#[test]
fn swept_values_are_in_si() {
    let text = RAMP.replace("param goal = 1", "param m = 2 [g]\nparam goal = 1");
    let text = text.replace("integral(u^2)", "integral(u^2) * m");
    let folder = folder("swept_si", &[("ramp.fdc", text.as_bytes())]);
    let output = fdcc(&folder, &["sweep", "ramp.fdc", "m=1[g],2.5[g],3[kg]", "--json"], "");
    let rows = json(&output);
    let swept = |at: usize| number(&rows[at]["swept"]["m"]);
    assert_eq!([0, 1, 2].map(swept), [0.001, 0.0025, 3.0]);
}

/// From rest with at most 0.5 m/s^2, 0.25 m is as far as it gets in a second; on 200 intervals of
/// implicit Euler, half a step further.
const FAR: &str = "\
model far
time t in [0, 1] [s]
state x [m] start 0
state v [m/s] start 0
control u in [-0.5, 0.5] [m/s^2]
dynamics { x' = v  v' = u }
end x == 1
minimize integral(u^2)
method { N = 200 scheme = implicit_euler }
";

#[test]
fn what_cannot_be_met_is_told_how_far_it_can() {
    let folder = folder("reach", &[("far.fdc", FAR.as_bytes())]);
    let reached = |arguments: &[&str]| {
        let solve = ["solve", "far.fdc", "--log", "none"];
        let words = fdcc(&folder, &[&solve[..], arguments].concat(), "");
        expect_exit(&words, 2, "it cannot be met");
        let found = json(&fdcc(&folder, &[&solve[..], &["--json"], arguments].concat(), ""));
        (stdout(&words), found["reach"].clone())
    };
    let (words, reach) = reached(&[]);
    let exact = 0.25 * (1.0 + 1.0 / 200.0);
    assert!((number(&reach["value"]) - exact).abs() < 1e-6, "{reach}");
    assert_eq!((number(&reach["bound"]), &reach["proved"]), (1.0, &true.into()));
    let said = "with all else met, `end x == 1` comes to 0.2512 m instead of 1 m (proved: ";
    assert!(words.contains(said), "{words}");
    // From above, and with other conditions that stay as they are.
    let below = FAR.replace("x == 1", "x == -1\nend v == 0");
    fs::write(folder.join("far.fdc"), below).expect("a file");
    let (_, reach) = reached(&[]);
    // Forth for half of the time and back for the other: half as far as one way.
    assert!((number(&reach["value"]) + 0.125).abs() < 1e-3, "{reach}");
}

#[test]
fn what_can_be_met_has_no_such_line() {
    let folder = folder("no_reach", &[("far.fdc", FAR.replace("x == 1", "x == 0.2").as_bytes())]);
    let output = fdcc(&folder, &["solve", "far.fdc", "--json", "--log", "none"], "");
    expect_exit(&output, 0, "it can be met");
    assert!(json(&output)["reach"].is_null());
}

#[test]
fn the_log_fits_a_terminal() {
    let folder = folder("narrow", &[]);
    let log = |level: &str| {
        let output = fdcc(&folder, &["solve", &model("block"), "--no-verify", "--log", level], "");
        expect_exit(&output, 0, level);
        stderr(&output)
    };
    let (short, full) = (log("short"), log("full"));
    let is_table = |line: &&str| line.starts_with(" iter") || line.starts_with("   ");
    let widest = |log: &str| log.lines().filter(is_table).map(str::len).max().expect("a table");
    assert!(widest(&short) <= 80, "{short}");
    assert!(full.contains("lg(rg) alpha_du  ls") && !short.contains("alpha_du"), "{full}");
}

/// Every line of a verdict begins with a word that `fdcc explain verdict` tells, or with a name.
#[test]
fn every_line_of_a_verdict_is_explained() {
    let folder = folder("explained", &[("far.fdc", FAR.as_bytes())]);
    let told = stdout(&fdcc(&folder, &["explain", "verdict"], ""));
    let cases = [
        (model("block"), "slip"),
        (model("bounce"), "u"),
        (model("slider_fit"), "slip"),
        ("far.fdc".into(), "-"),
    ];
    for (file, name) in cases {
        let output = stdout(&fdcc(&folder, &["solve", &file, "--log", "none"], ""));
        // The first line begins with the name of the model, others go on with the one before.
        for line in output.lines().skip(1).filter(|line| !line.starts_with("   ")) {
            let word = line.split_whitespace().next().expect("a line has words");
            let is_told = told.contains(&format!("`{word}`"));
            assert!(is_told || word == name, "{word} of {line}");
        }
    }
    expect_exit(&fdcc(&folder, &["explain", "VERDICT"], ""), 0, "any case");
}
