//! `N = auto`: grids that follow the solution down to a tolerance.

use fdcc_tests::models::{Refined, problem, refine};
use fdcc_tests::optimality::residuals;
use std::ops::ControlFlow;

fn refined(text: &str, methods: &[(&str, &str)]) -> Refined {
    let problem = problem(text, &[], methods);
    refine(&problem, &mut |_, _| ControlFlow::Continue(()))
}

/// A fast transient, `x' = -500 (x - cos t)`, without a control: `x` follows `cos t` after a layer
/// of length 1/500.
const STIFF: &str =
    "time t in [0, 2] state x start 0 dynamics { x' = -500*(x - cos(t)) } minimize integral(x)";

/// From the solution of the linear equation: with `a = 500`, `x = (a^2 cos t + a sin t)/(a^2 + 1) -
/// a^2/(a^2 + 1) e^(-a t)`.
fn transient(t: f64) -> f64 {
    let a = 500.0f64;
    (a * a * t.cos() + a * t.sin() - a * a * (-a * t).exp()) / (a * a + 1.0)
}

#[test]
fn the_error_is_below_the_tolerance_and_the_grid_is_fine_where_it_has_to_be() {
    for (scheme, tolerance, most) in [
        ("implicit_euler", 1e-2, 2000),
        ("trapezoid", 1e-3, 1000),
        ("radau2", 1e-4, 400),
        ("radau3", 1e-6, 250),
    ] {
        let methods = [("N", "auto"), ("scheme", scheme), ("tolerance", &tolerance.to_string())];
        let Refined { problem, outcome, error } = refined(STIFF, &methods);
        let (time, x) = (&outcome.trajectory.time, &outcome.trajectory.states[0]);
        assert!(error.is_some_and(|error| error <= tolerance), "{scheme}: {error:?}");
        assert!(
            problem.method.intervals() < most,
            "{scheme}: {} intervals",
            problem.method.intervals()
        );
        assert!(
            time[0] == 0.0 && time[time.len() - 1] == 2.0 && time.is_sorted_by(|a, b| a < b),
            "{scheme}"
        );
        let worst =
            time.iter().zip(x).fold(0.0f64, |worst, (t, x)| worst.max((x - transient(*t)).abs()));
        assert!(worst <= tolerance, "{scheme}: off by {worst}");
        let shortest = time.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        assert!(
            time[1] - time[0] < 2.0 * shortest
                && shortest < 0.3 * 2.0 / problem.method.intervals() as f64,
            "{scheme}"
        );
    }
}

/// The estimate itself: the error of implicit Euler steps of `x' = x` with length `h` is `x_k (1/(1
/// - h) - e^h)`.
#[test]
fn the_error_of_a_step_is_what_it_is() {
    let text = "time t in [0, 1] state x start 1 dynamics { x' = x } minimize x(end)";
    let Refined { outcome, error, problem } = refined(text, &[("N", "auto"), ("tolerance", "1")]);
    let h = 1.0 / problem.method.intervals() as f64;
    let x = &outcome.trajectory.states[0];
    let largest = x[x.len() - 2];
    let exact: f64 =
        x[..x.len() - 1].iter().map(|x| x * (1.0 / (1.0 - h) - h.exp()) / largest).sum();
    assert!(
        (error.expect("it was asked for") - exact).abs() < 1e-6 * exact,
        "{error:?} for {exact}"
    );
}

/// A regulator over a refined grid has the objective `tanh(2)` and the costate `2 sinh(T -
/// t)/cosh(T)` at its own times, with few iterations on every grid but the first.
#[test]
fn an_optimal_control_problem_on_a_grid_that_is_not_uniform() {
    let text = "time t in [0, 2] state x start 1 state fast start 0 control u \
                dynamics { x' = u fast' = -200*(fast - x) } minimize integral(x^2 + u^2)";
    let methods = [
        ("N", "auto"),
        ("scheme", "radau3"),
        ("controls", "polynomial"),
        ("tolerance", "1e-7"),
        ("solver", "interior_point"),
    ];
    let Refined { outcome, problem, .. } = refined(text, &methods);
    assert!(
        !problem.method.grid.times().is_empty() && problem.method.intervals() < 400,
        "{}",
        problem.method.intervals()
    );
    assert!(
        (outcome.solution.objective - 2f64.tanh()).abs() < 1e-8,
        "{}",
        outcome.solution.objective
    );
    for (t, costate) in outcome.trajectory.time.iter().zip(&outcome.trajectory.costates[0]) {
        let exact = 2.0 * (2.0 - t).sinh() / 2f64.cosh();
        assert!((costate - exact).abs() < 1e-6, "at {t}: {costate} for {exact}");
    }
    assert!(
        outcome
            .trajectory
            .hamiltonian
            .values
            .iter()
            .all(|h| (h - 2f64.cosh().powi(-2)).abs() < 1e-6)
    );
}

/// Bounds, path constraints, a free time and friction: what is carried over leads to the next
/// solution in few iterations.
#[test]
fn a_finer_grid_takes_few_iterations() {
    let text = "free T in [0.5, 10] guess 3 time t in [0, T] state x start 0 state v start 0 \
                control u in [-2, 2] surface slip = v \
                dynamics { x' = v v' in u - 0.5*Sgn(slip) } path slow: v <= 1 end x == 2 end v == \
                0 minimize T \
                method { smooth sigma = 0.02 scheme implicit_euler }";
    let coarse =
        fdcc_tests::Solved::new(text, &[], &[("N", "50")]).outcome.solution.counts.iterations;
    let Refined { outcome, problem, error } =
        refined(text, &[("N", "auto"), ("tolerance", "0.005")]);
    assert_eq!(outcome.solution.status, fdcc_runtime::nlp::Status::Solved);
    let found = residuals(&problem, &outcome);
    assert!(found.error(outcome.solution.objective) < 1e-7, "{found:?}");
    assert!(found.objective < 1e-12, "{found:?}");
    assert!(error.is_some_and(|error| error <= 0.005), "{error:?}");
    assert!(problem.method.intervals() > 100, "{}", problem.method.intervals());
    let iterations = outcome.solution.counts.iterations;
    assert!(iterations < coarse + 120, "{iterations} after {coarse}");
}
