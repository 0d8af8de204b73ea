//! What the optimum is worth to a parameter, and the Hamiltonian: against closed forms and against
//! differences of solutions.

use fdcc_compiler::compile_by_parameters;
use fdcc_runtime::solution::{Trajectory, by_parameters};
use fdcc_runtime::transcribe::TranscribedNlp;
use fdcc_tests::models::changed;
use fdcc_tests::{Solved, repository};

/// The derivatives of the optimal objective by the parameters, in the order of the text.
fn sensitivities(text: &str, methods: &[(&str, &str)]) -> Vec<f64> {
    let model = changed(text, &[], methods);
    let by = compile_by_parameters(&model).expect("it can be solved");
    let solved = Solved::new(text, &[], methods);
    let (solution, p) = (&solved.outcome.solution, &solved.outcome.trajectory.parameters);
    by_parameters(&solved.problem, solution, p, &by)
}

/// A model whose parameters have these derivatives, to a relative tolerance.
struct Case {
    name: &'static str,
    text: &'static str,
    exact: Vec<f64>,
    tolerance: f64,
}

fn check(case: Case) {
    let found = sensitivities(case.text, &[]);
    assert_eq!(found.len(), case.exact.len(), "{}", case.name);
    for (found, exact) in found.iter().zip(&case.exact) {
        let error = (found - exact).abs() / exact.abs().max(1.0);
        assert!(error < case.tolerance, "{}: {found} for {exact}", case.name);
    }
}

/// `J = a^2 sqrt(q) tanh(sqrt(q) T)`: a start, a weight and the last time; a parameter that nothing
/// depends on.
#[test]
fn a_start_a_weight_and_a_duration() {
    let (a, q, end) = (1.5f64, 2.0f64, 1.2f64);
    let (root, t) = (q.sqrt(), (q.sqrt() * end).tanh());
    check(Case {
        name: "regulator",
        text: "param a = 1.5 param q = 2 param end_time = 1.2 param idle = 3 time t in [0, \
               end_time] state x start a control u \
               dynamics { x' = u } minimize integral(q*x^2 + u^2) + 0*idle \
               method { grid N = 12 scheme gauss3 controls = polynomial tol = 1e-12 }",
        exact: vec![
            2.0 * a * root * t,
            a * a * (t / (2.0 * root) + 0.5 * end * (1.0 - t * t)),
            a * a * q * (1.0 - t * t),
            0.0,
        ],
        tolerance: 1e-8,
    });
}

/// From rest to rest over `d` in the least time, `T = 2 sqrt(d m/U)`: a condition at the end, a
/// bound of the control, a right side; and parameters that follow from others, `U = 2 power`, `m =
/// U/4`.
#[test]
fn a_condition_a_bound_and_what_follows_from_a_parameter() {
    let (d, limit, m) = (3.0f64, 4.0f64, 1.0f64);
    let time = 2.0 * (d * m / limit).sqrt();
    let by_m = 0.5 * time / m;
    let by_limit = -0.5 * time / limit + by_m / 4.0;
    check(Case {
        name: "least time",
        text: "param power = 2 param limit = 2*power param m = limit/4 param d = 3 free T in [0.1, \
               10] guess 2 time t in [0, T] \
               state x start 0 state v start 0 control u in [-limit, limit] dynamics { x' = v m*v' \
               = u } \
               end x == d end v == 0 minimize T method { grid N = 20 scheme trapezoid tol = 1e-11 \
               }",
        exact: vec![2.0 * by_limit, by_limit, by_m, 0.5 * time / d],
        tolerance: 1e-6,
    });
}

/// Bryson & Ho 1975, section 3.11: `J = 4/(9 l)` for `x <= l`, as a bound of the state and as a
/// path constraint.
#[test]
fn a_bound_of_a_state_and_a_path_constraint() {
    for bound in ["state x in [-1, l] start 0", "state x start 0 path top: x <= l"] {
        let text = format!(
            "param l = 0.125 time t in [0, 1] {bound} state v start 1 control u dynamics {{ x' = v \
             v' = u }} \
             end x == 0 end v == -1 minimize integral(u^2)/2 method {{ grid N = 96 scheme gauss2 \
             controls = polynomial }}"
        );
        let found = sensitivities(&text, &[])[0];
        let exact = -4.0 / (9.0 * 0.125f64.powi(2));
        assert!((found / exact - 1.0).abs() < 2e-3, "{bound}: {found} for {exact}");
    }
}

/// `maximize` turns the sign: the largest `x(end)` is `k U T`.
#[test]
fn of_a_maximum() {
    check(Case {
        name: "maximum",
        text: "param k = 2 param limit = 3 param end_time = 4 time t in [0, end_time] state x \
               start 0 \
               control u in [-limit, limit] dynamics { x' = k*u } maximize x(end) method { N = 10 \
               tol = 1e-11 }",
        exact: vec![12.0, 8.0, 6.0],
        tolerance: 1e-7,
    });
}

/// A pendulum with a limited torque, in every scheme: half the difference of the optima for a
/// parameter a little larger and a little smaller.
#[test]
fn the_difference_of_two_optima_is_the_same() {
    let pendulum = "param k = 2 param c = 0.1 param limit = 1.2 param goal = 0.5 param fastest = \
                    0.3 time t in [0, 4] \
                    state x start 0 state v start fastest/5 control u in [-limit, limit] \
                    dynamics { x' = v v' = -k*sin(x) - c*v + u } path slow: v <= fastest end x == \
                    goal end v == 0 \
                    minimize integral(u^2*(1 + c*x)) + x(end)*v(end)";
    for scheme in ["euler", "implicit_euler", "midpoint", "trapezoid", "rk4", "radau2", "gauss2"] {
        let methods = [("N", "40"), ("scheme", scheme), ("tol", "1e-11")];
        let (found, h) = (sensitivities(pendulum, &methods), 1e-4);
        for (at, name, value) in
            [(0, "k", 2.0), (1, "c", 0.1), (2, "limit", 1.2), (3, "goal", 0.5), (4, "fastest", 0.3)]
        {
            let optimum = |value: f64| {
                Solved::new(pendulum, &[(name, &value.to_string())], &methods).objective()
            };
            let difference = (optimum(value + h) - optimum(value - h)) / (2.0 * h);
            let error = (found[at] - difference).abs() / difference.abs().max(1.0);
            assert!(error < 1e-4, "{scheme}, {name}: {} and {difference}", found[at]);
        }
    }
}

/// `H = x(T)^2 = 1/cosh(T)^2` for the regulator, which is also `dJ/dT`; -1 for a least time; 0
/// where the time is paid for by an integral; and not constant where the time itself matters.
#[test]
fn the_hamiltonian_is_what_it_has_to_be() {
    let least = "free T in [0.1, 10] guess 2 time t in [0, T] state x start 0 state v start 0 \
                 control u in [-1, 1] \
                 dynamics { x' = v v' = u } end x == 1 end v == 0";
    let regulator = "time t in [0, 2] state x start 1 control u dynamics { x' = u } minimize \
                     integral(x^2 + u^2)";
    let high = "method { grid N = 20 scheme radau4 controls = polynomial tol = 1e-11 }";
    let cases = [
        (format!("{regulator} {high}"), None, 2f64.cosh().powi(-2), 1e-8),
        (
            format!("{least} minimize T method {{ N = 20 scheme trapezoid }}"),
            Some(-1.0),
            -1.0,
            1e-6,
        ),
        (
            format!("{least} minimize integral(1) method {{ N = 20 scheme trapezoid }}"),
            Some(0.0),
            0.0,
            1e-6,
        ),
        (format!("{least} maximize -3*T method {{ N = 400 scheme euler }}"), Some(3.0), 3.0, 0.1),
    ];
    for (text, expected, exact, tolerance) in cases {
        let hamiltonian = Solved::new(&text, &[], &[]).outcome.trajectory.hamiltonian;
        assert!(hamiltonian.is_constant, "{text}");
        match (hamiltonian.expected, expected) {
            (Some(found), Some(expected)) => {
                assert!((found - expected).abs() < 1e-6, "{text}: {found}")
            }
            (found, expected) => assert_eq!(found, expected, "{text}"),
        }
        for (k, value) in hamiltonian.values.iter().enumerate() {
            assert!(
                (value - exact).abs() < tolerance,
                "{text}, interval {k}: {value}, not {exact}"
            );
        }
    }
    let text = "time t in [0, 2] state x start 1 control u dynamics { x' = u + t } minimize \
                integral(x^2 + u^2)";
    let hamiltonian = Solved::new(text, &[], &[]).outcome.trajectory.hamiltonian;
    assert!(!hamiltonian.is_constant && hamiltonian.deviation().is_none());
}

/// From rest to rest over 1 m in the least time 2, `p_v = t - 1`: full thrust is right where that
/// is negative, full brake where it is positive, and nothing else anywhere. Where the controls of a
/// quarter of the time are turned round or zero, a quarter of the time violates the rule.
#[test]
fn controls_minimise_the_hamiltonian_where_their_signs_agree() {
    let least = "free T in [0.1, 10] guess 2 time t in [0, T] state x start 0 state v start 0 \
                 control u in [-1, 1] \
                 dynamics { x' = v v' = u } end x == 1 end v == 0";
    for (objective, scheme) in
        [("minimize T", "trapezoid"), ("maximize -3*T", "radau2"), ("minimize 1e6*T", "midpoint")]
    {
        let text = format!("{least} {objective} method {{ N = 40 scheme {scheme} }}");
        let Solved { problem, outcome } = Solved::new(&text, &[], &[]);
        assert_eq!(outcome.trajectory.hamiltonian.violations, [0.0], "{text}");
        for factor in [-1.0, 0.0] {
            let (mut nlp, mut solution) = (TranscribedNlp::new(&problem), outcome.solution.clone());
            let controls: Vec<usize> = (0..10).map(|k| nlp.chain().control(k).start).collect();
            controls.into_iter().for_each(|at| solution.v[at] *= factor);
            let found = Trajectory::new(&problem, &mut nlp, &solution).hamiltonian;
            let violations = found.violations;
            assert!((violations[0] - 0.25).abs() < 1e-12, "{text}: {violations:?}");
        }
    }
}

/// Everything happens within 0.07 ms, and the model is in seconds: the tolerance is relative to
/// that, and a smaller one gains nothing.
#[test]
fn a_tolerance_is_relative_to_a_small_objective() {
    let path = repository().join("tests/right/resonant_tank.fdc");
    let text = std::fs::read_to_string(path).expect("the model is there");
    let [coarse, fine] = ["1e-8", "1e-10"].map(|tol| Solved::new(&text, &[], &[("tol", tol)]));
    for solved in [&coarse, &fine] {
        assert_eq!(solved.outcome.trajectory.hamiltonian.violations, [0.0]);
    }
    assert!((coarse.objective() / fine.objective() - 1.0).abs() < 1e-4);
}

/// A last time that stands elsewhere, too, says nothing about the Hamiltonian; nor does one at its
/// bound.
#[test]
fn a_last_time_that_does_more_says_nothing() {
    let least = |duration: &str, force: &str| {
        format!(
            "free T in {duration} guess 2.5 time t in [0, T] state x start 0 state v start 0 \
             control u in [-1, 1] \
             dynamics {{ x' = v v' = {force} }} end x == 1 end v == 0 minimize T"
        )
    };
    for (duration, force, is_expected) in
        [("[0.1, 10]", "u", true), ("[0.1, 10]", "u + 0.01*T", false), ("[2.2, 10]", "u", false)]
    {
        let hamiltonian =
            Solved::new(&least(duration, force), &[], &[]).outcome.trajectory.hamiltonian;
        assert_eq!(
            hamiltonian.expected.is_some(),
            is_expected,
            "{duration} {force}: {hamiltonian:?}"
        );
    }
}

/// Each end condition is worth what a parameter in its place would be, and so is the bound of a
/// path constraint, added up over time.
#[test]
fn multipliers_are_derivatives_by_the_bounds() {
    let least = "free T in [0.1, 10] guess 2 time t in [0, T] state x start 0 state v start 0 \
                 control u in [-1, 1] \
                 dynamics { x' = v v' = u } end x == 4 end v == 0 minimize T method { N = 20 \
                 scheme trapezoid tol = 1e-10 }";
    // T = 2 sqrt(d), so dT/dd = 1/sqrt(d); a speed w at the end is reached after T = 2 sqrt(d +
    // w^2/2) - w.
    let found = Solved::new(least, &[], &[]).outcome.trajectory.end_multipliers;
    assert!((found[0] - 0.5).abs() < 1e-6 && (found[1] + 1.0).abs() < 1e-6, "{found:?}");
    let most = least.replace("minimize T", "maximize -T");
    let found = Solved::new(&most, &[], &[]).outcome.trajectory.end_multipliers;
    assert!((found[0] + 0.5).abs() < 1e-6 && (found[1] - 1.0).abs() < 1e-6, "{found:?}");
    let bounded = "time t in [0, 1] state x start 0 state v start 1 control u dynamics { x' = v v' \
                   = u } path top: x <= 0.125 \
                   end x == 0 end v == -1 minimize integral(u^2)/2 method { grid N = 96 scheme \
                   gauss2 controls = polynomial }";
    let trajectory = Solved::new(bounded, &[], &[]).outcome.trajectory;
    let lengths = trajectory.time.windows(2).map(|pair| pair[1] - pair[0]);
    let sum: f64 =
        trajectory.path_multipliers[0].iter().zip(lengths).map(|(value, h)| value * h).sum();
    let exact = -4.0 / (9.0 * 0.125f64.powi(2));
    assert!((sum / exact - 1.0).abs() < 2e-3, "{sum} for {exact}");
    assert!(
        trajectory.path_multipliers[0].iter().all(|value| *value <= 1e-6),
        "relaxing a bound never costs"
    );
}
