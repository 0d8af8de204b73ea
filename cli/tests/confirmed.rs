//! `--confirmed`: the exit code tells whether an answer holds on the true system and nothing
//! contradicts that it is an optimum.

use crate::common::{
    RAMP, expect_exit, fdcc, folder, json, model, number, smoothed_race_car, stderr, stdout,
};
use serde_json::Value;

/// Friction 5.886 N on 2 kg over 1 m: the block waits, then is pulled for `tau = sqrt(6 m d/f)`, at
/// `f^2 tau + 12 m^2 d^2/tau^3`.
fn least() -> f64 {
    let (mass, friction) = (2.0, 0.3 * 2.0 * 9.81_f64);
    let tau = (6.0 * mass / friction).sqrt();
    friction.powi(2) * tau + 12.0 * mass * mass / tau.powi(3)
}

/// In a layer of 1e-4 m/s the gradient is lost: a solver may stop anywhere, and the replay agrees.
/// Wherever it does, the answer is the optimum, or its Hamiltonian says that it is none.
#[test]
fn a_lost_gradient_is_told_in_the_headline() {
    let folder = folder("confirmed_block", &[]);
    let block = model("block");
    assert!((least() - 65.957).abs() < 1e-3);
    for setting in ["scheme=radau3", "scheme=radau2"] {
        let solve =
            ["solve", &block, "--method", "sigma=1e-4", "--method", "N=auto", "--method", setting];
        let quiet = [&solve[..], &["--log", "none"]].concat();
        let document = json(&fdcc(&folder, &[&quiet[..], &["--json"]].concat(), ""));
        assert_eq!(document["status"], "solved");
        let is_least = (number(&document["objective"]) - least()).abs() < 0.01 * least();
        let optimality = &document["optimality"];
        assert_eq!(
            optimality["contradicted"], !is_least,
            "{}: {optimality}",
            document["objective"]
        );
        let confirmed = fdcc(&folder, &[&quiet[..], &["--confirmed"]].concat(), "");
        if !is_least {
            expect_exit(&fdcc(&folder, &quiet, ""), 0, "status is that of the discrete problem");
            expect_exit(&confirmed, 2, setting);
            let first = stdout(&confirmed)
                .lines()
                .find(|line| line.starts_with(" done"))
                .map(str::to_owned);
            let first = first.expect("a headline");
            assert!(first.contains("CONTRADICTED as an optimum: "), "{first}");
            // Which of the many stationary points it is, and so what it misses, is up to rounding.
            let checks = optimality["checks"].as_array().expect("a list");
            let is_missed = |check: &Value| {
                ["hamiltonian_constant", "pause"].iter().any(|name| check["check"] == *name)
                    && number(&check["figure"]) > 0.4 * number(&check["size"])
            };
            assert!(checks.iter().any(is_missed), "{optimality}");
        }
    }
}

/// With the midpoint rule and a layer of 1e-5 the first step leaves it at once: friction all the
/// time, `J = f^2 T + 12 m^2 d^2/T^3` = 139.33, with a Hamiltonian that is constant to rounding.
/// Waiting costs nothing, and every second of it saves `f^2 - 36 m^2 d^2/T^4` = 34.1.
#[test]
fn a_layer_that_is_left_in_one_step_hides_the_gain_of_a_pause() {
    let solve = ["solve", &model("block"), "--method", "sigma=1e-5", "--method", "N=50"];
    let solve = [&solve[..], &["--method", "scheme=midpoint", "--json", "--log", "none"]].concat();
    let document = json(&fdcc(&folder("confirmed_pause", &[]), &solve, ""));
    let is_least = (number(&document["objective"]) - least()).abs() < 0.01 * least();
    if !is_least {
        assert!(
            (number(&document["objective"]) - 139.33).abs() < 0.01,
            "{}",
            document["objective"]
        );
        let pause = &document["hamiltonian_check"]["pause"];
        assert!((number(pause) - 34.08).abs() < 0.5, "{pause}");
    }
    assert_eq!(document["optimality"]["contradicted"], !is_least, "{}", document["optimality"]);
}

/// On the race car the Hamiltonian is off by .3 %, and no row of Table 7.1 is contradicted.
#[test]
fn the_race_car_is_not_contradicted_but_not_confirmed_either() {
    let folder = folder("confirmed_racecar", &[]);
    let racecar = smoothed_race_car();
    let output = fdcc(&folder, &["solve", &racecar, "--json", "--log", "none", "--confirmed"], "");
    expect_exit(&output, 2, "the true car leaves the track");
    let optimality = &json(&output)["optimality"];
    assert_eq!(optimality["says"], "nothing contradicts");
    let check = &optimality["checks"][0];
    assert_eq!(check["check"], "hamiltonian_value");
    assert!(number(&check["figure"]) < 0.01 * number(&check["size"]), "{check}");
    let table = [
        "sweep",
        &racecar,
        "sigma=0.1,0.1,0.1,0.1,0.05,0.05,0.05,0.025,0.025,0.025",
        "N=250,500,1000,2000,500,1000,2000,1000,2000,4000",
        "--confirmed",
        "--json",
        "--log",
        "none",
    ];
    let rows = json(&fdcc(&folder, &table, ""));
    for row in rows.as_array().expect("rows") {
        assert_eq!(row["optimality"]["says"], "nothing contradicts", "{row}");
    }
}

#[test]
fn solve_ends_with_2_where_the_replay_does_not_confirm() {
    let folder = folder("confirmed_solve", &[("ramp.fdc", RAMP.as_bytes())]);
    let racecar = smoothed_race_car();
    let cases: &[(&[&str], i32)] = &[
        (&["ramp.fdc", "--confirmed"], 0),
        (&[&racecar, "--method", "N=100"], 0),
        (&[&racecar, "--method", "N=100", "--confirmed"], 2),
        (&[&racecar, "--method", "N=100", "--confirmed", "--gap", "10"], 0),
        (&["ramp.fdc", "--confirmed", "--no-verify"], 3),
    ];
    for (arguments, code) in cases {
        let output = fdcc(&folder, &[&["solve", "--log", "none"], *arguments].concat(), "");
        expect_exit(&output, *code, &format!("{arguments:?}"));
    }
    let both = fdcc(&folder, &["solve", "ramp.fdc", "--confirmed", "--no-verify"], "");
    assert!(stderr(&both).contains("--no-verify"), "{}", stderr(&both));
}

#[test]
fn sweep_replays_each_row_and_tells_in_a_column() {
    let folder = folder("confirmed_sweep", &[("ramp.fdc", RAMP.as_bytes())]);
    let ramp = ["sweep", "ramp.fdc", "goal=1,2", "--confirmed", "--log", "none"];
    let output = fdcc(&folder, &ramp, "");
    expect_exit(&output, 0, "an exact scheme");
    let said = stdout(&output);
    assert!(said.lines().next().is_some_and(|head| head.ends_with("confirmed")), "{said}");
    assert_eq!(said.lines().skip(1).filter(|row| row.ends_with("yes")).count(), 2, "{said}");
    let racecar = smoothed_race_car();
    let sweep = ["sweep", &racecar, "N=50,60", "--log", "none", "--json"];
    let plain = json(&fdcc(&folder, &sweep, ""));
    assert!(plain[0].get("confirmed").is_none(), "{plain}");
    let output = fdcc(&folder, &[&sweep[..], &["--confirmed"]].concat(), "");
    expect_exit(&output, 2, "the true car leaves the track");
    for row in json(&output).as_array().expect("rows") {
        assert_eq!(
            (&row["confirmed"], &row["verification"]["confirmed"]),
            (&false.into(), &false.into())
        );
    }
    let both = ["sweep", "ramp.fdc", "goal=1,2", "--confirmed", "--no-verify"];
    expect_exit(&fdcc(&folder, &both, ""), 3, "nothing could be confirmed");
}
