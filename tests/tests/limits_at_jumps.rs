//! Bounds just before a jump and just behind it: nodes say nothing of these times.

use fdcc::{Model, Options, Solution};

fn solved(text: &str) -> Solution {
    let model = Model::from_text("limits_at_jumps", text).expect("a model");
    model.solve(&Options::default()).expect("an answer")
}

fn assert_certified(text: &str, least: f64) {
    let solution = solved(text);
    let off = (solution.objective() - least).abs();
    assert!(solution.is_certified(), "{text}: {}", solution.status_name());
    assert!(off <= 1e-8 * least.abs().max(1.0), "{text}: {} not {least}", solution.objective());
}

/// A level that falls as `exp(-t/2)` until the next dose two units of time later, and has to stay
/// above 1: the dose is `e`. With the same condition at the end the second dose is what is left.
const DOSES: [(&str, f64); 3] = [
    (
        "free d in [0, 10] guess 3 time t in [0, 4] state c in [1, 100] start d
         surface clock = t - 2 dynamics { c' = -0.5*c }
         jump dose on clock rising at most 1 { c := c + 5 } minimize d",
        std::f64::consts::E,
    ),
    (
        "free d in [0, 10] guess 3 time t in [0, 4] state c start d
         surface clock = t - 2 dynamics { c' = -0.5*c } path c >= 1
         jump dose on clock rising at most 1 { c := c + 5 } minimize d",
        std::f64::consts::E,
    ),
    (
        "free d in [0, 10] guess 3 free e in [0, 10] guess 3 free ts in [1, 3] guess 2
         time t in [0, 4] state c in [1, 100] start d
         surface clock = t - ts dynamics { c' = -0.5*c }
         jump dose on clock rising at most 1 { c := c + e } minimize d + e + 0.0*ts",
        2.0 * std::f64::consts::E - 1.0,
    ),
];

#[test]
fn a_level_is_lowest_just_before_the_next_dose() {
    for (text, least) in DOSES {
        assert_certified(text, least);
    }
}

/// A stone that falls from rest at `h` lands with `sqrt(2 h)`, which may be 2.
#[test]
fn a_speed_is_largest_just_before_an_impact() {
    assert_certified(
        "free h0 in [0.1, 5] guess 1 time t in [0, 3] state h start h0
         state v in [-2, 5] start 0 control u in [-0.5, 0] surface ground = h
         dynamics { h' = v  v' = -1 + u }
         jump b on ground falling at most 1 { v := -0.5*v } maximize h0",
        2.0,
    );
}

/// A tank from which a batch of 1 is taken at `t = 1`, and which keeps 0.2: what is missing, 0.7,
/// is filled in before at a constant rate.
#[test]
fn a_state_is_bounded_just_behind_a_jump() {
    assert_certified(
        "time t in [0, 2] state h in [0.2, 1.5] start 0.5 control u in [0, 1]
         surface clock = t - 1 dynamics { h' = u }
         jump take on clock rising at most 1 { h := h - 1 } minimize integral(u^2)",
        0.49,
    );
}

/// A dose that is chosen, up to the limit at once: `a exp(-0.4 t)` is 0.3 for one unit of time, and
/// 1.2 for three, beside 1. Of two doses the bound holds of what the first one has left, too.
#[test]
fn a_bound_is_met_right_behind_a_jump_whose_size_is_chosen() {
    let square = |a: f64, time: f64| {
        let left = (-0.4 * time).exp();
        a * a * (1.0 - left * left) / 0.8 - 2.0 * a * (1.0 - left) / 0.4 + time
    };
    assert_certified(
        "free d in [0, 5] guess 1 time t in [0, 4] state c in [0, 1.2] start 0.3
         surface clock = t - 1 dynamics { c' = -0.4*c }
         jump dose on clock rising at most 1 { c := c + d } minimize integral((c - 1)^2)",
        square(0.3, 1.0) + square(1.2, 3.0),
    );
    assert_certified(
        "free d in [0, 5] guess 1 free e in [0, 5] guess 1 time t in [0, 4]
         state c in [0, 1.2] start 0.3 surface first = t - 1 surface second = t - 2.5
         dynamics { c' = -0.4*c } jump a on first rising at most 1 { c := c + d }
         jump b on second rising at most 1 { c := c + e } minimize integral((c - 1)^2)",
        square(0.3, 1.0) + 2.0 * square(1.2, 1.5),
    );
}

/// What a recorded motion breaks just before a jump is told: 2.7 exp(-1) = 0.99327 is.
#[test]
fn a_replay_looks_at_both_sides_of_a_jump() {
    let text = |bound: &str| {
        format!(
            "time t in [0, 4] state c {bound} start 2.7 surface clock = t - 2
             dynamics {{ c' = -0.5*c }} jump dose on clock rising at most 1 {{ c := c + 5 }}
             minimize c(end)"
        )
    };
    let free = solved(&text(""));
    let worst = |bound: &str| {
        let model = Model::from_text("limits_at_jumps", &text(bound)).expect("a model");
        let replay = model.verify(&free.record()).expect("it can be replayed");
        replay.conditions.iter().map(|it| it.violation).fold(0.0, f64::max)
    };
    assert!(worst("in [0.99, 100]") < 1e-9);
    let broken = worst("in [1, 100]") - (1.0 - 2.7 * (-1f64).exp());
    assert!(broken.abs() < 1e-8, "{broken}");
}
