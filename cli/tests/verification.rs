//! Every solve replays its controls on the true system, and says what comes of it.

use crate::common::{RAMP, expect_exit, fdcc, folder, json, smoothed_race_car, stdout};

/// The paper's own solution for sigma = 0.1, N = 1000 is not admissible: with the set-valued
/// friction its controls leave the track by .346 and cost 7.000. Source: an independent replay with
/// located events (DOP853, tolerance 1e-11, body coordinates) of the controls that CasADi + IPOPT
/// found for the same problem.
#[test]
fn the_race_car_is_not_called_solved_without_hearing_that_it_leaves_the_track() {
    let folder = folder("verification", &[]);
    let racecar = smoothed_race_car();
    let output = fdcc(&folder, &["solve", &racecar, "--json", "--log", "none"], "");
    expect_exit(&output, 0, "race car");
    let verification = json(&output)["verification"].clone();
    let number = |name: &str| verification[name].as_f64().expect("a number");
    assert!((number("objective") - 7.000).abs() < 1e-3, "{verification}");
    assert!((number("constraint_violation") - 0.346).abs() < 1e-3, "{verification}");
    assert_eq!(verification["worst"]["condition"], "track");
    assert!(number("state_gap") > 0.04, "the car is 0.4 off its way of 9.4: {verification}");
    assert!(number("relative_violation") > 0.03, "{verification}");
    let said = stdout(&fdcc(&folder, &["solve", &racecar, "--log", "none"], ""));
    let first = said.lines().find(|line| line.starts_with(" done")).expect("a verdict");
    assert!(first.contains("NOT CONFIRMED on the true system"), "{said}");
    assert!(said.contains("`track` off by 0.346"), "{said}");
}

/// x' = u with a constant control on each interval: implicit Euler is exact, so the replay is the
/// solution itself.
#[test]
fn an_exact_scheme_is_confirmed_to_rounding() {
    let ramp = RAMP.as_bytes();
    let folder = folder("confirmed", &[("ramp.fdc", ramp)]);
    let verification = json(&fdcc(&folder, &["solve", "ramp.fdc", "--json", "--log", "none"], ""))
        ["verification"]
        .clone();
    assert!(verification["state_gap"].as_f64().expect("a number") < 1e-9, "{verification}");
    assert!(
        verification["constraint_violation"].as_f64().expect("a number") < 1e-7,
        "{verification}"
    );
    assert_eq!(verification["events"], 0);
    let without =
        json(&fdcc(&folder, &["solve", "ramp.fdc", "--json", "--log", "none", "--no-verify"], ""));
    assert!(without.get("verification").is_none());
}
