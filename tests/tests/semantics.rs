//! What a model means: the cases are documents in `semantics/`, the table of messages, and models
//! whose functions are evaluated against formulas written out here.

use fdcc_compiler::graph::evaluate;
use fdcc_compiler::lower::VectorFunction;
use fdcc_compiler::lower::lower;
use fdcc_compiler::{
    LoweredProblem, Model, analyze, check, compile, compile_simulation, expectations,
};
use fdcc_grammar::{Code, Diagnostic, Severity, SourceFile, parse};
use fdcc_runtime::problem::{Bounds, Columns, Degree};
use fdcc_tests::{blocks, documents, repository, unclaimed};
use std::f64::consts::PI;

#[test]
fn documents_claim_every_diagnostic() {
    let mut failed = Vec::new();
    for (name, document) in documents("tests/tests/semantics", "md") {
        for block in blocks(&document).iter().filter(|block| block.tag == "fdc") {
            let problems = unclaimed(&block.text, &diagnostics(&block.text)).join("\n");
            failed.extend(
                (!problems.is_empty())
                    .then(|| format!("{name}.md:{} {}\n{problems}", block.line, block.heading)),
            );
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n\n"));
}

#[test]
fn models_give_neither_errors_nor_warnings() {
    let folders = [
        "models",
        "tests/right",
        "tests/classics",
        "tests/classics/phases",
        "tests/classics/switched_phases",
        "tests/classics/fits",
        "tests/classics/at_times",
    ];
    for (name, text) in folders.iter().flat_map(|folder| documents(folder, "fdc")) {
        let mut found = analyze(&text).diagnostics;
        found.retain(|it| it.severity > Severity::Advice);
        assert!(found.is_empty(), "{name}: {found:#?}");
    }
}

/// The cases of the groups 01 to 05 and 07 in the table of messages. They are fragments, so other
/// findings may stand beside the one that is meant; some are completed, because nothing follows
/// from unknown names.
#[test]
fn messages_are_those_of_the_table() {
    let path = repository().join("tests/reference/diagnostics.json");
    let table = std::fs::read_to_string(path).expect("the table is there");
    let cases: serde_json::Value = serde_json::from_str(&table).expect("the table is JSON");
    let is_ours = |code: &str| {
        ["FDC01", "FDC02", "FDC03", "FDC04", "FDC05", "FDC07"]
            .iter()
            .any(|group| code.starts_with(group))
    };
    let mut count = 0;
    for case in cases
        .as_array()
        .expect("the table is a list")
        .iter()
        .filter(|case| is_ours(words(case, "code")))
    {
        let code = words(case, "code");
        let source = &[words(case, "src"), &rest(code)].concat();
        let found = diagnostics(source);
        assert!(found.iter().any(|it| matches(it, case, source)), "{code}: {found:#?}");
        count += 1;
    }
    assert!(count >= 23);
}

/// What stands below the lines that a case shows.
fn rest(code: &str) -> String {
    let document = std::fs::read_to_string(repository().join("tests/tests/completions.md"));
    let blocks = blocks(&document.expect("the document is there"));
    blocks.into_iter().find(|block| block.heading == code).map_or(String::new(), |block| block.text)
}

/// What the table says of features that there are not is left out; where its lines break, is a
/// matter of the drawing.
fn help(case: &serde_json::Value) -> String {
    let text = words(case, "help")
        .replace("Use `scheme located` (switch times are\nunknowns), or check", "Check");
    text.replace('\n', " ")
}

fn matches(found: &Diagnostic, case: &serde_json::Value, source: &str) -> bool {
    let labels = case["labels"].as_array().expect("a case has labels");
    found.code.as_str() == words(case, "code")
        && found.message == words(case, "msg")
        && format!("{:?}", found.severity).to_lowercase() == words(case, "sev")
        && found.help.as_ref().map(|it| it.replace('\n', " ")) == Some(help(case))
        && found.labels.len() == labels.len()
        && found.labels.iter().zip(labels).all(|(label, expected)| {
            let at = place(source, expected[0].as_str().expect("a label has a place"));
            (label.span.start as usize, label.text.as_str())
                == (at.0, expected[1].as_str().expect("a label has a text"))
                && label.span.end as usize == at.1
        })
}

/// `=#2` is the second `=` of the text; names are found as whole words.
fn place(source: &str, wanted: &str) -> (usize, usize) {
    let (text, number) = match wanted.rsplit_once('#') {
        Some((text, number)) => (text, number.parse().expect("a number follows #")),
        None => (wanted, 1),
    };
    let is_word = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    let whole = |at: &usize| {
        let (before, after) =
            (source[..*at].chars().next_back(), source[at + text.len()..].chars().next());
        let (first, last) = (text.chars().next(), text.chars().next_back());
        !(is_word(before) && is_word(first) || is_word(after) && is_word(last))
    };
    let found = source.match_indices(text).map(|(at, _)| at).filter(whole).nth(number - 1);
    let at = found.unwrap_or_else(|| panic!("`{wanted}` is in {source}"));
    (at, at + text.len())
}

fn words<'v>(value: &'v serde_json::Value, key: &str) -> &'v str {
    value[key].as_str().expect("the table has text here")
}

fn diagnostics(text: &str) -> Vec<Diagnostic> {
    let parsed = parse(text);
    assert!(parsed.diagnostics.is_empty(), "{text}\n{:#?}", parsed.diagnostics);
    check(&parsed.tree).diagnostics
}

fn model(text: &str) -> Model {
    let parsed = parse(text);
    assert!(parsed.diagnostics.is_empty(), "{:#?}", parsed.diagnostics);
    let checked = check(&parsed.tree);
    checked.model.unwrap_or_else(|| panic!("{:#?}", checked.diagnostics))
}

fn repository_model(name: &str) -> Model {
    let (_, text) =
        documents("models", "fdc").into_iter().find(|it| it.0 == name).expect("the model is there");
    model(&text)
}

fn values(program: &LoweredProblem, function: &VectorFunction, inputs: &[f64]) -> Vec<f64> {
    assert_eq!(inputs.len(), function.layout.inputs(), "inputs of {}", function.name);
    evaluate(&program.graph, &function.outputs, inputs, &[])
}

fn assert_close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (found_one, expected_one) in found.iter().zip(expected) {
        let error = (found_one - expected_one).abs();
        assert!(error <= 1e-14 * (1.0 + expected_one.abs()), "{found:?}\n{expected:?}");
    }
}

/// Equations (7.1) to (7.9) of Stewart & Anitescu, written out.
#[test]
fn the_race_car_has_the_equations_of_section_7() {
    let program = lower(&repository_model("racecar"));
    let ([px, py, vx, vy, th], [a, s]): ([f64; 5], [f64; 2]) =
        ([1.3, 0.9, 0.7, -0.4, 0.6], [1.1, -0.8]);
    let p = [10.0, 2.0, 2.0, 1.0, 0.5, 5.5, 0.1]; // alpha a_max s_max muN w T sigma
    let (tau, horizon, sigma) = (0.25, p[5], p[6]);
    let z = [&[tau, px, py, vx, vy, th, a, s], &p[..]].concat();
    let slip = -th.sin() * vx + th.cos() * vy;
    let step = slip / (slip * slip + sigma * sigma).sqrt();
    let turn = s * (th.cos() * vx + th.sin() * vy);
    let rates = [vx, vy, a * th.cos() + step * th.sin(), a * th.sin() - step * th.cos(), turn];
    assert_close(&values(&program, &program.dynamics, &z), &rates.map(|rate| horizon * rate));
    assert_close(&values(&program, &program.path, &z), &[py - px.sin()]);
    assert_close(&values(&program, &program.switching, &z), &[slip]);
    assert_close(&values(&program, &program.report, &z), &[slip, th.cos() * vx + th.sin() * vy]);
    let far = [&[tau, 4.0, py, vx, vy, th, a, s], &p[..]].concat();
    assert_close(&values(&program, &program.path, &far), &[py - (PI - 4.0)]);
    let ends = [&[0.0; 5][..], &[9.0, -3.0, 0.1, 0.2, 0.3], &p].concat();
    let miss = (9.0 - 3.0 * PI).powi(2) + (-3.0 + PI).powi(2);
    assert_close(&values(&program, &program.boundary, &ends), &[10.0 * miss + horizon]);
    assert_close(&values(&program, &program.interval, &p), &[0.0, horizon]);
}

/// pos = (3 pi r^2, y_cl(3 pi r^2)) with r = t/T, so pos' = (6 pi r, y_cl'(x) 6 pi r)/T.
#[test]
fn a_guess_may_use_derivatives_of_guesses_above_it() {
    let program = lower(&repository_model("racecar"));
    let (tau, horizon) = (0.5_f64, 5.5);
    let guess = values(&program, &program.guess, &[tau, 10.0, 2.0, 2.0, 1.0, 0.5, horizon, 0.1]);
    let x = 3.0 * PI * tau * tau;
    let (speed, slope) = (6.0 * PI * tau / horizon, x.cos());
    let (vx, vy) = (speed, slope * speed);
    assert_close(&guess, &[x, x.sin(), vx, vy, vy.atan2(vx), 0.0, 0.0]);
}

#[test]
fn selectors_are_inputs_of_the_flow() {
    let program = lower(&repository_model("turbo"));
    let flow = |s: f64| values(&program, &program.flow, &[0.0, 3.0, 12.0, 2.0, 10.0, 15.0, 0.1, s]);
    assert_close(&flow(-1.0), &[12.0, 2.0]);
    assert_close(&flow(1.0), &[12.0, 6.0]);
    assert_close(&flow(0.0), &[12.0, 4.0]);
}

const OSCILLATOR: &str = "
model oscillator
param k = 4
free T in [1, 10] guess 2
time t in [1, 1 + T]
state x in [-5, 5] start 1
state v start free in [-1, 1]
control u in [-1, 2]
dynamics {
  x' = v
  2 * v' = -k*x + u + t
}
";

#[test]
fn time_is_normalised_and_the_factor_of_a_derivative_divides() {
    let program = lower(&model(&format!("{OSCILLATOR}end x == 0\nminimize T")));
    // [tau x v u k T]: t = 1 + 0.5 * 3
    let rates = values(&program, &program.dynamics, &[0.5, 0.2, 0.3, 0.7, 4.0, 3.0]);
    assert_close(&rates, &[3.0 * 0.3, 3.0 * (-4.0 * 0.2 + 0.7 + 2.5) / 2.0]);
}

#[test]
fn an_integral_with_a_constant_factor_is_running_cost() {
    let model = model(&format!("{OSCILLATOR}maximize k*integral(u^2) + x(end)"));
    let program = lower(&model);
    assert!(program.running_cost && program.hidden.is_empty());
    let rates = values(&program, &program.dynamics, &[0.0, 0.2, 0.3, 0.7, 4.0, 3.0]);
    assert_close(&rates[2..], &[-3.0 * 4.0 * 0.49]);
    let ends = values(&program, &program.boundary, &[1.0, 0.1, 0.5, 0.6, 4.0, 3.0]);
    assert_close(&ends, &[-0.5, 0.1]);
    assert_eq!(compile(&model).expect("it can be solved").sense, -1.0);
}

#[test]
fn an_integral_that_enters_otherwise_becomes_a_hidden_state() {
    let model = model(&format!("{OSCILLATOR}end integral(u^2) <= 3\nminimize integral(x)^2"));
    let problem = compile(&model).expect("it can be solved");
    let names: Vec<&str> = problem.states.iter().map(|state| state.name.as_str()).collect();
    assert_eq!(names, ["x", "v", "integral(u^2)", "integral(x)"]);
    assert_eq!(problem.start, [Some(1.0), None, Some(0.0), Some(0.0)]);
    assert!(problem.states[2].hidden && !problem.states[1].hidden);
    let program = lower(&model);
    let ends =
        values(&program, &program.boundary, &[1.0, 0.1, 0.0, 0.0, 0.5, 0.6, 2.5, 3.0, 4.0, 3.0]);
    assert_close(&ends, &[9.0, 2.5, 0.1]);
    assert_eq!(problem.boundary_bounds[0], Bounds { lower: f64::NEG_INFINITY, upper: 3.0 });
    assert_eq!(problem.boundary_bounds[1], Bounds { lower: -1.0, upper: 1.0 });
}

#[test]
fn conditions_become_rows_with_bounds() {
    let text = "
param c = 3
free r in [0, 1]
time t in [0, 2]
state q(x, y) start (0, 0)
control u(x, y) in [-1, 1]
dynamics { q' = u }
path -1 <= q.x <= c
path box: abs(q) <= 2*c
path upper: q.x >= q.y + r
path tube: abs(q.x) <= r
end q == (1, r)
minimize r";
    let problem = compile(&model(text)).expect("it can be solved");
    let row = |lower, upper| Bounds { lower, upper };
    let infinite = f64::INFINITY;
    let expected = [
        row(-1.0, 3.0),
        row(-6.0, 6.0),
        row(-6.0, 6.0),
        row(-infinite, 0.0),
        row(-infinite, 0.0),
        row(0.0, infinite),
    ];
    assert_eq!(problem.path_bounds, expected);
    let labels: Vec<String> = (0..6).map(|at| problem.path.origin(at).label.to_string()).collect();
    assert_eq!(labels, ["-1 <= q.x <= c", "box.x", "box.y", "upper", "tube", "tube"]);
    assert!((0..6).all(|at| problem.path.degree(at) == Degree::Affine), "no row has a kink");
    assert_eq!(problem.boundary_bounds, [Bounds::fixed(0.0), Bounds::fixed(0.0)]);
}

#[test]
fn a_start_may_depend_on_unknowns_and_parameters() {
    let text = "
param m = 2
free x0 in [-1, 1]
time t in [0, 1]
state x start x0
state y start 3*m
dynamics {
  x' = 1
  y' = x
}
minimize x(end)^2";
    let problem = compile(&model(text)).expect("it can be solved");
    assert_eq!(problem.start, [None, Some(6.0)]);
    assert_eq!(problem.boundary_bounds, [Bounds::fixed(0.0)]);
    assert_eq!(&*problem.boundary.origin(1).label, "start x");
    let mut model = model(text);
    model.set_param("m", "500[g]").expect("m is a parameter");
    assert_eq!(compile(&model).expect("it can be solved").start[1], Some(1.5));
}

/// Without a guess a state runs straight from start to end, and a control stays in the middle.
#[test]
fn what_is_not_guessed_is_a_straight_line() {
    let text = "
free T in [2, 6]
free z
time t in [0, T]
state x start 1
state v start free in [2, 4]
state w
control u in [-1, 2]
dynamics {
  x' = v*z
  v' = u
  w' = v
}
end x == 3
end w == 5
minimize T";
    let model = model(text);
    let program = lower(&model);
    assert_close(&values(&program, &program.guess, &[0.25, 4.0, 1.0]), &[1.5, 3.0, 5.0, 0.5]);
    let problem = compile(&model).expect("it can be solved");
    assert_eq!(problem.parameters.iter().map(|it| it.value).collect::<Vec<_>>(), [4.0, 1.0]);
}

#[test]
fn units_are_converted_and_plain_numbers_take_the_unit_of_their_place() {
    let text = "
param m = 200 [g]
param pressure = 2 [bar]
time t in [0, 2] [min]
state v [km/h] in [-36, 72] start 18
state phi [deg] start 90
dynamics {
  v' = 3 [m/s^2] + 1 [m/kg/s^2] * m + pressure * 2 [m^2/kg]
  phi' = 30 [rpm]
}
end v <= 54
end phi == 3 [rad]
minimize v(end)";
    let problem = compile(&model(text)).expect("it can be solved");
    assert_close(&[problem.parameters[0].value, problem.parameters[1].value], &[0.2, 2e5]);
    assert_close(&[problem.states[0].bounds.lower, problem.states[0].bounds.upper], &[-10.0, 20.0]);
    let start: Vec<f64> = problem.start.iter().flatten().copied().collect();
    assert_close(&start, &[5.0, PI / 2.0]);
    assert_close(
        &[problem.boundary_bounds[0].upper, problem.boundary_bounds[1].upper],
        &[15.0, 3.0],
    );
    let program = lower(&model(text));
    assert_close(&values(&program, &program.interval, &[0.2, 2e5]), &[0.0, 120.0]);
    assert_close(
        &values(&program, &program.dynamics, &[0.0, 1.0, 1.0, 0.2, 2e5]),
        &[120.0 * 400_003.2, 120.0 * PI],
    );
}

#[test]
fn an_unnamed_surface_is_named_by_its_text_and_known_again() {
    let text = "
time t in [0, 1]
state x start 1
state y start 1
dynamics {
  x' in -Sgn(x - y)
  y' in -2*Sgn(x - y) + Sgn(y)
}
minimize x(end)";
    let problem = compile(&model(text)).expect("it can be solved");
    let names: Vec<&str> = problem.surfaces.iter().map(|surface| surface.name.as_str()).collect();
    assert_eq!(names, ["x - y", "y"]);
    assert_eq!(problem.parameters[1].name, "sigma(y)");
}

/// One width for the vector, one switching function, and the same vector known again; a component
/// by itself is another surface.
#[test]
fn a_direction_is_one_surface_named_by_the_text_of_its_vector() {
    let text = "
time t in [0, 1]
state v(x, y) start (1, 0)
state w start 1
dynamics {
  v' in -Dir(v - (w, 0)) - 2*Dir(v)
  w' in -Sgn(v.x) - Dir(v).y - Dir(w)
}
minimize w(end)";
    let problem = compile(&model(text)).expect("it can be solved");
    let names: Vec<&str> = problem.surfaces.iter().map(|surface| surface.name.as_str()).collect();
    assert_eq!(names, ["v - (w, 0)", "v", "v.x", "w"]);
    assert_eq!(problem.switching.outputs(), 4);
    let system = compile_simulation(&model(text)).expect("it can be simulated");
    let names: Vec<&str> = system.surfaces.iter().map(|surface| surface.name.as_str()).collect();
    assert_eq!(names, ["(v - (w, 0)).x", "(v - (w, 0)).y", "v.x", "v.y", "v.x", "w"]);
    assert_eq!(system.balls[1].surfaces, 2..4);
    assert_eq!((system.name_of(3), system.name_of(4)), ("v", "v.x"));
}

/// sqrt kernel: psi/sqrt(|psi|^2 + sigma^2); the switching function is |psi|.
#[test]
fn a_direction_is_smoothed_by_the_length_of_its_vector() {
    let text = "
time t in [0, 1]
state v(x, y) start (1, 0)
dynamics { v' in -Dir(v) }
minimize v.x(end)
method { smooth sigma = 0.5 kernel sqrt }";
    let program = lower(&model(text));
    let root = 0.5_f64.sqrt();
    assert_close(
        &values(&program, &program.dynamics, &[0.0, 0.3, -0.4, 0.5]),
        &[-0.3 / root, 0.4 / root],
    );
    assert_close(&values(&program, &program.switching, &[0.0, 0.3, -0.4, 0.5]), &[0.5]);
}

/// sqrt kernel: |z| becomes sqrt(z^2 + sigma^2), with the width of the surface.
#[test]
fn absolute_values_are_smoothed_like_sgn() {
    let text = "
time t in [0, 1]
state x start 1
control u in [-1, 1]
dynamics { x' in u - Sgn(x) }
minimize integral(abs(u))
method { smooth sigma = 0.5 kernel sqrt }";
    let program = lower(&model(text));
    let rates = values(&program, &program.dynamics, &[0.0, 0.3, 0.4, 0.5]);
    assert_close(&rates, &[0.4 - 0.3 / 0.34_f64.sqrt(), 0.41_f64.sqrt()]);
}

#[test]
fn functions_of_vectors() {
    let text = "
time t in [0, 1]
state a(x, y) start (1, 2)
state b(x, y, z) start (0, 0, 0)
fn twice(v) = 2*v
dynamics {
  a' = twice(a) / norm(a)
  b' = cross(b, (1, 2, 3)) - b
}
minimize dot(a(end), (3, 4)) + normsq(b(end)) + cross(a(start), a(end)) + b[2](start)";
    let program = lower(&model(text));
    let rates = values(&program, &program.dynamics, &[0.0, 3.0, 4.0, 0.5, 0.7, 0.9]);
    let cross = [0.7 * 3.0 - 0.9 * 2.0, 0.9 * 1.0 - 0.5 * 3.0, 0.5 * 2.0 - 0.7 * 1.0];
    assert_close(&rates, &[1.2, 1.6, cross[0] - 0.5, cross[1] - 0.7, cross[2] - 0.9]);
    let ends =
        values(&program, &program.boundary, &[1.0, 2.0, 0.1, 0.2, 0.3, 5.0, 6.0, 1.0, 2.0, 3.0]);
    assert_close(&ends, &[15.0 + 24.0 + 14.0 + (6.0 - 10.0) + 0.2]);
}

#[test]
fn expectations_are_values_over_the_ends_and_integrals() {
    let text = "
time t in [0, 2]
state x start 1
control u in [-1, 1]
dynamics { x' = u }
minimize x(end)
expect {
  integral(u^2) + x(end) == 3*x(start) within 1e-3
  sliding(s) == sensitivity(x(end), x(start))
}
surface s = x
path in_front: selected(Sgn(s)) <= 2";
    let expectations = expectations(&model(text));
    let simulated: Vec<&[usize]> =
        expectations.list.iter().map(|it| it.simulated.as_slice()).collect();
    assert_eq!(simulated, [&[][..], &[0, 1]]);
    let mut ends = Columns::new(2, 1);
    ends.column_mut(0)[0] = 1.0;
    ends.column_mut(1)[0] = 0.25;
    let mut found = Columns::new(6, 1);
    // p = [sigma(s), integral, sliding, sensitivity]
    expectations.function.value(&ends, &[1.0, 2.5, 0.5, 0.75], &mut found);
    assert_eq!([0, 1, 2].map(|i| found.column(i)[0]), [2.75, 3.0, 1e-3]);
    assert_eq!([3, 4].map(|i| found.column(i)[0]), [0.5, 0.75]);
}

#[test]
fn the_command_line_changes_parameters_and_method() {
    let mut car = repository_model("racecar");
    car.set_param("muN", "4").expect("muN is a parameter");
    for (key, value) in [
        ("sigma", "0.02"),
        ("kernel", "tanh"),
        ("N", "500"),
        ("scheme", "euler"),
        ("continue", "0.1, 0.05"),
    ] {
        car.set_method(key, value).unwrap_or_else(|error| panic!("{key}: {error}"));
    }
    let problem = compile(&car).expect("it can be solved");
    assert_eq!((problem.parameters[3].value, problem.parameters[6].value), (4.0, 0.02));
    assert_eq!(
        (problem.method.intervals(), problem.method.continuation.clone()),
        (500, vec![0.1, 0.05])
    );
    let refused = |result: Result<(), String>| result.expect_err("it must be refused");
    assert!(refused(car.set_param("mu", "4")).contains("there is no parameter `mu`"));
    assert!(refused(car.set_param("muM", "4")).contains("did you mean `muN`?"));
    assert!(refused(car.set_param("muN", "four")).contains("not a number"));
    assert!(refused(car.set_method("sigmo", "1")).contains("did you mean `sigma`?"));
    assert!(refused(car.set_method("kernel", "tanj")).contains("did you mean `tanh`?"));
    assert!(refused(car.set_method("scheme", "fesd")).contains("cannot be solved yet"));
    assert!(refused(car.set_method("scheme", "radau6")).contains("did you mean `radau1`?"));
    car.set_method("controls", "linear").expect("a shape of controls");
    assert!(refused(car.fits_together()).contains("more than one point of an interval"));
    car.set_method("scheme", "radau3").expect("a scheme");
    car.fits_together().expect("linear controls are seen at three points");
}

#[test]
fn a_parameter_may_wait_for_its_value() {
    let text = "param m\ntime t in [0, 1]\nstate x start m\ndynamics { x' = m }\nminimize x(end)";
    assert_eq!(diagnostics(text)[0].code, Code::NoValue);
    let mut model = model_in_waiting(text);
    assert_eq!(compile(&model).err().expect("it has no value yet")[0].code, Code::NoValue);
    model.set_param("m", "2").expect("m is a parameter");
    assert_eq!(compile(&model).expect("it can be solved").start, [Some(2.0)]);
}

fn model_in_waiting(text: &str) -> Model {
    check(&parse(text).tree).model.expect("only a value is missing")
}

#[test]
fn what_cannot_be_solved_yet_is_told_once() {
    let text = "time t in [0, 1] state x start 0 control u in [-1, 1] dynamics { x' = u } \
                minimize integral(u^2) method { scheme fesd }";
    let found = compile(&model_in_waiting(text)).err().expect("it cannot be solved yet");
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_eq!(found[0].code, Code::NotYet);
    assert!(found[0].message.contains("fesd"), "{}", found[0].message);
}

/// Definitions that hang on each other thousands deep, sums of thousands of terms, functions that
/// double.
#[test]
fn long_and_deep_models_are_understood() {
    let lets: String = (0..5000).map(|at| format!("let a{at} = a{} + 1\n", at + 1)).collect();
    let sum = vec!["x"; 5000].join(" + ");
    let doubling: String =
        (1..40).map(|at| format!("fn f{at}(x) = f{}(x) + f{}(x)\n", at - 1, at - 1)).collect();
    let rest = "time t in [0, 1]\nstate x start 0\n";
    let text = format!(
        "{lets}const a5000 = 1\nfn f0(x) = x\n{doubling}{rest}dynamics {{ x' = {sum} + f39(x) + a0 \
         }}\nminimize x(end)"
    );
    let program = lower(&model(&text));
    let rate = values(&program, &program.dynamics, &[0.0, 1.0])[0];
    assert_eq!(rate, 5000.0 + 2f64.powi(39) + 5001.0);
}

/// The stack is bounded: functions that call each other a thousand deep are refused, once.
#[test]
fn calls_that_are_too_deep_are_refused() {
    let chain: String = (1..1000).map(|at| format!("fn f{at}(x) = f{}(x) + 1\n", at - 1)).collect();
    let rest = "time t in [0, 1]\nstate x start 0\ndynamics { x' = f999(x) }\nminimize x(end)";
    let found = diagnostics(&format!("{chain}fn f0(x) = x\n{rest}"));
    assert_eq!(found.iter().map(|it| it.code).collect::<Vec<_>>(), [Code::TooDeep]);
}

#[test]
fn findings_are_in_the_order_of_the_text() {
    let text = "param a = b\nparam c = d\ntime t in [0, 1]\nstate x start 0\ndynamics { x' = e \
                }\nend f == 0";
    let found = diagnostics(text);
    let names: Vec<String> = found
        .iter()
        .filter(|it| it.code == Code::UnknownName)
        .map(|it| it.message.clone())
        .collect();
    assert_eq!(names, ["b", "d", "e", "f"].map(|name| format!("nothing called `{name}` here")));
    let source = SourceFile::new("model.fdc", text);
    let lines: Vec<usize> =
        found.iter().map(|it| source.line_column(it.span().start).line).collect();
    assert!(lines.is_sorted(), "{lines:?}");
}

/// `f1(z) = f0(f0(z))` and so on is 2^n applications: refused at once, not after a night.
#[test]
fn functions_that_multiply_are_refused_at_once() {
    let chain: String = (0..40).map(|i| format!("fn f{}(z) = f{i}(f{i}(z))\n", i + 1)).collect();
    let text = format!(
        "time t in [0, 1]\nstate x start 0\ndynamics {{ x' = 1 }}\nfn f0(z) = z + t\n{chain}report \
         {{ y = f40(x) }}\n"
    );
    let parsed = fdcc_grammar::parse(&text);
    let found = fdcc_compiler::check(&parsed.tree).diagnostics;
    let codes: Vec<_> = found.iter().map(|it| it.code).collect();
    assert_eq!(
        codes.iter().filter(|code| **code == fdcc_grammar::Code::TooDeep).count(),
        1,
        "{codes:?}"
    );
}

/// `b` begins two minutes before `a` ends.
#[test]
fn a_gap_between_phases_is_in_the_unit_of_time() {
    for (unit, told) in [("[min]", "a gap of -2 min"), ("[s]", "a gap of -2"), ("", "a gap of -2")]
    {
        let phase = |name: &str, state: &str| {
            let dynamics = "dynamics { x' = 1 }";
            format!("phase {name} {{ time t in [0, 2] {unit}  state x {state}  {dynamics} }}\n")
        };
        let [a, b] = [phase("a", "start 1"), phase("b", "")];
        let found = diagnostics(&format!("{a}{b}link a -> b {{ same }}\nminimize b.x(end)\n"));
        let gap = found.iter().find(|it| it.code == Code::TimeGap).expect("a gap");
        assert_eq!(gap.labels[0].text, told);
    }
}
