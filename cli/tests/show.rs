//! `fdcc show`: a model at each stage of the compiler.

mod common;

use common::*;

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
