//! The guess is on a kink, whose derivative is 0 there or that of one side: it seems stationary,
//! and is left.

use fdcc::{Model, Options, Solution};

fn solved(text: &str) -> Solution {
    let model = Model::from_text("guesses_on_kinks", text).expect("a model");
    model.solve(&Options::default()).expect("an answer")
}

fn assert_left(text: &str, least: f64) {
    let solution = solved(text);
    let off = (solution.objective() - least).abs();
    assert!(solution.status().is_solved(), "{text}: {}", solution.status_name());
    assert!(off < 1e-6, "{text}: {} not {least}", solution.objective());
}

/// `u <= 0.5 + |a|` with `|a| <= 1`: `0.1*1.5^2 + 0.1 - 1.5`.
#[test]
fn that_of_a_bound() {
    assert_left(
        "free a in [-1, 1] guess 0 time t in [0, 1] state x start 0
         control u in [-3, 0.5 + abs(a)] guess 0 dynamics { x' = u }
         minimize integral(0.1*u^2) + 0.1*a^2 - x(end)",
        -1.175,
    );
}

/// `u = 3` until the jump: `9 - 10*3`.
#[test]
fn that_of_a_jump() {
    assert_left(
        "time t in [0, 2] state x start 0 state y start 0 control u in [-3, 3] guess 0
         surface clock = t - 1 jump k on clock rising at most 1 { y := 10*abs(x) }
         dynamics { x' = u  y' = 0 } minimize integral(u^2) - y(end)",
        -21.0,
    );
}

/// With `u = c` and `w = 10 c`: `2 c^2 - 10 c`, least at `c = 2.5`.
#[test]
fn that_of_a_path_condition() {
    assert_left(
        "time t in [0, 1] state x start 0 state y start 0 control u in [-3, 3] guess 0
         control w in [-30, 30] guess 0 dynamics { x' = u  y' = w } path y <= 10*abs(x)
         minimize integral(u^2 + 0.01*w^2) - y(end)",
        -12.5,
    );
}

/// One piece is flat: `u = 2` on the other costs `4 - 4*2`.
#[test]
fn that_of_pieces() {
    assert_left(
        "time t in [0, 1] state x start 0 control u in [-3, 3] dynamics { x' = u }
         minimize integral(u^2) + piecewise { x(end) <= 0 => 0  otherwise => -4*x(end) }",
        -4.0,
    );
}

/// A kink at which the objective is least is no saddle.
#[test]
fn an_optimum_on_a_kink_stays() {
    assert_left(
        "free a in [-1, 1] guess 0 time t in [0, 1] state x start 0
         control u in [-3, 1 - abs(a)] guess 0 dynamics { x' = u }
         minimize integral(0.1*u^2) - x(end)",
        -0.9,
    );
}
