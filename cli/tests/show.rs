//! `fdcc show`: a model at each stage of the compiler.

use crate::common::*;

#[test]
fn every_stage_of_a_model_can_be_shown() {
    let folder = folder("show", &[]);
    let (racecar, bounce) = (model("racecar"), model("bounce"));
    let cases: &[(&[&str], i32, &[&str])] = &[
        (&[&racecar], 0, &["racecar", "pos.x", "slip", "muN", "track", "Jacobian"]),
        (&[&racecar, "--set", "w=0.3"], 0, &["[-0.15, 0.15]"]),
        (&[&racecar, "--stage", "model"], 0, &["Sgn(slip)", "track"]),
        (&[&racecar, "--stage", "graph"], 0, &["# dynamics", "sigma(slip)"]),
        (&[&racecar, "--stage", "derivatives"], 0, &["d(pos.x')/d(vel.x)", "d2L/"]),
        (&[&racecar, "--stage", "clif"], 0, &["function ", "fmul"]),
        (&[&bounce, "--stage", "model"], 0, &["vx"]),
        (&[&bounce], 0, &["class    crossed", "`bounce` resets the state"]),
        (&[&racecar], 0, &["held if  abs(s)*v_tangential^2 <= muN"]),
        (&[&bounce, "--stage", "graph"], 0, &["# dynamics"]),
        (&[&racecar, "--stage", "modle"], 3, &["'model'"]),
        (&[&racecar, "--set", "W=1"], 3, &["did you mean `w`?"]),
        (&[&racecar, "--method", "kernel=round"], 3, &["tanh"]),
        (&["missing.fdc"], 4, &["missing.fdc cannot be read"]),
    ];
    for (arguments, code, words) in cases {
        let output = fdcc(&folder, &[&["show"], *arguments].concat(), "");
        expect_exit(&output, *code, &format!("{arguments:?}"));
        let all = stdout(&output) + &stderr(&output);
        words
            .iter()
            .for_each(|word| assert!(all.contains(word), "{arguments:?}: no {word} in {all}"));
        assert_eq!(stdout(&output).is_empty(), *code != 0, "the answer is on the standard output");
    }
}

const UNITS: &str = "
model shown
param c = 100 [mm/s]
time t in [0, 10] [ms]
state x [mm] in [0, 9] start 0
state v [m/s] start 0
control u [mm/s^2] in [-1, 1]
control k [mm/s] in [-3, 3]
surface s = x - 1 [mm]
let y = piecewise { x <= 4 [mm] => x  otherwise => 4 [mm] }
dynamics {
  x' in k*Sgn(s)
  v' = u
}
path lim: x + y <= 5 [mm]
path x <= 5
path v <= 2*c
path -1 <= x <= 3
path 4 >= x
minimize integral(u^2) / 1 [mm^2/s^3]
";

#[test]
fn numbers_are_in_declared_units_and_formulas_in_si() {
    let folder = folder("show_units", &[("shown.fdc", UNITS.as_bytes())]);
    let show = |more: &[&str]| {
        let output = fdcc(&folder, &[&["show", "shown.fdc"], more].concat(), "");
        expect_exit(&output, 0, "it is shown");
        stdout(&output)
    };
    let shown = show(&[]);
    let words = [
        "units      as declared; formulas in SI",
        "t0 = 0 ms",
        "tf = 10 ms",
        "x [mm] in [0, 9]",
        "c = 100 mm/s",
        "s = x - 0.001",
        "at k = 3 mm/s",
        "y C^0 at x == 4 [mm]",
        "lim [mm] <= 5",
        "x <= 5 (<= 5 mm)",
        "v <= 2*c (<= 0.2 m/s)",
        "-1 <= x <= 3 (in [-1, 3] mm)",
        "4 >= x (<= 4 mm)",
    ];
    words.iter().for_each(|it| assert!(shown.contains(it), "no {it} in {shown}"));
    for stage in ["model", "graph", "derivatives"] {
        assert!(show(&["--stage", stage]).starts_with("# formulas in SI\n"), "{stage}");
    }
    let in_si = fdcc(&folder, &["show", &model("bounce")], "");
    assert!(!stdout(&in_si).contains("formulas in SI"), "nothing else is declared");
}
