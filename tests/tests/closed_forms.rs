//! Problems with friction whose answers are known exactly, approached by smoothing at the rate of
//! the theory.
//!
//! Layers of width `sigma` cost an error of order `sigma`. Steps are a fixed small part of the
//! layer, with schemes whose own error is far smaller, so that what is measured is the layer.

use fdcc_runtime::problem::Problem;
use fdcc_tests::models::{Changes, load};
use fdcc_tests::{Solved, rate};

/// Widths, each with the number of intervals that resolves it.
const WIDTHS: [(f64, usize); 4] = [(0.08, 200), (0.04, 400), (0.02, 800), (0.01, 1600)];

fn at(name: &str, parameters: Changes, scheme: &str, (sigma, intervals): (f64, usize)) -> Problem {
    let (sigma, intervals) = (sigma.to_string(), intervals.to_string());
    load(name, parameters, &[("scheme", scheme), ("sigma", &sigma), ("N", &intervals)])
}

/// The solutions for all widths.
fn runs(name: &str, parameters: Changes, scheme: &str) -> Vec<Solved> {
    WIDTHS.iter().map(|&width| Solved::of(at(name, parameters, scheme, width))).collect()
}

/// The error of a quantity falls like `sigma`, to `last` at the smallest width.
fn assert_first_order(
    what: &str,
    runs: &[Solved],
    quantity: impl Fn(&Solved) -> f64,
    exact: f64,
    last: f64,
) {
    let errors: Vec<f64> = runs.iter().map(|run| (quantity(run) - exact).abs()).collect();
    let measured = rate(&WIDTHS.map(|width| width.0), &errors);
    assert!((measured - 1.0).abs() < 0.1, "{what}: rate {measured:.3}, errors {errors:?}");
    assert!(errors[WIDTHS.len() - 1] < last, "{what}: errors {errors:?}");
}

/// `J(x0) = (x0 + 1)^2/9 - x0^3/9 + (x0 + 6)^3/81`: the closed form of `models/crossing.fdc` (alpha
/// = 1).
fn crossing_cost(x0: f64) -> f64 {
    (x0 + 1.0).powi(2) / 9.0 - x0.powi(3) / 9.0 + (x0 + 6.0).powi(3) / 81.0
}

#[test]
fn a_surface_that_is_crossed() {
    let x0 = (9.0 - f64::sqrt(417.0)) / 8.0;
    assert!((crossing_cost(x0) - 1.523_772_775_374_957).abs() < 1e-14);
    let runs = runs("crossing", &[], "midpoint");
    assert_first_order("objective", &runs, Solved::objective, crossing_cost(x0), 1e-2);
    assert_first_order("argument", &runs, |run| run.value("x0"), x0, 5e-3);
}

/// `x(T) = alpha (T + x0/(2 + alpha)) + sigma log((2 + alpha)/alpha)/(2 + alpha)` up to
/// exponentially small terms: the bias of the state is of first order in the width, with a known
/// constant.
#[test]
fn the_bias_of_the_state_after_a_crossing_is_as_predicted() {
    for (sigma, intervals) in WIDTHS {
        let run = Solved::of(at("crossing", &[], "midpoint", (sigma, intervals)));
        let exact = 2.0 + run.value("x0") / 3.0;
        let bias = run.end("x") - exact;
        let predicted = sigma * f64::ln(3.0) / 3.0;
        assert!(
            (bias - predicted).abs() < 5e-3 * predicted,
            "sigma {sigma}: {bias:e}, predicted {predicted:e}"
        );
    }
}

/// `T = 2 sqrt(d U/(U^2 - mu^2))`
#[test]
fn the_shortest_time_from_rest_to_rest() {
    let (u, mu, d) = (2.0f64, 0.5f64, 1.0f64);
    let exact = 2.0 * (d * u / (u * u - mu * mu)).sqrt();
    assert!((exact - 1.460_593_486_680_443).abs() < 1e-14);
    let runs = runs("coulomb_rest", &[], "midpoint");
    assert_first_order("T", &runs, |run| run.value("T"), exact, 5e-4);
    let fastest = |run: &Solved| run.state("v").iter().copied().fold(0.0, f64::max);
    let switch = |run: &Solved| (u * u - mu * mu) / (2.0 * u) * exact - fastest(run);
    assert!(switch(&runs[3]).abs() < 5e-3, "largest speed");
}

/// Turning round at `t = V/(U + mu)`, a distance `V^2/(2 (U + mu))` too far back, then from rest to
/// rest.
fn reverse_time(mu: f64) -> f64 {
    let (u, v, d) = (2.0, 1.0, 1.0);
    let (turn, back) = (v / (u + mu), v * v / (2.0 * (u + mu)));
    turn + 2.0 * ((d + back) * u / (u * u - mu * mu)).sqrt()
}

/// For mu = 1/2 the error of first order nearly cancels between the crossing and the arrival, so
/// the rate is measured where it does not.
#[test]
fn the_shortest_time_with_a_crossing() {
    assert!((reverse_time(0.5) - 2.0).abs() < 1e-15);
    let runs = runs("coulomb_reverse", &[("mu", "1")], "midpoint");
    assert_first_order("T", &runs, |run| run.value("T"), reverse_time(1.0), 2e-3);
    let run = Solved::of(at("coulomb_reverse", &[], "midpoint", WIDTHS[3]));
    assert!((run.value("T") - 2.0).abs() < 2e-4, "T {}", run.value("T"));
    let v = run.state("v");
    let turn = v.iter().position(|v| *v > 0.0).expect("it turns round");
    assert!((run.outcome.trajectory.time[turn] - 0.4).abs() < 5e-3);
    assert!((run.state("x")[turn] + 0.2).abs() < 5e-3);
}

/// `lam_x = -2/3`; `lam_v` rises with slope 2/3 from -2/3 to -2/5, jumps back to -2/3 at the
/// crossing, and rises again.
#[test]
fn costates_jump_where_the_surface_is_crossed() {
    let run = Solved::of(at("coulomb_reverse", &[], "implicit_euler", WIDTHS[3]));
    let time = &run.outcome.trajectory.time;
    let exact = |t: f64| {
        if t < 0.4 { -2.0 / 3.0 + 2.0 / 3.0 * t } else { -2.0 / 3.0 + 2.0 / 3.0 * (t - 0.4) }
    };
    assert!(run.costate("x").iter().all(|lambda| (lambda + 2.0 / 3.0).abs() < 0.01));
    for (t, lambda) in time.iter().zip(run.costate("v")) {
        // Within the layer the costate is on its way from one value to the other.
        if (t - 0.4).abs() > 0.02 && *t < 1.98 {
            assert!(
                (lambda - exact(*t)).abs() < 0.01,
                "lam_v({t}) = {lambda}, exact {}",
                exact(*t)
            );
        }
    }
}

/// `J = (mu^2 T + 12 d^2/T^3)/2` as long as `T <= sqrt(6 d/mu)`.
#[test]
fn the_least_effort_from_rest_to_rest() {
    let exact = 43.0 / 72.0;
    let runs = runs("coulomb_energy", &[], "midpoint");
    assert_first_order("objective", &runs, Solved::objective, exact, 3e-3);
}
