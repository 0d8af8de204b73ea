//! Solutions are checked by conditions that know nothing of the solver; both factorisations find
//! the same ones.

use fdcc_runtime::nlp::Status;
use fdcc_tests::models::{Changes, load, problem, refusal, solve, text_of};
use fdcc_tests::optimality::{Residuals, residuals};
use fdcc_tests::{Solved, documents};

/// Every model that can be solved, at a size that a test can wait for.
fn solvable() -> Vec<(String, String)> {
    // What measurements add to the Lagrangian is tested in `data.rs`, phases in `chains.rs`.
    let is_known = |text: &str| !text.contains("\ndata ") && !text.contains("\nphase ");
    let all = documents("models", "fdc").into_iter();
    all.filter(|(_, text)| is_known(text) && refusal(text).is_none()).collect()
}

fn assert_optimal(what: &str, found: &Residuals, objective: f64) {
    for (condition, residual, limit) in [
        ("all", found.error(objective), 1e-6),
        ("feasibility", found.feasibility, 1e-8),
        ("weighted violation", found.weighted_violation, 1e-5 * objective.abs().max(1.0)),
        ("signs", found.signs, 0.0),
        ("objective", found.objective, 1e-10),
    ] {
        // Written so that what is not a number fails.
        assert!(
            matches!(residual.partial_cmp(&limit), Some(order) if order.is_le()),
            "{what}: {condition} {found:?}"
        );
    }
}

#[test]
fn every_model_is_solved_to_a_point_that_meets_the_optimality_conditions() {
    for (name, text) in solvable() {
        let Solved { problem, outcome } = Solved::new(&text, &[], &[]);
        assert_optimal(&name, &residuals(&problem, &outcome), outcome.solution.objective);
    }
}

#[test]
fn both_factorisations_lead_to_the_same_solution() {
    for (name, text) in solvable() {
        let objective = |linear| {
            let method = [("linear", linear), ("solver", "interior_point")];
            let solved = Solved::new(&text, &[], &method);
            assert_optimal(
                &format!("{name}, {linear}"),
                &residuals(&solved.problem, &solved.outcome),
                solved.objective(),
            );
            solved.objective()
        };
        let (riccati, sparse) = (objective("riccati"), objective("sparse_ldl"));
        assert!((riccati - sparse).abs() <= 1e-7 * sparse.abs(), "{name}: {riccati} and {sparse}");
    }
}

#[test]
fn every_scheme_leads_to_a_point_that_meets_the_optimality_conditions() {
    let race = text_of("racecar");
    let euler = race.replace("scheme implicit_euler lagged (th)", "scheme euler");
    let cases: [(&str, &str, Changes); 13] = [
        ("euler", &euler, &[]),
        ("lagged", &race, &[]),
        ("implicit_euler", &euler, &[("scheme", "implicit_euler")]),
        ("midpoint", &euler, &[("scheme", "midpoint")]),
        ("trapezoid", &euler, &[("scheme", "trapezoid")]),
        ("trapezoid, linear", &euler, &[("scheme", "trapezoid"), ("controls", "linear")]),
        ("radau2", &euler, &[("scheme", "radau2")]),
        ("lagged, 2 steps", &race, &[("steps", "2")]),
        (
            "gauss1, 3 steps, polynomial",
            &euler,
            &[("scheme", "gauss1"), ("steps", "3"), ("controls", "polynomial")],
        ),
        ("radau3, polynomial", &euler, &[("scheme", "radau3"), ("controls", "polynomial")]),
        ("gauss2, polynomial", &euler, &[("scheme", "gauss2"), ("controls", "polynomial")]),
        ("gauss3, linear", &euler, &[("scheme", "gauss3"), ("controls", "linear")]),
        ("sqrt, wide", &race, &[("sigma", "0.3")]),
    ];
    for (scheme, text, method) in cases {
        let method = [&[("N", "200")], method].concat();
        let solved = Solved::new(text, &[], &method);
        assert_optimal(scheme, &residuals(&solved.problem, &solved.outcome), solved.objective());
    }
}

#[test]
fn a_wrong_multiplier_or_a_wrong_variable_is_noticed() {
    let Solved { problem, outcome } = Solved::new(&text_of("racecar"), &[], &[("N", "50")]);
    assert_optimal("as found", &residuals(&problem, &outcome), outcome.solution.objective);
    let spoilt = |change: &dyn Fn(&mut fdcc_runtime::nlp::Solution)| {
        let mut outcome = outcome.clone();
        change(&mut outcome.solution);
        residuals(&problem, &outcome)
    };
    assert!(spoilt(&|solution| solution.multipliers.constraints[17] += 1e-3).stationarity > 1e-4);
    assert!(spoilt(&|solution| solution.v[31] += 1e-3).feasibility > 1e-4);
    assert!(spoilt(&|solution| solution.multipliers.upper[5] = -1e-3).signs > 1e-4);
    let last = outcome.solution.v.len() - 1;
    assert!(spoilt(&|solution| solution.multipliers.upper[last] = 1e-3).complementarity > 1e-4);
    assert!(spoilt(&|solution| solution.v[2] = f64::NAN).feasibility.is_nan());
    assert!(spoilt(&|solution| solution.objective += 1e-3).objective > 1e-4);
}

/// The smallest cost with a control that is constant on each of N intervals is `12 d^2 / (T^3 (1 -
/// 1/N^2))`: the midpoint rule is exact then, and the mean square of the midpoints' distance from
/// the middle is `T^2 (1 - 1/N^2)/12`.
#[test]
fn a_convex_problem_goes_to_the_conic_solver_and_its_optimum_is_global() {
    for (d, duration, intervals) in [(1.0, 2.0, 200.0), (2.0, 1.0, 10.0)] {
        let (d_text, tf, n) = (format!("{d}"), format!("{duration}"), format!("{intervals}"));
        let parameters = [("d", d_text.as_str()), ("tf", tf.as_str())];
        let exact = 12.0 * d * d / (f64::powi(duration, 3) * (1.0 - 1.0 / (intervals * intervals)));
        for solver in ["auto", "convex", "interior_point"] {
            let problem =
                load("double_integrator", &parameters, &[("N", n.as_str()), ("solver", solver)]);
            let solved = Solved::of(problem);
            let conic = solver != "interior_point";
            assert!(
                (solved.objective() - exact).abs() < 1e-9 * exact,
                "{solver}: {}",
                solved.objective()
            );
            assert_eq!(
                (solved.outcome.convex, solved.outcome.solution.global),
                (conic, conic),
                "{solver}"
            );
            assert_optimal(
                solver,
                &residuals(&solved.problem, &solved.outcome),
                solved.objective(),
            );
        }
    }
}

/// With a bound `b` the control is `-b` until `s`, where `tanh(2 - s) (1 - b s) = b`, and `-tanh(2
/// - t) x` from then on.
fn regulator_cost(bound: f64) -> f64 {
    let excess = |s: f64| f64::tanh(2.0 - s) * (1.0 - bound * s) - bound;
    let (mut low, mut high) = (0.0, 2.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 { low = middle } else { high = middle }
    }
    let x = 1.0 - bound * low;
    let saturated = (1.0 - x.powi(3)) / (3.0 * bound) + bound * bound * low;
    saturated + x * x * f64::tanh(2.0 - low)
}

#[test]
fn bounds_on_a_convex_problem_are_kept_by_both_solvers() {
    let bound = 0.5;
    let exact = regulator_cost(bound);
    let objective = |solver| {
        let problem = load("regulator", &[("bound", "0.5")], &[("N", "400"), ("solver", solver)]);
        let solved = Solved::of(problem);
        assert!(solved.control("u").iter().all(|u| u.abs() <= bound + 1e-8));
        assert_optimal(solver, &residuals(&solved.problem, &solved.outcome), solved.objective());
        solved.objective()
    };
    let (conic, interior) = (objective("convex"), objective("interior_point"));
    assert!((conic - interior).abs() < 1e-6, "{conic} and {interior}");
    // Second order: 1e-5 is four times the error at N = 400.
    assert!((conic - exact).abs() < 1e-5, "{conic}, exact {exact}");
}

#[test]
fn the_conic_solver_refuses_what_is_not_convex() {
    let concave = "time t in [0, 1] state x start 0 control u in [-1, 0] dynamics { x' = u } \
                   minimize integral(-u^2)";
    let curved = "time t in [0, 1] state x start 0 control u in [-1, 1] dynamics { x' = u*x + u } \
                  minimize (x(end) - 0.3)^2";
    for text in [concave, curved] {
        let refused = fdcc_tests::models::try_solve(&problem(text, &[], &[("solver", "convex")]));
        assert!(refused.is_err(), "{text}");
        let outcome = solve(&problem(text, &[], &[]));
        assert!(
            !outcome.convex
                && !outcome.solution.global
                && outcome.solution.status == Status::Solved,
            "{text}"
        );
    }
}
