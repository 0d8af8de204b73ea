//! Solves that do not end with a solution: what is said at which line, and what is written all the
//! same.

use crate::common::*;
use serde_json::Value;

#[test]
fn a_value_that_does_not_exist_is_shown_at_its_line_and_is_null_in_json() {
    let text = RAMP.replace("x' = u", "x' = u * sqrt(x - 2)").replace("end x == goal\n", "");
    let folder = folder("not_finite", &[("root.fdc", text.as_bytes())]);
    let output = fdcc(&folder, &["solve", "root.fdc", "--json", "--out", "."], "");
    expect_exit(&output, 2, "root");
    let said = stderr(&output);
    assert!(said.contains("FDC0601") && said.contains("root.fdc:6:"), "{said}");
    assert!(said.contains("`x'` or one of its derivatives is infinite or undefined"), "{said}");
    let document = json(&output);
    assert_eq!(document["status"], "not_finite");
    assert!(document["kkt_error"].is_null());
    assert!(folder.join("ramp.html").exists(), "the files are written all the same");
    let warm =
        fdcc(&folder, &["solve", "root.fdc", "--warm", "ramp.sol.json", "--log", "none"], "");
    expect_exit(&warm, 2, "what could not be solved can still be a start");
}

#[test]
fn an_infeasible_problem_names_the_condition_and_the_controls_at_their_bounds() {
    let folder = folder("infeasible", &[("ramp.fdc", RAMP.as_bytes())]);
    let solve = |solver: &str| {
        let method = format!("solver={solver}");
        fdcc(
            &folder,
            &["solve", "ramp.fdc", "--set", "goal=5", "--log", "none", "--method", &method],
            "",
        )
    };
    let proved = stderr(&solve("convex"));
    assert!(proved.contains("FDC0602") && proved.contains("ramp.fdc:7:"), "{proved}");
    assert!(proved.contains("this is certain on this grid"), "{proved}");
    let searched = solve("interior_point");
    expect_exit(&searched, 2, "interior point");
    let said = stderr(&searched);
    assert!(said.contains("`u` is at 4 from t = 0 to 1"), "{said}");
    assert!(said.contains("`end x == goal` cannot be met"), "{said}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_stops_with_the_best_iterate_written() {
    use std::io::{BufRead, BufReader};
    let folder = folder("interrupt", &[]);
    let racecar = smoothed_race_car();
    // Far more work than the test waits for.
    let arguments = ["solve", &racecar, "--method", "N=10000", "--out", ".", "--log", "full"];
    let mut child = start(&folder, &arguments);
    let mut lines = BufReader::new(child.stderr.take().expect("piped")).lines();
    let begun = lines.any(|line| line.expect("text").trim_start().starts_with("1 "));
    assert!(begun, "the first iteration is shown");
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(kill.expect("kill runs").success());
    lines.for_each(drop);
    let output = child.wait_with_output().expect("fdcc ends");
    expect_exit(&output, 2, "interrupted");
    assert!(stdout(&output).contains("NOT SOLVED, interrupted"));
    let saved =
        std::fs::read_to_string(folder.join("racecar.sol.json")).expect("the file was written");
    let saved: Value = serde_json::from_str(&saved).expect("JSON");
    assert_eq!(saved["status"], "interrupted");
    assert_eq!(column(&saved["states"]["th"]).len(), 10_001);
}

/// Times, bounds and what an equation is off by are in the units of the model.
#[test]
fn what_cannot_be_met_is_told_in_the_units_of_the_model() {
    let far = "time t in [0, 1] [s]\nstate x [km] start 0\nstate v [km/h] start 0\ncontrol u in \
               [-1, 1] [m/s^2]\n\
               dynamics {\n  x' = v\n  v' = u\n}\nend x == 5\nend v == 0\nminimize \
               integral(u^2)\nmethod { solver = interior_point }\n";
    let folder = folder("stops_units", &[("far.fdc", far.as_bytes())]);
    let output = fdcc(&folder, &["solve", "far.fdc", "--log", "none"], "");
    expect_exit(&output, 2, "nothing drives 5 km in a second");
    let said = stderr(&output);
    // As far as possible in the first half, or back in the second: both are as near.
    let halves = ["`u` is at 1 m/s^2 from t = 0 s to 0.", "`u` is at -1 m/s^2 from t = 0.5"];
    assert!(halves.iter().any(|half| said.contains(half)), "{said}");
    assert!(said.contains(" km in one step"), "{said}");
}

/// Up a step: what is left of the speed has no value on the guess, which stands still.
const STEP: &str = "model step\ntime t in [0, 3]\nstate x start 0\nstate v start 0\ncontrol u\n\
                    surface slip = v\nsurface step = x - 1\n\
                    dynamics {\n  x' = v\n  v' in u - 0.2*Sgn(slip)\n}\n\
                    jump up on step rising at most 1 { v := sqrt(v^2 - 0.5) }\n";

#[test]
fn a_reset_without_a_value_on_the_guess_is_named() {
    let goal = format!("{STEP}end x == 1.5\nend v == 0\nminimize integral(u^2)\n");
    let near = format!("{STEP}end x <= 1.5\nminimize integral(u^2) - x(end)\n");
    let files: [(&str, &[u8]); 2] = [("goal.fdc", goal.as_bytes()), ("near.fdc", near.as_bytes())];
    let folder = folder("without_value", &files);
    let method = ["--log", "none", "--method", "sigma=0.1", "--method", "N=40"];
    let solve = |file: &str| fdcc(&folder, &[&["solve", file][..], &method].concat(), "");
    let failed = solve("goal.fdc");
    expect_exit(&failed, 2, "no trajectory is found");
    let (said, found) = (stderr(&failed), stdout(&failed));
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    let words = "`v := sqrt(v^2 - 0.5)` has no value on the guess";
    assert!(said.contains("FDC0602") && said.contains("goal.fdc:12:"), "{said}");
    assert!(said.contains(words) && said.contains("with `up` this has no value"), "{said}");
    assert!(said.contains("arrives there with a state"), "{said}");
    let line = format!("       up: {words}: give a `guess`");
    assert!(found.contains(" jumps none\n") && found.contains(&line), "{found}");
    let found = stdout(&solve("near.fdc"));
    assert!(found.contains(&line) && !found.contains("not finite"), "{found}");
}
