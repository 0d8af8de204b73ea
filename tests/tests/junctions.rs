//! Arcs of limits that begin or end where a control reaches its bound: the bound on the side of the
//! arc and the limit on the other one give the time of the junction together.

use fdcc::{Model, Options, Solution};
use std::f64::consts::PI;

fn solved(text: &str) -> Solution {
    let model = Model::from_text("junction", text).expect("nothing is wrong with it");
    model.solve(&Options::default()).expect("it can be solved")
}

/// The arcs of a certified answer: `(arc, from, to)`.
fn arcs(solution: &Solution, name: &str) -> Vec<(&'static str, f64, f64)> {
    let certificate = solution.certificate.as_ref().expect("the true system is meant");
    assert!(certificate.is_certified(), "{:?}", certificate.checks);
    let own = certificate.arcs.iter().find(|it| it.0 == name).expect("it is a control");
    own.1.iter().map(|it| (it.arc, it.from, it.to)).collect()
}

fn assert_near(what: &str, own: f64, exact: f64, tolerance: f64) {
    assert!((own - exact).abs() < tolerance * exact.abs(), "{what}: {own}, not {exact}");
}

/// Least isolation in an epidemic whose beds are limited (Miclo, Spiro & Weibull, *Optimal epidemic
/// suppression under an ICU constraint*, 2020): none until the beds are full, `S = S_1`; then
/// `u = 1 - gamma/(beta S)` while `S' = -gamma cap`, until `S = gamma/beta` and `u = 0`. On the way
/// `I + S - gamma/beta log S` does not change.
#[test]
fn beds_are_full_until_isolation_ends() {
    let text = "time t in [0, 100]\nstate S in [0, 1] start 0.99\nstate I in [0, 1] start 0.01\n\
                control u in [0, 1]\n\
                dynamics { S' = -0.3*(1 - u)*S*I  I' = 0.3*(1 - u)*S*I - 0.1*I }\n\
                path icu: I <= 0.2\nminimize integral(u)";
    let (cap, gamma, ratio): (f64, f64, f64) = (0.2, 0.1, 1.0 / 3.0);
    let constant = 1.0 - ratio * 0.99_f64.ln();
    // Newton's method; the function is convex, and this is to the right of its root.
    let mut full: f64 = 0.99;
    for _ in 0..50 {
        full -= (cap + full - ratio * full.ln() - constant) / (1.0 - ratio / full);
    }
    let objective = (full - ratio - ratio * (full / ratio).ln()) / (gamma * cap);
    let solution = solved(text);
    assert_near("J", solution.objective(), objective, 1e-8);
    let times = arcs(&solution, "u");
    let lasts = (full - ratio) / (gamma * cap);
    assert_near("the time of isolation", times[1].2 - times[1].1, lasts, 1e-5);
}

/// `x = sin t` until it is 1/2, and then stays there by `u = cos t`, which is 0 at a quarter of the
/// period: `J = 1/2`.
#[test]
fn a_limit_is_left_with_a_control_at_its_bound() {
    let text = format!(
        "time t in [0, {PI}]\nstate x start 0\ncontrol u in [0, 1]\n\
         dynamics {{ x' = cos(t) - u }}\npath cap: x <= 0.5\nminimize integral(u)"
    );
    let solution = solved(&text);
    assert_near("J", solution.objective(), 0.5, 1e-9);
    assert_near("the end of the arc", arcs(&solution, "u")[0].2, 0.5 * PI, 1e-7);
}

/// The same backwards: `u = 1` for a tenth, so that the limit is reached where its rate is 0; then
/// `u = -cos t` until the motion comes to 0 by itself. Later is dearer: `J` is the integral of
/// `t u`, and of `-t cos t` that is `-t sin t - cos t`.
#[test]
fn a_limit_is_reached_with_a_control_at_its_bound() {
    let text = format!(
        "time t in [0, {PI}]\nstate x start -0.6\ncontrol u in [0, 1]\n\
         dynamics {{ x' = cos(t) + u }}\npath cap: x <= 0.5\nend x == 0\nminimize integral(t*u)"
    );
    let solution = solved(&text);
    let until = |t: f64| -t * t.sin() - t.cos();
    let objective = 0.5 * 0.1 * 0.1 + until(5.0 * PI / 6.0) - until(0.5 * PI);
    assert_near("J", solution.objective(), objective, 1e-9);
    let times = arcs(&solution, "u");
    let found: Vec<&str> = times.iter().map(|it| it.0).collect();
    assert_eq!(found, ["max", "min", "free", "min"]);
    assert_near("the begin of the arc", times[2].1, 0.5 * PI, 1e-7);
}

/// A parcel on a belt is held all the time, and for a part of it with all the friction that there
/// is: a replay may call that slipping. With `s = 1 - t` the acceleration is `A s/s_1`, at most
/// `A = mu g`; from the distance, `s_1^2 = 3 - 6/A` and `J = 2 A^2 (1 - 2 s_1/3)`.
#[test]
fn a_belt_holds_with_all_friction() {
    let text = "time t in [0, 2]\nstate x start 0\nstate v start 0\nstate w start 0\n\
                control a in [-10, 10]\nsurface slip = v - w\n\
                dynamics { x' = v  v' in -0.3*9.81*Sgn(slip)  w' = a }\n\
                end x == 2\nend v == 0\nminimize integral(a^2)";
    let solution = solved(text);
    assert!(arcs(&solution, "a").iter().all(|it| it.0 == "free"));
    let most: f64 = 0.3 * 9.81;
    let corner = (3.0 - 6.0 / most).sqrt();
    let objective = 2.0 * most * most * (1.0 - 2.0 / 3.0 * corner);
    assert_near("J", solution.objective(), objective, 1e-7);
}

/// A roof with a corner: `x <= 1` and `x <= 1 - k (t - 2)`. Along it the best speed is 0 and `-k`,
/// in between it changes by 1 per time, as `u' = -1`: the corner is cut from `2 - k/2` to
/// `2 + k/2`, which is worth `k^3/12`. Before that `u = a - t` comes to the roof tangentially, at
/// `a = sqrt 2`; the end is on the roof.
fn cost_under_the_roof(k: f64) -> f64 {
    let rise = 2.0_f64.sqrt();
    let before = -rise.powi(3) / 3.0;
    let along = -2.0 * (2.0 - rise) + 2.0 * k * k - 2.0 * (2.0 - 2.0 * k);
    before + along - k.powi(3) / 12.0
}

/// However narrow the corner is, in time or in a state. Where it is not cut, `J` is off by 2e-6 and
/// 1e-5 of its size.
#[test]
fn a_corner_between_two_limits_is_cut() {
    let ways =
        [("state y start 0\ndynamics { x' = u  y' = 1 }", "y"), ("dynamics { x' = u }", "t")];
    for k in [0.05, 0.1] {
        for (dynamics, clock) in ways {
            let text = format!(
                "time t in [0, 4]\nstate x start 0\ncontrol u\n{dynamics}\npath one: x <= 1\n\
                 path two: x <= 1 - {k}*({clock} - 2)\nminimize integral(u^2) - 2*integral(x)"
            );
            let solution = solved(&text);
            assert!(solution.is_certified(), "{text}");
            assert_near(&text, solution.objective(), cost_under_the_roof(k), 3e-7);
        }
    }
}

/// The same roof, bent by a jump: there are free motions on both sides of it.
#[test]
fn a_corner_at_a_jump_is_cut() {
    let text = "time t in [0, 4]\nstate k start 0\nstate rate start 0\nstate lid start 1\n\
                state x start 0\ncontrol u\nsurface clock = k - 2\n\
                dynamics { k' = 1  rate' = 0  lid' = -rate  x' = u }\n\
                jump turn on clock rising at most 1 { rate := 0.1 }\npath under: x <= lid\n\
                minimize integral(u^2) - 2*integral(x)";
    let solution = solved(text);
    assert!(solution.is_certified());
    assert_near("J", solution.objective(), cost_under_the_roof(0.1), 1e-8);
}
