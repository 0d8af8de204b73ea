//! Collocation schemes: their measured order in states, objectives, unknowns and costates, and what
//! controls are on an interval.

use fdcc_runtime::transcribe::TranscribedNlp;
use fdcc_tests::{Solved, rate};

/// A quantity of a solution by name, and its error.
type Known = (&'static str, fn(&Solved) -> f64);

/// A model without a method block, and what is known of its solution.
struct Case {
    name: &'static str,
    text: &'static str,
    known: Vec<Known>,
}

/// Errors below this are rounding.
const ROUNDING: f64 = 1e-12;

/// `radau1` to `radau5` have order `2s - 1`, `gauss1` to `gauss5` order `2s`.
fn schemes() -> impl Iterator<Item = (String, usize)> {
    (1..=5).flat_map(|s| [(format!("radau{s}"), 2 * s - 1), (format!("gauss{s}"), 2 * s)])
}

/// From the first grid whose errors fall as they will go on to do, to the last before rounding.
fn grids(order: usize) -> &'static [f64] {
    match order {
        1 | 2 => &[40.0, 80.0, 160.0, 320.0],
        3 | 4 => &[16.0, 24.0, 32.0, 48.0],
        5 | 6 => &[8.0, 12.0, 16.0, 24.0],
        7 | 8 => &[4.0, 6.0, 8.0, 10.0],
        _ => &[4.0, 6.0, 8.0],
    }
}

fn solved(text: &str, method: &str) -> Solved {
    Solved::new(
        &format!("{text} method {{ {method} solver = interior_point tol = 1e-12 }}"),
        &[],
        &[],
    )
}

fn check(case: &Case) {
    for (scheme, order) in schemes() {
        let grids = grids(order);
        let run = |n: &f64| {
            solved(case.text, &format!("grid N = {n} scheme {scheme} controls = polynomial"))
        };
        let runs: Vec<Solved> = grids.iter().map(run).collect();
        for (what, error) in &case.known {
            let errors: Vec<f64> = runs.iter().map(|run| error(run).abs()).collect();
            let above = errors.iter().take_while(|error| **error > ROUNDING).count();
            let report = format!("{}, {scheme}: {what}, errors {errors:?}", case.name);
            if above < 2 {
                assert!(errors.iter().all(|error| *error < 100.0 * ROUNDING), "{report}");
                continue;
            }
            let steps: Vec<f64> = grids[..above].iter().map(|n| 1.0 / n).collect();
            let measured = rate(&steps, &errors[..above]);
            let expected = order as f64;
            assert!(
                (measured - expected).abs() < (0.05 * expected).max(0.15),
                "{report}: order {measured}"
            );
        }
    }
}

/// `x = t e^(t - 1)`, and the integral of `x/t` is `e^(T - 1) - 1`.
#[test]
fn a_right_side_that_depends_on_time() {
    let e = |run: &Solved| run.end("x") / (4.0 * 3f64.exp()) - 1.0;
    check(&Case {
        name: "late start",
        text: "time t in [1, 4] state x start 1 dynamics { x' = x*(1 + 1/t) } minimize \
               integral(x/t) + x(start)",
        known: vec![("x(end)", e), ("the objective", |run| run.objective() / 3f64.exp() - 1.0)],
    });
}

/// `x' = k x`, `x(1) = 100`: `k = log 100`, and the integral of `x` is `99/k`.
#[test]
fn an_unknown_in_the_right_side() {
    check(&Case {
        name: "unknown rate",
        text: "free k in [0, 6] guess 0.5 time t in [0, 1] state x start 1 dynamics { x' = k*x } \
               end x == 100 minimize integral(x)",
        known: vec![
            ("k", |run| run.value("k") - 100f64.ln()),
            ("the objective", |run| run.objective() - 99.0 / 100f64.ln()),
        ],
    });
}

/// `x = 3 - 2 cos 2t` reaches 4 at `t = acos(-1/2)/2`, and the integral of `x` is `3T - sin 2T`.
#[test]
fn a_free_final_time() {
    fn end() -> f64 {
        (-0.5f64).acos() / 2.0
    }
    check(&Case {
        name: "free final time",
        text: "free T in [0.5, 1.5] guess 0.8 time t in [0, T] state x start 1 dynamics { x' = \
               4*sin(2*t) } \
               end x == 4 minimize integral(x)",
        known: vec![
            ("T", |run| run.value("T") - end()),
            ("the objective", |run| run.objective() - 3.0 * end() + (2.0 * end()).sin()),
        ],
    });
}

const REGULATOR: &str =
    "time t in [0, 5] state x start 1 control u dynamics { x' = u } minimize integral(x^2 + u^2)";

/// `J = tanh(T)`, `x = cosh(T - t)/cosh(T)`, and the costate `dJ/dx = 2 sinh(T - t)/cosh(T)`: with
/// a control that is a polynomial on each interval the optimal control problem has the order of the
/// scheme, in its costates, too.
#[test]
fn an_optimal_control_problem_with_its_costates() {
    check(&Case {
        name: "regulator",
        text: REGULATOR,
        known: vec![
            ("the objective", |run| run.objective() - 5f64.tanh()),
            ("x(end)", |run| run.end("x") - 1.0 / 5f64.cosh()),
            ("the costate at the start", |run| run.costate("x")[0] - 2.0 * 5f64.tanh()),
            ("the costate in the middle", |run| {
                let costate = run.costate("x");
                costate[costate.len() / 2] - 2.0 * 2.5f64.sinh() / 5f64.cosh()
            }),
        ],
    });
}

/// `u = -sinh(T - t)/cosh(T)`, at the times that a shape is defined by, and in the mean over an
/// interval.
#[test]
fn controls_are_what_their_shape_says() {
    let exact = |t: f64| -(5.0 - t).sinh() / 5f64.cosh();
    let cases = [
        ("trapezoid", "linear", 41, 0.07),
        ("radau2", "linear", 41, 2e-3),
        ("gauss3", "linear", 41, 2e-3),
        ("radau3", "polynomial", 120, 1e-4),
        ("gauss2", "polynomial", 80, 2e-4),
        ("gauss5", "polynomial", 200, 1e-9),
    ];
    for (scheme, shape, count, tolerance) in cases {
        let run = solved(REGULATOR, &format!("grid N = 40 scheme {scheme} controls = {shape}"));
        let trajectory = &run.outcome.trajectory;
        let nodes = trajectory.nodes.as_ref().expect("more than one value on an interval");
        assert_eq!((nodes.time.len(), nodes.values[0].len()), (count, count), "{scheme} {shape}");
        assert!(nodes.time.is_sorted_by(|a, b| a < b), "{scheme} {shape}: {:?}", nodes.time);
        for (time, value) in nodes.time.iter().zip(&nodes.values[0]) {
            let error = (value - exact(*time)).abs();
            assert!(error < tolerance, "{scheme} {shape} at {time}: {value}, error {error}");
        }
        for (k, mean) in trajectory.controls[0].iter().enumerate() {
            let ends = [k, k + 1].map(|k| (5.0 - trajectory.time[k]).cosh() / 5f64.cosh());
            let expected = (ends[1] - ends[0]) / (trajectory.time[k + 1] - trajectory.time[k]);
            assert!(
                (mean - expected).abs() < tolerance.max(2e-3),
                "{scheme} {shape}: mean {mean} of interval {k}, {expected}"
            );
        }
    }
}

/// A control that is held has one value on each interval, whatever the scheme, and then the optimum
/// is of order 2.
#[test]
fn a_held_control_has_one_value_on_an_interval() {
    let error = |n: f64| {
        let run = solved(REGULATOR, &format!("grid N = {n} scheme radau3"));
        assert!(run.outcome.trajectory.nodes.is_none());
        assert_eq!(run.outcome.trajectory.controls[0].len(), n as usize);
        run.objective() - 5f64.tanh()
    };
    let measured = rate(&[1.0 / 40.0, 1.0 / 160.0], &[error(40.0), error(160.0)]);
    assert!((measured - 2.0).abs() < 0.05, "order {measured}");
}

/// Bryson & Ho 1975, section 3.11: without a bound on `x` the optimum is `x = t (1 - t)`; with `x
/// <= l`, `l <= 1/6`, it is `4/(9 l)`. Path constraints and bounds of states hold at the nodes
/// inside the intervals, too.
#[test]
fn constraints_hold_at_the_nodes() {
    let limit = 1.0 / 9.0;
    let bounded = format!("state x in [-1, {limit}] start 0");
    let path = format!("state x start 0 path top: x <= {limit}");
    for (state, shape) in
        [(&bounded, "constant"), (&bounded, "polynomial"), (&path, "polynomial"), (&path, "linear")]
    {
        let run = Solved::new(
            &format!(
                "time t in [0, 1] {state} state v start 1 control u dynamics {{ x' = v v' = u }} \
                 end x == 0 end v == -1 \
                 minimize integral(u^2)/2 method {{ grid N = 25 scheme radau3 controls = {shape} }}"
            ),
            &[],
            &[],
        );
        let stages = TranscribedNlp::new(&run.problem).chain();
        let inner =
            (0..25).flat_map(|k| stages.inner(k).step_by(2)).map(|i| run.outcome.solution.v[i]);
        let top = inner.chain(run.state("x").iter().copied()).fold(0.0, f64::max);
        assert!(top <= limit + 1e-7, "{state}, {shape}: {top}");
        assert!((run.objective() - 4.0).abs() < 0.02, "{state}, {shape}: {}", run.objective());
    }
}
