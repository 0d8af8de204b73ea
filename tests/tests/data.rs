//! Sums over rows of measured data: what the trajectory is between grid points, and its
//! derivatives by all that the optimiser chooses.

use fdcc::DataFiles;
use fdcc_compiler::{ProblemCode, compile_by_parameters};
use fdcc_runtime::nlp::{Derivatives, Nlp, Status};
use fdcc_runtime::problem::Problem;
use fdcc_runtime::transcribe::TranscribedNlp;
use fdcc_tests::models::solve;
use fdcc_tests::{documents, repository};

/// The meaning of a model with one data file, `a.csv`.
fn meaning(text: &str, data: &str) -> fdcc_compiler::Model {
    let data = data.to_owned();
    let files = DataFiles::from(move |_| Ok(data.clone()));
    let checked = fdcc::check_with("a test", text.into(), Some(files));
    let model = checked.model.unwrap_or_else(|| panic!("{text}\n{:#?}", checked.diagnostics));
    model.meaning().clone()
}

fn problem(text: &str, data: &str) -> Problem {
    let model = meaning(text, data);
    ProblemCode::new(&model).and_then(|code| code.problem(&model)).expect("it can be solved")
}

/// Every scheme with a name, the error of its interpolant on a decay over `N` intervals, and `N`.
const SCHEMES: [(&str, f64, usize); 9] = [
    ("euler", 2e-2, 40),
    ("implicit_euler", 2e-2, 40),
    ("midpoint", 2e-4, 40),
    ("trapezoid", 2e-4, 40),
    ("rk4", 3e-8, 40),
    ("radau2", 1e-5, 20),
    ("radau3", 1e-7, 20),
    ("gauss2", 1e-6, 20),
    ("gauss4", 1e-9, 20),
];

/// `x' = -p x, x(0) = 1` with `p = 0.7`, between grid points.
fn decay() -> String {
    let rows = (0..23).map(|row| 0.031 + 0.083 * row as f64);
    let lines: String = rows.map(|t| format!("{t},{}\n", (-0.7 * t).exp())).collect();
    format!("t,x\n{lines}")
}

fn fit_of_decay(scheme: &str, intervals: usize) -> String {
    format!(
        "data obs = csv(\"a.csv\") columns t, x\nfree p in [0, 2] guess 0.2\ntime t in [0, 2]\n\
         state x start 1\ndynamics {{ x' = -p*x }}\nminimize sum(k in obs, (x(k.t) - k.x)^2)\n\
         method {{ grid N = {intervals} scheme {scheme} }}"
    )
}

/// The rate of a decay from exact measurements: what is between grid points is as exact as the
/// scheme.
#[test]
fn a_fit_of_exact_measurements_is_as_exact_as_the_scheme() {
    for (scheme, error, intervals) in SCHEMES {
        let problem = problem(&fit_of_decay(scheme, intervals), &decay());
        let found = solve(&problem);
        assert_eq!(found.solution.status, Status::Solved, "{scheme}");
        let rate = found.solution.v[found.solution.v.len() - 1];
        assert!((rate - 0.7).abs() < error, "{scheme}: {:e}", rate - 0.7);
        assert!((rate - 0.7).abs() > 1e-5 * error, "{scheme}: {:e}", rate - 0.7);
    }
}

/// What an objective may do with a sum, over states, a control, unknowns and an end of time that
/// is one, with several rows in an interval and rows on grid points.
const GOALS: [&str; 4] = [
    "sum(k in obs, (x(k.t) - k.x)^2*exp(0.1*y(k.t)))",
    "sum(k in obs, sin(x(k.t) - k.x)*p + u(k.t)*y(k.t)*k.x + p^2)",
    "sqrt(1 + sum(k in obs, (x(k.t) - k.x)^2 + p*u(k.t)^2)) + T",
    "2*sum(k in obs, cos(x(k.t)*y(k.t)*t(k.t))) + (sum(k in obs, x(k.t)))^2",
];

const ROWS: &str = "t,x\n0,1\n0.1,0.7\n0.11,0.8\n0.12,0.3\n0.25,0.2\n0.5,0.1\n0.61,-0.2\n1,0.05\n";

fn every_way(goal: &str, end: &str, method: &str) -> String {
    format!(
        "data obs = csv(\"a.csv\") columns t, x\nfree p in [0, 2] guess 0.3\n\
         free T in [1, 3] guess 1.2\nparam w = 1\ntime t in [0, {end}]\nstate x start 1\n\
         state y start p\ncontrol u in [-1, 1]\n\
         dynamics {{ x' = y*x - p*t\n y' = sin(x) + u - w }}\nend x <= T\nminimize {goal}\n\
         guess {{ x = 1 - 0.3*t^2\n y = 0.2*t + p\n u = 0.1 + 0.3*t }}\n\
         method {{ grid N = 4 {method} }}"
    )
}

fn all() -> impl Iterator<Item = (String, Problem)> {
    let shapes = ["controls = linear", "controls = polynomial", "steps = 2", ""];
    let methods = SCHEMES.into_iter().flat_map(move |(scheme, ..)| {
        shapes.into_iter().map(move |shape| format!("scheme {scheme} {shape}"))
    });
    let fits = |method: &String| {
        let has_shape = method.contains("controls");
        !has_shape || method.contains("gauss") || method.contains("radau")
    };
    let methods: Vec<String> = methods.filter(fits).collect();
    methods.into_iter().enumerate().flat_map(|(at, method)| {
        // Each method with two of the goals, and each end of time with every goal.
        let cases = [(at, "1"), (at + 1, "T")];
        cases.map(|(goal, end)| {
            let text = every_way(GOALS[goal % GOALS.len()], end, &method);
            let found = problem(&text, ROWS);
            (text, found)
        })
    })
}

/// A point near the guess with nothing special about it, and multipliers of all sizes.
fn point(nlp: &mut TranscribedNlp) -> (Vec<f64>, Vec<f64>) {
    let mut v = nlp.guess();
    v.iter_mut().enumerate().for_each(|(i, x)| *x += 0.05 * (1.7 * i as f64).sin());
    let rows = nlp.constraint_bounds().len();
    (v, (0..rows).map(|i| (2.3 * i as f64).cos()).collect())
}

/// The gradient of the Lagrangian.
fn slope(nlp: &mut TranscribedNlp, v: &[f64], multipliers: &[f64]) -> Vec<f64> {
    let mut out = Derivatives::new(nlp);
    nlp.derivatives(v, 1.3, multipliers, &mut out);
    let mut slope: Vec<f64> = out.gradient.iter().map(|it| 1.3 * it).collect();
    nlp.jacobian_structure().transposed_multiply_add(&out.jacobian, multipliers, &mut slope);
    slope
}

fn lagrangian(nlp: &mut TranscribedNlp, v: &[f64], multipliers: &[f64]) -> f64 {
    let mut rows = vec![0.0; multipliers.len()];
    let objective = nlp.values(v, &mut rows);
    1.3 * objective + rows.iter().zip(multipliers).map(|(row, it)| row * it).sum::<f64>()
}

#[test]
fn derivatives_are_those_of_the_values() {
    for (text, problem) in all() {
        let mut nlp = TranscribedNlp::new(&problem);
        let (v, multipliers) = point(&mut nlp);
        let own = slope(&mut nlp, &v, &multipliers);
        let mut out = Derivatives::new(&nlp);
        // What stood in the matrices before must not matter.
        out.hessian.fill(f64::NAN);
        out.jacobian.fill(f64::NAN);
        nlp.derivatives(&v, 1.3, &multipliers, &mut out);
        for at in 0..v.len() {
            let mut column = vec![0.0; v.len()];
            let unit: Vec<f64> = (0..v.len()).map(|i| f64::from(i == at)).collect();
            nlp.hessian_structure().symmetric_multiply_add(&out.hessian, &unit, &mut column);
            let moved = |way: f64| -> Vec<f64> {
                let mut v = v.clone();
                v[at] += way;
                v
            };
            let h = 1e-5;
            let [left, right] = [moved(-h), moved(h)];
            let difference = (lagrangian(&mut nlp, &right, &multipliers)
                - lagrangian(&mut nlp, &left, &multipliers))
                / (2.0 * h);
            let size = 1.0 + own[at].abs();
            assert!(
                (difference - own[at]).abs() < 1e-7 * size,
                "{text}\nvariable {at}: {difference} and {}",
                own[at]
            );
            let [left, right] = [left, right].map(|v| slope(&mut nlp, &v, &multipliers));
            for (row, own) in column.iter().enumerate() {
                let difference = (right[row] - left[row]) / (2.0 * h);
                assert!(
                    (difference - own).abs() < 1e-6 * (1.0 + own.abs()),
                    "{text}\nvariables {row}, {at}: {difference} and {own}"
                );
            }
        }
    }
}

/// A sum without anything of the trajectory is a number; of columns alone it is known at once.
#[test]
fn a_sum_without_a_state_is_a_sum_of_numbers() {
    let text = "data obs = csv(\"a.csv\") columns t, x\nfree p in [0, 2] guess 0.3\n\
                time t in [0, 1]\nstate x start 0\ndynamics { x' = p }\n\
                minimize sum(k in obs, (x(end)*k.t - k.x)^2)";
    let found = solve(&problem(text, "t,x\n1,1\n2,1.5\n3,3.5\n"));
    // Least squares through the origin: the sum of t x over that of t^2.
    let rate = found.solution.v[found.solution.v.len() - 1];
    assert!((rate - 14.5 / 14.0).abs() < 1e-8, "{rate}");
}

/// Where the last time is an unknown, all rows are within it.
#[test]
fn a_free_last_time_is_not_before_the_last_row() {
    let text = "data obs = csv(\"a.csv\") columns t, x\nfree T in [0.1, 5] guess 0.5\n\
                time t in [0, T]\nstate x start 0\ndynamics { x' = 1 }\n\
                minimize T + sum(k in obs, (x(k.t) - k.x)^2)\nmethod { grid N = 7 scheme radau2 }";
    let found = solve(&problem(text, "t,x\n0.5,1\n2,1.5\n"));
    assert_eq!(found.solution.status, Status::Solved);
    let last = found.solution.v[found.solution.v.len() - 1];
    assert!((last - 2.0).abs() < 1e-6, "{last}");
    assert!((found.solution.objective - 2.5).abs() < 1e-6, "{}", found.solution.objective);
}

/// The derivative of the optimum by a parameter in the weights and in the times of rows, against
/// solves with other values.
#[test]
fn the_optimum_depends_on_parameters_of_the_rows() {
    let text = "data obs = csv(\"a.csv\") columns t, x\nparam lag = 0.05\nparam w = 2\n\
                free p in [0, 2] guess 0.2\ntime t in [0, 2]\nstate x start 1\n\
                dynamics { x' = -p*x }\nminimize sum(k in obs, w*(x(k.t + lag) - k.x)^2) + p\n\
                method { grid N = 10 scheme radau3 }";
    let optimum = |parameter: &str, value: f64| {
        let mut model = meaning(text, &decay());
        model.set_param(parameter, &format!("{value:.12}")).expect("it is a parameter");
        let problem = fdcc_compiler::compile(&model).expect("it can be solved");
        (solve(&problem), problem, model)
    };
    let (found, problem, model) = optimum("w", 2.0);
    let by = compile_by_parameters(&model).expect("it can be solved");
    let p = TranscribedNlp::new(&problem).parameters_at(&found.solution.v);
    let own = fdcc_runtime::solution::by_parameters(&problem, &found.solution, &p, &by);
    for (name, value, own) in [("lag", 0.05, own[0]), ("w", 2.0, own[1])] {
        let [left, right] =
            [-1e-3, 1e-3].map(|way| optimum(name, value + way).0.solution.objective);
        let difference = (right - left) / 2e-3;
        assert!((difference - own).abs() < 1e-4 * (1.0 + own.abs()), "{name}: {difference} {own}");
    }
}

/// Fits that wait for what a chain of phases is expected to be.
const WAITING: [&str; 2] = ["bounces", "two_runs"];

/// Published fits, and those that a script of `tests/peers/` makes and solves elsewhere, have the
/// answers that stand in their `expect` blocks.
#[test]
fn fits_of_the_literature_have_their_published_answers() {
    let mut failed = Vec::new();
    for (name, _) in documents("tests/classics/fits", "fdc") {
        let path = repository().join("tests/classics/fits").join(&name).with_extension("fdc");
        let path = path.display().to_string();
        if WAITING.contains(&name.as_str()) {
            continue;
        }
        let model = fdcc::Model::from_file(&path).expect("it has no mistake");
        let solution = model.solve(&fdcc::Options::default()).expect("it can be solved");
        let found = solution.expectations();
        assert!(!found.is_empty(), "{name} expects nothing");
        let holds = |it: &fdcc::Expectation| match &it.outcome {
            fdcc::Expected::Compared(sides) => sides.holds,
            _ => false,
        };
        let unmet = found.iter().filter(|it| !holds(it)).map(|it| it.origin.label.clone());
        failed.extend(unmet.map(|label| format!("{name}: {label}")));
        failed
            .extend((!solution.is_solved()).then(|| format!("{name}: {}", solution.status_name())));
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
