//! The measured order of every scheme, in states and in integrals, on problems whose answers are
//! known.

use fdcc_tests::{Solved, rate};

/// Every scheme with its order.
const SCHEMES: [(&str, f64); 6] = [
    ("scheme euler", 1.0),
    ("scheme implicit_euler", 1.0),
    ("scheme implicit_euler lagged (x)", 1.0),
    ("scheme midpoint", 2.0),
    ("scheme trapezoid", 2.0),
    ("scheme rk4 tol = 1e-13", 4.0),
];
/// Of high order the grids are chosen between the first cancellations of errors and rounding.
fn grids(order: f64) -> [f64; 4] {
    if order > 2.0 { [30.0, 60.0, 120.0, 240.0] } else { [20.0, 40.0, 80.0, 160.0] }
}
/// A control that is held on each interval allows no more.
const MOST_WITH_CONTROL: f64 = 2.0;
const TOLERANCE: f64 = 0.15;
/// The same, relative, where the order is high and the errors span eight digits.
const RELATIVE_TOLERANCE: f64 = 0.05;

/// A quantity of a solution, by name, with its exact value.
type Known = (&'static str, fn(&Solved) -> f64, f64);

/// A model without a method block, and what is known of its solution.
struct Case {
    name: &'static str,
    text: &'static str,
    known: Vec<Known>,
}

fn check(case: &Case) {
    for (scheme, order) in SCHEMES {
        let grids = grids(order);
        let is_controlled = case.text.contains(" control ");
        let order = if is_controlled { f64::min(order, MOST_WITH_CONTROL) } else { order };
        let runs = grids.map(|n| {
            Solved::new(&format!("{} method {{ grid N = {n} {scheme} }}", case.text), &[], &[])
        });
        for (what, quantity, exact) in &case.known {
            let errors: Vec<f64> = runs.iter().map(|run| (quantity(run) - exact).abs()).collect();
            let measured = rate(&grids.map(|n| 1.0 / n), &errors);
            let report = format!(
                "{}, {scheme}: {what} has order {measured:.3}, errors {errors:?}",
                case.name
            );
            assert!(
                (measured - order).abs() < TOLERANCE.max(RELATIVE_TOLERANCE * order),
                "{report}"
            );
            // A rate says nothing of the limit: so it must be the known value itself that is
            // approached.
            assert!(errors[3] < 0.03 * (1.0 + exact.abs()), "{report}");
        }
    }
}

/// `x = (3 e^-t + sin t - cos t)/2`, so that `x(2)` and the integral of `x^2 + t` follow.
#[test]
fn a_linear_equation_with_a_time_dependent_right_side() {
    let t = 2.0f64;
    let x = |t: f64| (3.0 * (-t).exp() + t.sin() - t.cos()) / 2.0;
    check(&Case {
        name: "linear",
        text: "time t in [0, 2] state x start 1 dynamics { x' = -x + sin(t) } minimize integral(x \
               + t)",
        known: vec![
            ("x(end)", |run| run.end("x"), x(t)),
            // x' = -x + sin t, hence the integral of x is 1 - x(t) + 1 - cos t.
            ("the integral", Solved::objective, 2.0 - x(t) - t.cos() + t * t / 2.0),
        ],
    });
}

/// `x = 1/(1 + t)`: the integral of `x^2` is `1 - x(T)`, that of `t x` is `T - log(1 + T)`.
#[test]
fn a_nonlinear_equation() {
    check(&Case {
        name: "nonlinear",
        text: "time t in [0, 1] state x start 1 dynamics { x' = -x^2 } minimize integral(t*x)",
        known: vec![
            ("x(end)", |run| run.end("x"), 0.5),
            ("the integral", Solved::objective, 1.0 - f64::ln(2.0)),
        ],
    });
}

/// Riccati: `J = tanh(1) x_0^2` with `u = -tanh(1 - t) x`, so `x(1) = x_0/cosh(1)`; the costate is
/// `dJ/dx_0 = 2 tanh(1)`.
#[test]
fn a_linear_quadratic_optimal_control() {
    check(&Case {
        name: "linear quadratic",
        text: "time t in [0, 1] state x start 1 control u dynamics { x' = u } minimize \
               integral(x^2 + u^2)",
        known: vec![
            ("the objective", Solved::objective, f64::tanh(1.0)),
            ("x(end)", |run| run.end("x"), 1.0 / f64::cosh(1.0)),
            ("dJ/dx_0", |run| run.costate("x")[0], 2.0 * f64::tanh(1.0)),
        ],
    });
}

/// `x = 2 - cos t` reaches 5/2 at `t = 2 pi/3`; the integral of `x` until then is `2 T - sin T`.
#[test]
fn a_free_final_time_with_a_time_dependent_right_side() {
    let end = 2.0 * std::f64::consts::PI / 3.0;
    check(&Case {
        name: "free final time",
        text: "free T in [1, 3] guess 2 time t in [0, T] state x start 1 dynamics { x' = sin(t) } \
               end x == 2.5 minimize integral(x)",
        known: vec![
            ("T", |run| run.value("T"), end),
            ("the integral", Solved::objective, 2.0 * end - end.sin()),
        ],
    });
}

/// `x' = k x` with `k` free and `x(1) = 3`: `k = log 3`; the integral of `x` is `2/k`.
#[test]
fn an_unknown_in_the_right_side() {
    let k = f64::ln(3.0);
    check(&Case {
        name: "unknown rate",
        text: "free k in [0, 2] guess 0.5 time t in [0, 1] state x start 1 dynamics { x' = k*x } \
               end x == 3 minimize integral(x)",
        known: vec![("k", |run| run.value("k"), k), ("the integral", Solved::objective, 2.0 / k)],
    });
}

/// Start and duration that are no unit: `x = t e^(t - 1)` solves `x' = x (1 + 1/t)`; the integral
/// of `x/t` is `e^(T - 1) - 1`.
#[test]
fn a_start_time_that_is_not_zero() {
    let e = std::f64::consts::E;
    check(&Case {
        name: "late start",
        text: "time t in [1, 2] state x start 1 dynamics { x' = x*(1 + 1/t) } minimize \
               integral(x/t) + x(start)",
        known: vec![
            ("x(end)", |run| run.end("x"), 2.0 * e),
            ("the objective", Solved::objective, e),
        ],
    });
}

/// Steps inside an interval are steps: without a control, 3 steps in each of 20 intervals are 60
/// intervals.
#[test]
fn steps_inside_an_interval_are_steps() {
    let text = "time t in [0, 1] state x start 1 state y start 0 dynamics { x' = -x^2 + y*t y' = x \
                - y } \
                minimize integral(t*x) + integral(x)^2 + y(end)";
    for scheme in [
        "euler",
        "implicit_euler",
        "implicit_euler lagged (y)",
        "midpoint",
        "trapezoid",
        "rk4",
        "radau2",
        "gauss2",
    ] {
        let solved = |grid: &str| {
            Solved::new(&format!("{text} method {{ grid {grid} scheme {scheme} }}"), &[], &[])
        };
        let (one, other) = (solved("N = 20 steps 3"), solved("N = 60"));
        assert!((one.objective() - other.objective()).abs() < 1e-12, "{scheme}");
        for (k, x) in one.state("x").iter().enumerate() {
            assert!((x - other.state("x")[3 * k]).abs() < 1e-12, "{scheme}, grid point {k}");
        }
    }
}

/// With a control, steps are more accurate than their interval is: what is left is the error of the
/// control.
#[test]
fn steps_leave_the_control_as_it_is() {
    let text = "time t in [0, 1] state x start 1 control u dynamics { x' = u } minimize \
                integral(x^2 + u^2)";
    let solved =
        |method: &str| Solved::new(&format!("{text} method {{ grid N = 10 {method} }}"), &[], &[]);
    let (steps, exact) = (solved("steps 400 scheme implicit_euler"), solved("scheme radau5"));
    assert_eq!(steps.control("u").len(), 10);
    for (u, v) in steps.control("u").iter().zip(exact.control("u")) {
        assert!((u - v).abs() < 1e-3, "{u} and {v}");
    }
}
