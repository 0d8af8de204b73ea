//! Holds that are worth leaving, at the last time or for a moment inside of them.

use fdcc::{Model, Options, Solution};

fn solved(text: &str) -> Solution {
    let model = Model::from_text("departures", text).expect("a model");
    model.solve(&Options::default()).expect("an answer")
}

/// A mass on a spring with friction is pulled towards a place and turns; in the end it is let go.
/// By direct collocation of two phases with CasADi and IPOPT (Radau, 80 intervals each, `v` on its
/// side at all nodes).
#[test]
fn a_hold_is_left_in_the_end() {
    for (motion, cost, least) in [
        (
            "v start 0.8 | 2 | u - Sgn(s) - 1.7*x | 1.2",
            "0.4*u^2 | 2.8*(x(end) - 1)^2",
            0.7432813162,
        ),
        (
            "v start -0.61 | 3.66 | u - 0.54*Sgn(s) - 0.77*x | 2.19",
            "0.8*u^2 | 1.59*(x(end) + 1.42)^2 + 2.03*v(end)^2",
            0.9878763728,
        ),
    ] {
        let motion: Vec<&str> = motion.split(" | ").collect();
        let bound = motion[1];
        let (running, end) = cost.split_once(" | ").expect("two costs");
        let solution = solved(&format!(
            "time t in [0, {}] state x start 0 state {} control u in [-{bound}, {bound}]\n\
             surface s = v dynamics {{ x' = v  v' in {} }} minimize integral({running}) + {end}",
            motion[3], motion[0], motion[2]
        ));
        assert!(solution.is_certified(), "{}: {}", motion[2], solution.objective());
        assert!((solution.objective() - least).abs() < 1e-7, "{}", solution.objective());
    }
}

/// A control that leaves the surface for a short time gains 9 for each unit of it: `u = 3` costs
/// `9*(8 - 9)`.
#[test]
fn a_hold_that_a_needle_improves_is_not_certified() {
    let solution = solved(
        "time t in [0, 1] state x start 0 control u in [-3, 3] surface s = x
         dynamics { x' in u - 2*Sgn(s) } minimize integral(u^2*(8 - u^2)) + 5*x(end)^2",
    );
    assert!(!solution.is_certified() || solution.objective() < -1.0, "{}", solution.objective());
}

/// Where the control costs nothing, what a short push gains is of second order: a block that is a
/// little away from its place is not left there. Pushed by 2 and braked by 2.5, friction 0.5, it
/// gets to the place at rest in the time `sqrt(2 d (1/1.5 + 1/2.5))`.
#[test]
fn a_rest_beside_the_goal_is_no_optimum() {
    for (distance, duration) in [("0.001", 1.0), ("0.01", 1.0)] {
        let solution = solved(&format!(
            "time t in [0, {duration}] state x start 0 state v start 0 control u in [-2, 2]\n\
             surface slip = v dynamics {{ x' = v  v' in u - 0.5*Sgn(slip) }}\n\
             minimize integral((x - {distance})^2)"
        ));
        let d: f64 = distance.parse().expect("a number");
        let resting = d * d * duration;
        assert!(solution.objective() < 0.1 * resting, "{distance}: {}", solution.objective());
    }
}
