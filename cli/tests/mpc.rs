//! `fdcc mpc`: a model controls a true system.

use crate::common::*;

/// It wants to be at 1, with a price on force.
const BLOCK: &str = "\
model block
param mu = 0.2
const g = 9.81 [m/s^2]
time t in [0, 1] [s]
state x [m] start 0
state v [m/s] start 0
control F in [-8, 8] [m/s^2]
surface slip = v
dynamics { x' = v  v' in F - mu * g * Sgn(slip) }
minimize integral(100 [1/s^4] * (x - 1 [m])^2 + 1 [1/s^2] * v^2 + 0.01 * F^2)
method { sigma = 0.01 [m/s]  N = 25 }
";

#[test]
fn a_block_is_brought_to_its_goal_and_friction_holds_it_there() {
    let plant = BLOCK.replace("mu = 0.2", "mu = 0.25");
    let files = [("block.fdc", BLOCK.as_bytes()), ("plant.fdc", plant.as_bytes())];
    let folder = folder("mpc_block", &files);
    for plant in [&[][..], &["--plant", "plant.fdc"]] {
        let arguments = ["mpc", "block.fdc", "--steps", "60", "--json"];
        let output = fdcc(&folder, &[&arguments[..], plant].concat(), "");
        expect_exit(&output, 0, &format!("{plant:?}"));
        let found = json(&output);
        let (time, x, v) = (&found["time"], &found["states"]["x"], &found["states"]["v"]);
        assert_eq!((column(time).len(), column(&found["controls"]["F"]).len()), (61, 60));
        assert!((column(time)[60] - 60.0 / 25.0).abs() < 1e-9, "{time}");
        assert!((column(x)[60] - 1.0).abs() < 0.1 && column(v)[60].abs() < 0.1, "{x} {v}");
    }
    let output = fdcc(&folder, &["mpc", "block.fdc", "--steps", "3", "--method", "N=10"], "");
    expect_exit(&output, 0, "in words");
    assert!(stdout(&output).starts_with(" 3 steps to 0.3 s, all solved: x = "), "{output:?}");
}

/// From rest the first step is what `solve` finds.
#[test]
fn the_first_step_is_the_solution_of_the_model() {
    let folder = folder("mpc_first", &[("block.fdc", BLOCK.as_bytes())]);
    let solved = json(&fdcc(&folder, &["solve", "block.fdc", "--json"], ""));
    let looped = json(&fdcc(&folder, &["mpc", "block.fdc", "--steps", "1", "--json"], ""));
    assert_eq!(looped["controls"]["F"][0], solved["controls"]["F"][0]);
    assert_eq!(looped["iterations"][0], solved["iterations"]);
}

#[test]
fn what_cannot_be_closed_is_told() {
    let unnamed = BLOCK.replace("sigma = 0.01 [m/s]", "");

    let far = RAMP.replace("goal = 1", "goal = 9");
    let pushed = "state x [m] start 0\nstate v [m/s] start 0\ncontrol F in [-8, 8] [N]\n\
        param m = 2 [kg]\ntime t in [0, 1] [s]\ndynamics { x' = v  v' = F/m }\n";
    let files = [("block.fdc", BLOCK), ("unnamed.fdc", &unnamed), ("pushed.fdc", pushed)];
    let files = [&files[..], &[("ramp.fdc", RAMP), ("far.fdc", &far)]].concat();
    let files: Vec<(&str, &[u8])> = files.iter().map(|it| (it.0, it.1.as_bytes())).collect();
    let folder = folder("mpc_wrong", &files);
    let cases: &[(&[&str], i32, &str)] = &[
        (&["unnamed.fdc", "--steps", "1"], 3, "names the width of its layers"),
        (&["ramp.fdc", "--steps", "1", "--plant", "block.fdc"], 3, "nobody controls `F`"),
        (&["block.fdc", "--steps", "1", "--plant", "ramp.fdc"], 3, "has no state `v`"),
        (&["block.fdc", "--steps", "1", "--plant", "pushed.fdc"], 3, "`F` is [m/s^2] in `block`"),
        (&["ramp.fdc", "--steps", "0"], 3, "--steps"),
        (&["ramp.fdc"], 3, "--steps"),
        (&["far.fdc", "--steps", "1"], 2, ""),
    ];
    for (arguments, code, words) in cases {
        let output = fdcc(&folder, &[&["mpc"], *arguments].concat(), "");
        expect_exit(&output, *code, &format!("{arguments:?}"));
        assert!(stderr(&output).contains(words), "{arguments:?}: {}", stderr(&output));
    }
}
