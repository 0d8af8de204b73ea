//! The same problem in other units is solved to the same answer: a metre and a second are any
//! numbers of units of the model.

use fdcc_runtime::nlp::Status;
use fdcc_tests::models::{problem, solve};

/// So many units are a metre and a second.
const UNITS: [(f64, f64); 11] = [
    (1.0, 1.0),
    (1e-6, 1.0),
    (1e-3, 1.0),
    (1e3, 1.0),
    (1e6, 1.0),
    (1.0, 1e-3),
    (1.0, 1e3),
    (1e3, 1e3),
    (1e-3, 1e-3),
    (1e3, 1e-3),
    (1e-3, 1e3),
];
/// Without scaling some of these end after 592 iterations, others as "solved" with an objective
/// that is off by a factor of up to 1e5.
const MOST_ITERATIONS: usize = 200;

/// From rest to rest one metre away with at most 1 m/s^2: two seconds.
const LEAST_TIME: &str = "
    free T in [0.1*s, 20*s] guess s
    time t in [0, T]
    state x start 0
    state v start 0
    control a in [-m/s^2, m/s^2]
    dynamics { x' = v  v' = a }
    end x == m
    end v == 0
    minimize T
    method { grid N = 50 scheme midpoint }";

/// Bryson & Ho, Applied Optimal Control (1975), section 3.11, example 2: 4 / (9 l) with l = 1/9.
/// Nothing says how large speed and acceleration are.
const LEAST_EFFORT: &str = "
    time t in [0, s]
    state x in [-m, m/9] start 0
    state v start m/s
    control a
    dynamics { x' = v  v' = a }
    end x == 0
    end v == -m/s
    minimize integral(a^2/2)
    method { grid N = 200 scheme midpoint }";

/// A bead on a wire, one metre down and pi/2 as far to the side: half a turn of a wheel, `pi
/// sqrt(r/g)` with `2 r` = 1 m.
const LEAST_DESCENT: &str = "
    free T in [0.01*s, 10*s] guess s
    time t in [0, T]
    state x in [0, 10*m] start 0
    state y in [0, 10*m] start 0
    state v in [0, 100*m/s] start 0
    control angle in [0, pi] guess 1
    dynamics { x' = v*sin(angle)  y' = v*cos(angle)  v' = 9.81*m/s^2*cos(angle) }
    end x == pi/2*m
    end y == m
    minimize T
    method { grid N = 100 scheme midpoint }";

/// `exact` is the answer where a metre and a second are so many units.
fn the_same_in_all_units(text: &str, exact: impl Fn(f64, f64) -> f64) {
    for (metre, second) in UNITS {
        let text = format!("const m = {metre:e}\nconst s = {second:e}\n{text}");
        let solution = solve(&problem(&text, &[], &[])).solution;
        let (found, exact) = (solution.objective, exact(metre, second));
        let what =
            format!("{metre:e} {second:e}: {found:e} instead of {exact:e}, {:?}", solution.counts);
        assert_eq!(solution.status, Status::Solved, "{what}");
        assert!((found - exact).abs() <= 1e-3 * exact, "{what}");
        assert!(solution.counts.iterations <= MOST_ITERATIONS, "{what}");
    }
}

#[test]
fn the_least_time_is_two_seconds() {
    the_same_in_all_units(LEAST_TIME, |_, second| 2.0 * second);
}

/// It is convex: the conic solver is asked first.
#[test]
fn the_least_effort_is_known_to_each_solver() {
    let barrier = LEAST_EFFORT.replace("midpoint", "midpoint solver = interior_point");
    for text in [LEAST_EFFORT, &barrier] {
        the_same_in_all_units(text, |metre, second| 4.0 * metre.powi(2) / second.powi(3));
    }
}

#[test]
fn the_bead_is_as_fast_as_on_a_cycloid() {
    let exact = std::f64::consts::PI * (0.5_f64 / 9.81).sqrt();
    the_same_in_all_units(LEAST_DESCENT, |_, second| exact * second);
}

/// A guess that is hardly any, and one that is off by a rounding, are not what the numbers are
/// like.
#[test]
fn a_small_guess_is_not_a_size() {
    let swing = |guess: &str| {
        format!(
            "time t in [0, 2] state x start 0 state v start 0 control u in [-5, 5] guess {guess} \
             dynamics {{ x' = v v' = u - 0.2*v - sin(x) }} end x == 1 end v == 0 minimize \
             integral(u^2) \
             method {{ grid N = 50 scheme midpoint }}"
        )
    };
    let disc = |guess: &str| {
        format!(
            "time t in [0, 1] state x start 0.1 state y start 0 control u in [-5, 5] control w in \
             [-5, 5] \
             dynamics {{ x' = u y' = w }} guess {{ x = {guess} y = 0 }} path (x - 0.3)^2 + y^2 <= \
             1 + t \
             end (x - 2)^2 + (y - 1)^2 <= 1 minimize integral(u^2 + w^2) method {{ grid N = 20 \
             scheme midpoint }}"
        )
    };
    let unknown = |guess: &str| {
        format!(
            "free q guess {guess} time t in [0, 1] state x start 0 dynamics {{ x' = 0 }} \
             minimize (q - 2e5)^2 + 1e-9*q^4/4e10 method {{ solver = interior_point }}"
        )
    };
    let both = |of: &dyn Fn(&str) -> String, guesses: [&str; 2]| {
        let [plain, small] = guesses.map(|guess| solve(&problem(&of(guess), &[], &[])).solution);
        assert_eq!(
            (&plain.status, &small.status),
            (&Status::Solved, &Status::Solved),
            "{guesses:?}"
        );
        let (gap, most) = (plain.objective - small.objective, 3 * plain.counts.iterations + 10);
        assert!(gap.abs() < 1e-6 * plain.objective.abs(), "{guesses:?}: {gap:e}");
        assert!(small.counts.iterations < most, "{guesses:?}: {:?}", small.counts);
    };
    both(&swing, ["0.1", "1e-5"]);
    both(&swing, ["0.1", "1e-6"]);
    both(&disc, ["0.3", "0.1 + 0.2"]);
    both(&disc, ["0.3", "0.3 + 1e-6"]);
    both(&unknown, ["1", "1e-6"]);
}
