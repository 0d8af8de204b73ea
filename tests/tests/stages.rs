//! `N = auto` with `scheme = radau` or `gauss`: the order is found together with the grid.

use fdcc_compiler::{Model, compile};
use fdcc_runtime::nlp::{Progress, Status};
use fdcc_runtime::solve::Level;
use fdcc_tests::models::{Refined, meaning, refine};
use fdcc_tests::repository;
use std::ops::ControlFlow;

fn refined(mut model: Model, methods: &[(&str, &str)]) -> Refined {
    for (key, value) in [("N", "auto")].iter().chain(methods) {
        model.set_method(key, value).unwrap_or_else(|error| panic!("{key} = {value}: {error}"));
    }
    let problem = compile(&model).expect("it can be solved");
    refine(&problem, &mut |_, _| ControlFlow::Continue(()))
}

fn stages(found: &Refined) -> usize {
    found.problem.method.scheme.stages()
}

/// Intervals times stages of an answer within the tolerance; nothing of another.
fn nodes(found: &Refined) -> Option<usize> {
    let is_met = found.error.is_some_and(|error| error <= found.problem.method.tolerance);
    is_met.then_some(found.problem.method.intervals() * stages(found))
}

/// A regulator: `x = cosh(T - t)/cosh T` and the objective is `tanh T`.
const REGULATOR: &str = "time t in [0, 5] state x start 1 control u dynamics { x' = u } minimize \
                         integral(x^2 + u^2) \
     method { grid N = auto scheme radau controls = polynomial solver = interior_point tol = 1e-12 \
     }";

/// Where everything is smooth the true error goes down to the tolerance by more stages; intervals
/// are divided only where the control is steep at first.
#[test]
fn a_smooth_solution_gets_stages_and_the_true_error_falls_to_the_tolerance() {
    for scheme in ["radau", "gauss"] {
        let mut before = 0;
        for tolerance in ["1e-4", "1e-6", "1e-8", "1e-10"] {
            let found =
                refined(meaning(REGULATOR), &[("scheme", scheme), ("tolerance", tolerance)]);
            let trajectory = &found.outcome.trajectory;
            let off = |(t, x): (&f64, &f64)| (x - (5.0 - t).cosh() / 5f64.cosh()).abs();
            let states = trajectory.time.iter().zip(&trajectory.states[0]);
            let worst = states.map(off).fold(0.0, f64::max);
            let objective = (found.outcome.solution.objective - 5f64.tanh()).abs();
            let tolerance: f64 = tolerance.parse().expect("a number");
            assert!(worst.max(objective) <= tolerance, "{scheme} {tolerance}: {worst} {objective}");
            assert!(
                found.problem.method.intervals() <= 20,
                "{scheme} {tolerance}: {}",
                found.problem.method.intervals()
            );
            assert!(stages(&found) >= before, "{scheme} {tolerance}");
            before = stages(&found);
        }
        assert!(before >= 4, "{scheme}: {before} stages");
    }
}

/// Long steps with ten digits: of `x'' = -25 x` each step is known, and so is its error.
#[test]
fn the_errors_of_long_steps_are_what_they_are() {
    let text = "time t in [0, 10] state x start 1 state v start 0 dynamics { x' = v v' = -25*x } \
                minimize x(end) \
                method { grid N = auto scheme gauss controls = polynomial solver = interior_point \
                tol = 1e-13 }";
    let tolerance = 1e-9;
    let found = refined(meaning(text), &[("tolerance", "1e-9")]);
    let trajectory = &found.outcome.trajectory;
    let [x, v] = [0, 1].map(|state| &trajectory.states[state]);
    let size = v[..v.len() - 1].iter().fold(1.0f64, |most, v| most.max(v.abs()));
    let error = |k: usize| {
        let (sin, cos) = (5.0 * (trajectory.time[k + 1] - trajectory.time[k])).sin_cos();
        let (exact_x, exact_v) = (x[k] * cos + v[k] * sin / 5.0, v[k] * cos - 5.0 * x[k] * sin);
        (x[k + 1] - exact_x).abs().max((v[k + 1] - exact_v).abs() / size)
    };
    let exact: f64 = (0..found.problem.method.intervals()).map(error).sum();
    let estimate = found.error.expect("it was asked for");
    assert!((estimate - exact).abs() < 0.05 * tolerance, "{estimate} for {exact}");
    assert!(exact <= tolerance && found.problem.method.intervals() <= 80, "{exact}");
}

/// `x' = sqrt(s^2 + w^2)` with `s = t - 0.3`: rounded over `w` only, so that more stages gain
/// nothing before an interval is as short as that.
const KINK: &str = "time t in [0, 1] state x start 0 control u in [-1, 1] \
                    dynamics { x' = sqrt((t - 0.3)^2 + 1e-6) } minimize integral(u^2) \
                    method { grid N = auto scheme radau controls = polynomial solver = \
                    interior_point tol = 1e-12 }";

fn integral_of_kink(t: f64) -> f64 {
    let w2 = 1e-6f64;
    let at = |s: f64| 0.5 * (s * (s * s + w2).sqrt() + w2 * (s / w2.sqrt()).asinh());
    at(t - 0.3) - at(-0.3)
}

#[test]
fn intervals_are_divided_at_a_kink_instead() {
    for tolerance in [1e-6, 1e-8] {
        let methods = [("scheme", "radau"), ("tolerance", &tolerance.to_string())];
        let found = refined(meaning(KINK), &methods);
        let (time, x) = (&found.outcome.trajectory.time, &found.outcome.trajectory.states[0]);
        let states = time.iter().zip(x);
        let worst =
            states.fold(0.0f64, |worst, (t, x)| worst.max((x - integral_of_kink(*t)).abs()));
        assert!(worst <= tolerance, "{worst} for {tolerance}");
        let length = |pair: &[f64]| pair[1] - pair[0];
        let shortest =
            time.windows(2).min_by(|a, b| length(a).total_cmp(&length(b))).expect("intervals");
        assert!((shortest[0] - 0.3).abs() < 0.03 && length(shortest) < 0.015, "{shortest:?}");
        assert!(time.windows(2).any(|pair| length(pair) > 0.099), "elsewhere nothing is divided");
        assert!(stages(&found) < 4, "{} stages", stages(&found));
    }
}

/// A car that brakes twice as well as it accelerates: `T = 30`, with a switch at two thirds of it,
/// inside an interval of the first grid. The errors of the steps know nothing of that.
#[test]
fn intervals_on_which_a_control_jumps_are_as_short_as_with_a_given_order() {
    let found = refined(
        of_file("tests/classics/bang_bang.fdc"),
        &[("scheme", "radau"), ("controls", "polynomial")],
    );
    let time = &found.outcome.trajectory.time;
    let last = time[time.len() - 1];
    assert!((last - 30.0).abs() < 1e-3, "{last}");
    let around = time.windows(2).find(|pair| pair[1] > 20.0).expect("a switch");
    assert!(around[1] - around[0] < 1.01 * last / 50.0, "{around:?}");
    assert!(time.len() < 21, "{} grid points", time.len());
}

/// Ten intervals are too few for some of these; that is no reason to give up.
#[test]
fn hard_problems_are_solved_as_with_a_given_order() {
    for name in ["mountain_car", "obstacle_avoidance", "hang_glider", "robot_arm"] {
        let path = format!("tests/classics/{name}.fdc");
        let methods = [("scheme", "radau"), ("controls", "polynomial"), ("tolerance", "1e-4")];
        let found = refined(of_file(&path), &methods);
        assert_eq!(found.outcome.solution.status, Status::Solved, "{name}");
        assert!(nodes(&found).is_some(), "{name}: {:?}", found.error);
    }
}

/// What is carried over to more stages is nearly the solution, multipliers included: they are
/// costates times the weights of the nodes.
#[test]
fn a_solve_with_another_stage_begins_near_its_solution() {
    for scheme in ["radau", "gauss"] {
        let mut model = meaning(REGULATOR);
        for (key, value) in [("scheme", scheme), ("tolerance", "1e-10")] {
            model.set_method(key, value).expect("a setting");
        }
        let problem = compile(&model).expect("it can be solved");
        let (mut stages, mut begun) = (Some(3), Vec::new());
        let watch = &mut |progress: &Progress, level: Level| {
            if level.stages != stages {
                stages = level.stages;
                begun.push((progress.primal_infeasibility, progress.dual_infeasibility));
            }
            ControlFlow::Continue(())
        };
        refine(&problem, watch);
        assert!(!begun.is_empty(), "{scheme}");
        for (primal, dual) in begun {
            assert!(primal < 1e-3 && dual < 0.05, "{scheme}: begins with {primal} and {dual}");
        }
    }
}

/// A fast transient without a control, `x' = -500 (x - cos t)`; see `refinement.rs`.
#[test]
fn a_stiff_layer_is_found_with_few_nodes() {
    let text =
        "time t in [0, 2] state x start 0 dynamics { x' = -500*(x - cos(t)) } minimize integral(x)";
    for tolerance in ["1e-3", "1e-6"] {
        let found = |scheme| {
            nodes(&refined(meaning(text), &[("scheme", scheme), ("tolerance", tolerance)]))
        };
        let fixed = ["radau2", "radau3", "radau4", "radau5"].into_iter().filter_map(found).min();
        let (own, fixed) = (found("radau").expect("it is met"), fixed.expect("one is met"));
        assert!(2 * own <= 3 * fixed, "{tolerance}: {own} nodes, {fixed} with a given order");
    }
}

fn of_file(path: &str) -> Model {
    meaning(&std::fs::read_to_string(repository().join(path)).expect(path))
}

/// Never more nodes than the common choice of order needs where controls are smooth.
#[test]
fn smooth_problems_need_no_more_nodes_than_with_a_given_order() {
    for name in ["hypersensitive", "van_der_pol", "brachistochrone", "two_link_arm", "rayleigh"] {
        let path = format!("tests/classics/{name}.fdc");
        for tolerance in ["1e-4", "1e-7"] {
            let found = |scheme| {
                let methods =
                    [("scheme", scheme), ("controls", "polynomial"), ("tolerance", tolerance)];
                nodes(&refined(of_file(&path), &methods))
            };
            let fixed =
                ["radau3", "radau5"].into_iter().filter_map(found).min().expect("one is met");
            let own = found("radau").expect("it is met");
            assert!(own <= fixed, "{name} {tolerance}: {own} nodes, {fixed} with a given order");
        }
    }
}

/// Friction, smoothed sharply: not more than half as many nodes again as with the best order,
/// whichever that is.
#[test]
fn problems_with_layers_need_about_as_many_nodes_as_with_the_best_order() {
    for (name, sigma) in
        [("block", "0.02"), ("turbo", "0.05"), ("stacked", "0.02"), ("stacked", "0.1")]
    {
        let path = format!("models/{name}.fdc");
        for tolerance in ["1e-3", "1e-6"] {
            let found = |scheme| {
                let methods = [("scheme", scheme), ("sigma", sigma), ("tolerance", tolerance)];
                nodes(&refined(of_file(&path), &methods))
            };
            let fixed =
                ["radau2", "radau3", "radau4", "radau5"].into_iter().filter_map(found).min();
            let (own, fixed) = (found("radau").expect("it is met"), fixed.expect("one is met"));
            assert!(
                2 * own <= 3 * fixed,
                "{name} {sigma} {tolerance}: {own} nodes, {fixed} at best"
            );
        }
    }
}
