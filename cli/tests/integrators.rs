//! `fdcc simulate` with other tolerances and methods.

use crate::common::{expect_exit, fdcc, folder, json, number, stderr};

/// `y = cos t`.
const FAST: &str = "\
model fast
time t in [0, 1]
state y start 1
dynamics { y' = -1e4*(y - cos(t)) - sin(t) }
";

fn run(name: &str, options: &[&str]) -> serde_json::Value {
    let folder = folder(name, &[("fast.fdc", FAST.as_bytes())]);
    let output = fdcc(&folder, &[&["simulate", "fast.fdc", "--json"], options].concat(), "");
    expect_exit(&output, 0, name);
    json(&output)
}

#[test]
fn the_method_can_be_chosen_and_is_reported() {
    for (method, least_stiff, most_stiff) in
        [("auto", 1.0, 200.0), ("explicit", 0.0, 0.0), ("stiff", 5.0, 200.0)]
    {
        let found = run(&format!("integrators_{method}"), &["--integrator", method]);
        let stiff = number(&found["counts"]["stiff"]);
        assert!((least_stiff..=most_stiff).contains(&stiff), "{method}: {stiff} stiff steps");
        assert!((number(&found["end"]["y"]) - 1.0_f64.cos()).abs() < 1e-9, "{method}");
    }
}

#[test]
fn looser_tolerances_take_fewer_steps() {
    let steps = |rtol| {
        let options = ["--rtol", rtol, "--atol", rtol, "--integrator", "stiff"];
        number(&run("integrators_rtol", &options)["counts"]["steps"])
    };
    assert!(2.0 * steps("1e-4") < steps("1e-10"));
}

#[test]
fn tolerances_below_rounding_are_refused() {
    let folder = folder("integrators_refused", &[("fast.fdc", FAST.as_bytes())]);
    for option in [["--rtol", "0"], ["--rtol", "1e-20"], ["--atol", "0"], ["--integrator", "magic"]]
    {
        let output = fdcc(&folder, &["simulate", "fast.fdc", option[0], option[1]], "");
        expect_exit(&output, 3, option[0]);
        assert!(stderr(&output).contains(option[0]), "{}", stderr(&output));
    }
}
