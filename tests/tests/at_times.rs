//! Conditions at times between the ends: closed forms, multipliers, and what goes along with a
//! solve.

use fdcc::{DataFiles, Expected, Model, Options, Solution, Start, check_with};
use fdcc_grammar::Code;
use fdcc_tests::documents;

fn model(name: &str) -> Model {
    let all = documents("tests/classics/at_times", "fdc");
    let text = all.into_iter().find(|it| it.0 == name).expect("it is there").1;
    Model::from_text(name, &text).expect("it has no mistake")
}

fn solved(model: &Model) -> Solution {
    let found = model.solve(&Options::default()).expect("it can be solved");
    assert!(found.is_solved(), "{:?}", found.status());
    found
}

/// A state at a time, which is a point of the grid.
fn at(found: &Solution, name: &str, time: f64) -> f64 {
    let point = found.time().iter().position(|it| (it - time).abs() < 1e-9);
    found.state(name).expect("it is declared")[point.expect("it is a point of the grid")]
}

#[test]
fn all_have_the_effort_of_their_closed_form() {
    let all = documents("tests/classics/at_times", "fdc");
    assert!(all.len() >= 4);
    for (name, text) in all {
        let found = solved(&Model::from_text(&name, &text).expect("it has no mistake"));
        for it in found.expectations() {
            let Expected::Compared(sides) = &it.outcome else { panic!("{name}: a number") };
            assert!(sides.holds, "{name}: {} is {}", it.origin.label, sides.left);
        }
        let replay = found.verify().expect("it can be replayed");
        assert!(replay.confirms(1e-6), "{name}: {:?}", replay.worst().map(|it| &it.label));
        assert!(replay.conditions.iter().any(|it| it.label.starts_with("at ")), "{name}");
        assert!(found.time().windows(2).all(|pair| pair[0] < pair[1]), "{name}");
    }
}

#[test]
fn the_state_is_where_the_conditions_say() {
    let found = solved(&model("via_point"));
    assert!((at(&found, "x", 0.4) - 1.0).abs() < 1e-8);
    assert_eq!(found.time().len(), 11);
    let found = solved(&model("held_back"));
    assert!((at(&found, "x", 0.4) - 0.2).abs() < 1e-7);
    let found = solved(&model("two_points"));
    for (name, time) in [("pos.x", 1.0), ("pos.y", 1.0), ("pos.y", 2.0)] {
        assert!((at(&found, name, time) - 1.0).abs() < 1e-8, "{name}");
    }
    assert!(at(&found, "vel.y", 2.0).abs() < 1e-8);
}

/// By the bound `b` the effort `12 + 3 (0.352 - b)^2/0.24^3` changes by `-6 (0.352 - b)/0.24^3`;
/// the costate of `x` falls by as much there.
#[test]
fn costates_jump_by_the_multiplier() {
    let found = solved(&model("held_back"));
    let slope = -6.0 * 0.152 / 0.24_f64.powi(3);
    let phases = &found.between_jumps.as_ref().expect("time is divided").outcome.phases;
    let last = |phase: usize| *phases[phase].trajectory.costates[0].last().expect("it has points");
    let after = |phase: usize| phases[phase].trajectory.costates[0][0];
    assert!((last(0) - after(1) + slope).abs() < 1e-4, "{} {}", last(0), after(1));
    assert!((last(1) - after(2)).abs() < 1e-4, "the second limit is far away");
    let multipliers = found.at_multipliers();
    let names: Vec<&str> = multipliers.iter().map(|it| it.0.as_str()).collect();
    assert_eq!(names, ["at 0.4: x <= b", "at 0.8: x <= 2"]);
    assert!((multipliers[0].1 - slope).abs() < 1e-4 && multipliers[1].1.abs() < 1e-4);
    let [(name, value)] = found.sensitivities()[..] else { panic!("it has one parameter") };
    assert_eq!(name, "b");
    assert!((value - slope).abs() < 1e-4, "{value}");
}

/// `3 a^2/(h k)^3` with `k = 1 - h`: a parameter may be the time itself.
#[test]
fn times_may_be_parameters() {
    let model = model("via_point");
    let of = |found: &Solution, name: &str| {
        found.sensitivities().into_iter().find(|it| it.0 == name).expect("a parameter").1
    };
    let first = solved(&model);
    assert!((of(&first, "a") - 6.0 / 0.24_f64.powi(3)).abs() < 1e-3);
    assert!((of(&first, "h") + 9.0 * 0.2 / 0.24_f64.powi(4)).abs() < 1e-2);
    let other = model.with("h", 0.7).expect("a parameter");
    let effort = 3.0 / 0.21_f64.powi(3);
    assert!((solved(&other).objective() - effort).abs() < 1e-5);
    let warm = Options { start: Start::Solution(&first), ..Options::default() };
    let warm = other.solve(&warm).expect("it can be solved");
    assert!(warm.is_solved() && (warm.objective() - effort).abs() < 1e-5);
    let outside = model.with("h", 1.5).expect("a parameter");
    let told = outside.solve(&Options::default()).err().expect("not inside of the horizon");
    assert!(told.to_string().contains("not inside of the horizon"), "{told}");
}

/// A start at the own solution is there at once.
#[test]
fn a_solve_begins_where_another_ended() {
    for name in ["via_point", "via_time", "held_back"] {
        let model = model(name);
        let cold = solved(&model);
        let start = Options { start: Start::Solution(&cold), ..Options::default() };
        let warm = model.solve(&start).expect("it can be solved");
        let iterations = |it: &Solution| it.outcome.solution.counts.iterations;
        assert!(warm.is_solved() && iterations(&warm) <= iterations(&cold), "{name}");
    }
}

/// The best of several starts, and a grid that is refined.
#[test]
fn starts_and_refined_grids_go_along() {
    let model = model("via_time");
    let found = model.solve(&Options { starts: 3, ..Options::default() });
    let found = found.expect("it can be solved");
    assert_eq!(found.starts.len(), 3);
    assert!((found.objective() - 192.0).abs() < 1e-5);
    let refined = model.with_method("N", "auto").expect("a key of the method");
    assert!((solved(&refined).objective() - 192.0).abs() < 1e-3);
}

/// A replay that misses a point is not confirmed.
#[test]
fn a_replay_is_compared_at_the_time() {
    let model = model("via_point");
    let found = solved(&model);
    let elsewhere = model.with("a", 1.1).expect("a parameter");
    let mut record = found.record();
    record.params = elsewhere_params(&record.params);
    let replay = elsewhere.verify(&record).expect("it can be replayed");
    let worst = replay.worst().expect("it is violated");
    assert_eq!(worst.label, "at h: x == a");
    assert!((worst.violation - 0.1).abs() < 1e-6, "{}", worst.violation);
    assert!((worst.time.expect("it has a time") - 0.4).abs() < 1e-9);
}

fn elsewhere_params<'s>(params: &[(&'s str, f64)]) -> Vec<(&'s str, f64)> {
    let other = |it: &(&'s str, f64)| if it.0 == "a" { ("a", 1.1) } else { *it };
    params.iter().map(other).collect()
}

/// Rows of data divide time as well.
#[test]
fn a_sum_over_data_is_refused_beside_it() {
    let text = "free p in [0, 1]\ndata obs = csv(\"a.csv\") columns t, x\ntime t in [0, 1]\n\
                state x start 1\ndynamics { x' = -p*x }\nat 0.5: x <= 1\n\
                minimize sum(k in obs, (x(k.t) - k.x)^2)";
    let files = DataFiles::from(|_| Ok("t,x\n0.2,0.9\n0.7,0.8\n".to_owned()));
    let checked = check_with("a test", text.into(), Some(files));
    let codes: Vec<Code> = checked.diagnostics.iter().map(|it| it.code).collect();
    assert_eq!(codes, [Code::TimeBeside]);
}

/// Whoever contradicts a bound of the way is told that there is nothing.
#[test]
fn what_cannot_be_reached_is_infeasible() {
    let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]\ndynamics { x' = u }\n\
                at 0.5: x == 0.8\nminimize integral(u^2)";
    let model = Model::from_text("far", text).expect("it has no mistake");
    let found = model.solve(&Options::default()).expect("it is a status");
    assert_eq!(found.status_name(), "infeasible");
}
