//! What is said where nothing feasible is found: what was tried, and never that there is nothing,
//! unless it is proved.

use crate::common::*;

/// The torque is too small for fifty intervals of implicit Euler, not for a hundred.
const PENDULUM: &str = "model pendulum\ntime t in [0, 12]\nstate th start 0\nstate w start \
                        0\ncontrol u in [-0.6, 0.6]\nsurface slip = w\n\
    dynamics {\n  th' = w\n  w' in -sin(th) - 0.1*Sgn(slip) + u\n}\nend th == pi\nend w == \
    0\nminimize integral(u^2)\n";

/// Thrown from a metre below the rim.
const BELOW: &str = "model under\nfree v0 in [0, 20] guess 8\ntime t in [0, 2]\nstate h start \
                     -1\nstate v start v0\nsurface rim = h\n\
    dynamics {\n  h' = v\n  v' = -9.81\n}\njump bounce on rim falling at most 1 { v := -0.8*v \
    }\nend h == 0.5\nminimize v0^2\n\
    method { N = 50 scheme = midpoint }\n";

#[test]
fn what_one_grid_does_not_find_is_told_with_what_was_tried() {
    let folder = folder("none_found", &[("pendulum.fdc", PENDULUM.as_bytes())]);
    let solve = |more: &[&str]| {
        let smoothed = ["solve", "pendulum.fdc", "--log", "none", "--method", "sigma=0.01"];
        let all = [&smoothed[..], &["--method", "N=50"], more].concat();
        let output = fdcc(&folder, &all, "");
        expect_exit(&output, 2, "nothing is found");
        output
    };
    let told = solve(&[]);
    let (verdict, diagnostic) =
        (stdout(&told), stderr(&told).split_whitespace().collect::<Vec<_>>().join(" "));
    assert!(verdict.contains("NOT SOLVED, found none from this guess: "), "{verdict}");
    assert!(verdict.contains("solves with N = 50, sigma "), "{verdict}");
    for text in [&verdict, &diagnostic] {
        assert!(
            text.contains("`--starts 8`") && text.contains("found none from this guess"),
            "{text}"
        );
        assert!(!text.contains("infeasible") && !text.contains("cannot be met"), "{text}");
    }
    assert_eq!(json(&solve(&["--json"]))["status"], "none_found");
    let several = solve(&["--starts", "2", "--seed", "3", "--method", "max_iter=100"]);
    assert!(!stdout(&several).contains("infeasible"), "{}", stdout(&several));
}

#[test]
fn a_ball_from_below_the_rim_is_solved_and_confirmed() {
    let folder = folder("below_the_rim", &[("under.fdc", BELOW.as_bytes())]);
    let arguments = ["solve", "under.fdc", "--json", "--out", ".", "--method", "tol=1e-10"];
    let document = json(&fdcc(&folder, &arguments, ""));
    assert_eq!(
        (&document["status"], &document["verification"]["confirmed"]),
        (&"solved".into(), &true.into())
    );
    let names: Vec<_> =
        document["jumps"].as_array().expect("jumps").iter().map(|it| &it["jump"]).collect();
    assert_eq!(names, ["bounce"], "the crossing on the way up is no jump");
    let crosses = |it: &&serde_json::Value| it["crosses"] == serde_json::json!(["rim"]);
    let sequences = document["sequences"].as_array().expect("sequences");
    assert_eq!(sequences.iter().filter(crosses).count(), 2, "{sequences:?}");
    let verified = fdcc(&folder, &["verify", "under.sol.json"], "");
    expect_exit(&verified, 0, "the file is confirmed, too");
    let warm =
        fdcc(&folder, &["solve", "under.fdc", "--warm", "under.sol.json", "--log", "none"], "");
    expect_exit(&warm, 0, "its pieces are not taken for others");
}

#[test]
fn no_sequence_of_jumps_is_no_proof_that_there_is_none() {
    let far = BELOW.replace("end h == 0.5", "end h == 0.5\nend v == 100");
    let folder = folder("no_sequence", &[("under.fdc", far.as_bytes())]);
    let output = fdcc(&folder, &["solve", "under.fdc", "--log", "none"], "");
    expect_exit(&output, 2, "nothing is that fast");
    let verdict = stdout(&output);
    let told = "none of the sequences tried (crossing of rim, bounce; no jump; crossing of rim) \
                has a feasible trajectory near the guess";
    assert!(verdict.contains(told), "{verdict}");
    let all = verdict + &stderr(&output);
    assert!(!all.contains("infeasible") && !all.contains("certain"), "{all}");
    let document = json(&fdcc(&folder, &["solve", "under.fdc", "--json"], ""));
    let sequences = document["sequences"].as_array().expect("sequences");
    assert!(sequences.iter().all(|it| it["status"] == "none_found"), "{sequences:?}");
    assert_eq!(document["status"], "none_found");
}

#[test]
fn what_is_proved_keeps_its_words() {
    let folder = folder("proved_none", &[("ramp.fdc", RAMP.as_bytes())]);
    for solver in ["convex", "interior_point"] {
        let method = format!("solver={solver}");
        let arguments =
            ["solve", "ramp.fdc", "--set", "goal=5", "--log", "none", "--method", &method];
        let output = fdcc(&folder, &arguments, "");
        let said = stdout(&output);
        assert!(
            said.contains("NOT SOLVED, infeasible: proved: there is no trajectory of "),
            "{said}"
        );
        assert!(stderr(&output).contains("this is certain on this grid"), "{solver}");
    }
}

/// With |u| <= 4 the ramp comes to 4 and no further.
#[test]
fn the_page_tells_how_near_it_comes_and_where_it_is_off() {
    let folder = folder("near_page", &[("ramp.fdc", RAMP.as_bytes())]);
    let solve = ["solve", "ramp.fdc", "--set", "goal=5", "--out", ".", "--log", "none"];
    expect_exit(&fdcc(&folder, &solve, ""), 2, "too far");
    let page = std::fs::read_to_string(folder.join("ramp.html")).expect("it was written");
    let near = "comes to 4 instead of 5 (proved: no more is possible on this grid).";
    assert!(page.contains("With all else met, “") && page.contains(near), "{page}");
    assert!(page.contains("The largest violation is that of"), "{page}");
}

/// Friction brings a smoothed block near to rest; one that cannot be moved rests, and something
/// else stands in the way.
#[test]
fn what_only_friction_brings_to_rest_is_told_where_that_is_in_the_way() {
    let slides = "time t in [0, 1.59]\nstate v start 1\nsurface slip = v\n\
                  dynamics { v' in -Sgn(slip) }\nend v == 0\nmethod { sigma = 0.1 }\n";
    let stuck = "time t in [0, 2]\nstate x start 0\nstate v start 0\ncontrol F in [-1, 1]\n\
                 surface slip = v\ndynamics { x' = v  v' in F - 3*Sgn(slip) }\n\
                 end x == 1\nend v == 0\nmethod { sigma = 1e-3 }\n";
    let models = [("slides.fdc", slides.as_bytes()), ("stuck.fdc", stuck.as_bytes())];
    let folder = folder("rests", &models);
    let told = |file: &str| stdout(&fdcc(&folder, &["solve", file, "--log", "none"], ""));
    let is_told = |file: &str| told(file).contains("\n rest  `slip` has to be 0 at the end");
    assert!(is_told("slides.fdc"), "{}", told("slides.fdc"));
    assert!(!is_told("stuck.fdc"), "{}", told("stuck.fdc"));
}
