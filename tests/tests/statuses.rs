//! How solves end: the statuses of problems that have no solution, and features of the language on
//! problems whose answers are known.

use std::ops::ControlFlow;

use fdcc_runtime::nlp::{Status, Stop};
use fdcc_runtime::solve::{self, Outcome};
use fdcc_tests::Solved;
use fdcc_tests::models::{Changes, load, problem, solve};
use fdcc_tests::optimality::residuals;

/// Solves a text with the interior point method, whatever it is.
fn outcome(text: &str, methods: Changes) -> Outcome {
    solve(&problem(text, &[], &[&[("solver", "interior_point")], methods].concat()))
}

/// The text of the model at the place that the outcome blames.
fn blamed<'t>(text: &'t str, origin: &fdcc_runtime::problem::Origin) -> &'t str {
    &text[origin.span.0 as usize..origin.span.1 as usize]
}

/// From rest to rest over a distance `d` with `|u| <= 1` takes at least `2 sqrt(d)`.
const TOO_FAST: &str = "time t in [0, 1.9] state x start 0 state v start 0 control u in [-1, 1] \
     dynamics { x' = v v' = u } end x == 1 end v == 0 minimize integral(u^2) method { grid N = 40 \
     scheme midpoint }";

#[test]
fn a_goal_that_cannot_be_reached_in_time_is_infeasible() {
    for solver in ["interior_point", "auto"] {
        let found = solve(&problem(TOO_FAST, &[], &[("solver", solver)]));
        assert_eq!(found.solution.status, Status::Infeasible, "{solver}");
        assert!(found.solution.constraint_violation > 1e-3, "{solver}");
        assert!(found.limiting.expect("a row is violated").violation > 1e-3, "{solver}");
    }
    let enough = TOO_FAST.replace("1.9", "2.1");
    assert_eq!(outcome(&enough, &[]).solution.status, Status::Solved);
}

/// With `|x''| <= 1` from rest `x <= t^2/2`, but the path asks for `t^2`.
#[test]
fn a_path_that_cannot_be_followed_is_infeasible_and_what_limits_it_is_named() {
    let text = "time t in [0, 2] state x start 0 state v start 0 control u in [-1, 1] dynamics { \
                x' = v v' = u } \
                path ahead: x >= t^2 minimize integral(u^2) method { grid N = 40 scheme midpoint }";
    let found = outcome(text, &[]);
    assert_eq!(found.solution.status, Status::Infeasible);
    let limiting = found.limiting.expect("a row is violated");
    assert!(["ahead", "x'", "v'"].contains(&&*limiting.origin.label), "{limiting:?}");
    assert!(
        limiting.violation > 0.01 && limiting.time.is_some_and(|time| time > 0.0),
        "{limiting:?}"
    );
}

#[test]
fn contradictory_conditions_are_infeasible() {
    let text = "time t in [0, 1] state x start 0 control u in [-1, 1] dynamics { x' = u } \
                path low: x <= 1 end x == 2 minimize integral(u^2) method { grid N = 10 }";
    assert_eq!(outcome(text, &[]).solution.status, Status::Infeasible);
    assert_eq!(solve(&problem(text, &[], &[])).solution.status, Status::Infeasible);
}

#[test]
fn an_objective_without_end_is_unbounded() {
    let text = "time t in [0, 1] state x start 0 control u dynamics { x' = u } maximize x(end) \
                method { grid N = 10 }";
    assert_eq!(outcome(text, &[]).solution.status, Status::Unbounded);
    assert_eq!(solve(&problem(text, &[], &[])).solution.status, Status::Unbounded);
}

#[test]
fn what_is_not_finite_is_blamed_on_its_line() {
    for (text, culprit) in [
        (
            "time t in [0, 1] state x start -1 dynamics { x' = sqrt(x) } minimize x(end)^2",
            "x' = sqrt(x)",
        ),
        (
            "time t in [0, 1] state x start 0 dynamics { x' = log(x) } minimize x(end)^2",
            "x' = log(x)",
        ),
        (
            "time t in [0, 1] state x start 1 dynamics { x' = -x } path far: log(x - 2) <= 0 \
             minimize x(end)^2",
            "log(x - 2)",
        ),
        (
            "time t in [0, 1] state x start 1 dynamics { x' = -x } end sqrt(-x^2) <= 1 minimize \
             x(end)^2",
            "sqrt(-x^2) <= 1",
        ),
        (
            "time t in [0, 1] state x start 1 dynamics { x' = -x } minimize log(-x(end)^2)",
            "log(-x(end)^2)",
        ),
    ] {
        match outcome(text, &[("N", "5"), ("scheme", "euler")]).solution.status {
            Status::NotFinite(place) => {
                assert!(blamed(text, &place.origin).contains(culprit), "{text}: {place:?}")
            }
            status => panic!("{text}: {status:?}"),
        }
    }
}

#[test]
fn the_limit_on_iterations_is_kept_and_the_best_iterate_returned() {
    let found = solve(&load("racecar", &[], &[("max_iter", "3"), ("N", "100")]));
    assert_eq!(
        (found.solution.status, found.solution.counts.iterations),
        (Status::IterationLimit, 3)
    );
    assert!(found.solution.v.iter().all(|value| value.is_finite()));
    assert_eq!(found.trajectory.time.len(), 101);
}

#[test]
fn the_caller_can_stop_a_solve_and_gets_the_iterate() {
    for (stop, status) in
        [(Stop::TimeLimit, Status::TimeLimit), (Stop::Interrupted, Status::Interrupted)]
    {
        // With widths of our own choice, and with the one that the model names.
        for (name, last) in [("racecar", 5), ("block", 2), ("racecar", 0)] {
            let problem = load(name, &[], &[("N", "100")]);
            let mut seen = 0;
            let found = solve::solve(&problem, None, &mut |progress, _| {
                seen = progress.iteration;
                if progress.iteration >= last {
                    ControlFlow::Break(stop)
                } else {
                    ControlFlow::Continue(())
                }
            });
            let found = found.expect("not refused");
            assert_eq!((&found.solution.status, seen), (&status, last), "{name}");
            assert_eq!(found.trajectory.states.len(), problem.states.len());
        }
    }
}

/// A model, a quantity of its solution, and the value that is known.
type Known = (&'static str, fn(&Solved) -> f64, f64);

fn check(what: &str, text: &str, tolerance: f64, known: &[Known]) {
    let text = format!("{text} method {{ grid N = 100 scheme midpoint }}");
    for solver in ["auto", "interior_point"] {
        let solved = Solved::new(&text, &[], &[("solver", solver)]);
        for (name, quantity, exact) in known {
            let got = quantity(&solved);
            assert!(
                (got - exact).abs() <= tolerance,
                "{what}, {solver}: {name} = {got}, exact {exact}"
            );
        }
        let residuals = residuals(&solved.problem, &solved.outcome);
        assert!(
            residuals.stationarity < 1e-6 && residuals.feasibility < 1e-8,
            "{what}, {solver}: {residuals:?}"
        );
    }
}

#[test]
fn an_equality_on_the_path() {
    // The control must follow: x = t^2/2 gives x' = t = u, and the cost is the integral of t^2.
    check(
        "path equality",
        "time t in [0, 1] state x start 0 control u dynamics { x' = u } path x == t^2/2 minimize \
         integral(u^2)",
        1e-4,
        &[("x(end)", |run| run.end("x"), 0.5), ("the objective", Solved::objective, 1.0 / 3.0)],
    );
}

#[test]
fn a_control_that_its_bounds_fix() {
    check(
        "fixed control",
        "time t in [0, 1] state x start 0 control u in [2, 2] control w in [-1, 1] dynamics { x' = \
         u + w } minimize x(end)",
        1e-6,
        &[("x(end)", |run| run.end("x"), 1.0), ("u", |run| run.control("u")[7], 2.0)],
    );
}

#[test]
fn a_model_without_controls() {
    check(
        "no control",
        "free a in [0, 5] guess 1 time t in [0, 1] state x start a dynamics { x' = -x } minimize \
         (x(end) - 1)^2",
        // Midpoint: second order, 1e-2/12 of a relative error per unit of time.
        1e-4,
        &[("a", |run| run.value("a"), std::f64::consts::E), ("x(end)", |run| run.end("x"), 1.0)],
    );
}

#[test]
fn a_model_without_an_objective() {
    // Any feasible trajectory will do; only its end is known.
    check(
        "no objective",
        "time t in [0, 1] state x start 0 control u in [-2, 2] dynamics { x' = u } end x == 1",
        1e-8,
        &[("x(end)", |run| run.end("x"), 1.0), ("the objective", Solved::objective, 0.0)],
    );
}

/// At each time `exp(u) - t u` is least at `u = ln(t)`, or at the bound; with implicit Euler `t` is
/// that of the end of an interval.
#[test]
fn a_model_without_states() {
    let text = "time t in [0, 1] control u in [-1, 1] minimize integral(exp(u) - t*u) method { \
                grid N = 20 }";
    let found = outcome(text, &[]).solution;
    assert_eq!(found.status, Status::Solved);
    let best = |t: f64| t.ln().max(-1.0);
    let times = (1..=20).map(|k| f64::from(k) / 20.0);
    let exact: f64 = times.map(|t| (best(t).exp() - t * best(t)) / 20.0).sum();
    assert!((found.objective - exact).abs() < 1e-7, "{} instead of {exact}", found.objective);
}

#[test]
fn a_model_without_states_to_choose() {
    check(
        "simulation",
        "time t in [0, 2] state x start 1 dynamics { x' = -x }",
        1e-4,
        &[("x(end)", |run| run.end("x"), f64::exp(-2.0))],
    );
}

/// `x = a + b t` through (0, 1) and (1, 3), with the third unknown at its own optimum.
#[test]
fn several_unknowns() {
    check(
        "unknowns",
        "free a in [-9, 9] guess 0 free b in [-9, 9] guess 0 free c in [-9, 9] guess 0 \
         time t in [0, 1] state x start a dynamics { x' = b } start x == 1 end x == 3 minimize (c \
         - a*b)^2",
        1e-6,
        &[
            ("a", |run| run.value("a"), 1.0),
            ("b", |run| run.value("b"), 2.0),
            ("c", |run| run.value("c"), 2.0),
        ],
    );
}

/// `min x(0)^2 + (x(1) - 2)^2 + int u^2` with `x' = u`: with `u` constant, `u = 2/3` and `x(0) =
/// 2/3`; the cost is 4/3.
#[test]
fn a_start_that_is_free() {
    check(
        "free start",
        "time t in [0, 1] state x start free in [-5, 5] control u dynamics { x' = u } \
         minimize x(start)^2 + (x(end) - 2)^2 + integral(u^2)",
        1e-6,
        &[
            ("x(start)", |run| run.state("x")[0], 2.0 / 3.0),
            ("the objective", Solved::objective, 4.0 / 3.0),
        ],
    );
}

/// `x' = -x + 1 + u` with `x(start) == x(end)` and nothing to pay for but `u`: rest at 1.
#[test]
fn a_periodic_condition() {
    check(
        "periodic",
        "time t in [0, 3] state x start free in [-5, 5] control u dynamics { x' = 1 - x + u } \
         end x == x(start) minimize integral(u^2)",
        1e-5,
        &[("x(start)", |run| run.state("x")[0], 1.0), ("the objective", Solved::objective, 0.0)],
    );
}

/// The nearest way to a half line: straight to its end, `u = 1/2`.
#[test]
fn an_inequality_at_the_end() {
    check(
        "end inequality",
        "time t in [0, 2] state x start 0 control u dynamics { x' = u } end x >= 1 minimize \
         integral(u^2)",
        1e-6,
        &[("x(end)", |run| run.end("x"), 1.0), ("the objective", Solved::objective, 0.5)],
    );
}

/// The farthest one gets in unit time with `int u^2 <= 3`: `u = sqrt 3`.
#[test]
fn a_limit_on_an_integral() {
    check(
        "integral constraint",
        "time t in [0, 1] state x start 0 control u in [-9, 9] guess 1 dynamics { x' = u } \
         end integral(u^2) <= 3 maximize x(end)",
        1e-6,
        &[
            ("x(end)", |run| run.end("x"), f64::sqrt(3.0)),
            ("the objective", Solved::objective, f64::sqrt(3.0)),
        ],
    );
}

/// `x' = u cos t` on [0, pi]: `u = sign(cos t)` gives 2. The switch at the middle of the grid costs
/// nothing.
#[test]
fn time_in_the_dynamics_and_an_objective_to_maximise() {
    check(
        "time-dependent",
        "time t in [0, pi] state x start 0 control u in [-1, 1] dynamics { x' = u*cos(t) } \
         maximize x(end)",
        1e-3,
        &[
            ("the objective", Solved::objective, 2.0),
            ("u at first", |run| run.control("u")[3], 1.0),
        ],
    );
}

/// Up in half a unit of time, then along the bound: 1/8 + 3/4.
#[test]
fn bounds_on_a_state() {
    check(
        "state bound",
        "time t in [0, 2] state x in [-1, 0.5] start 0 control u in [-1, 1] dynamics { x' = u } \
         maximize integral(x)",
        1e-3,
        &[("x(end)", |run| run.end("x"), 0.5), ("the objective", Solved::objective, 0.875)],
    );
}
