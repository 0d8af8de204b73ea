//! Derivatives of the true system are what the files of `tests/gradients/` say, to 1e-8, from a source that is not this
//! program; forward and adjoint agree to 1e-10.
//!
//! ```text
//! case WHAT, AND WHO SAYS SO
//! set NAME = VALUE                  a `param` or a `free`
//! of EXPRESSION                     the model's own objective if left out
//! by PARAM = VALUE                  or STATE(start)
//! second PARAM PARAM = VALUE        a second derivative
//! ```

use fdcc_compiler::compile_sensitivities;
use fdcc_runtime::sensitivity::{Quantity, Sensitivity, gradient, hessian};
use fdcc_runtime::simulate::{Controls, Options, System};
use fdcc_tests::documents;
use fdcc_tests::models::meaning;

const TOLERANCE: f64 = 1e-8;
const AGREEMENT: f64 = 1e-10;

/// One case of a file.
#[derive(Default)]
struct Case<'t> {
    title: &'t str,
    set: Vec<(&'t str, &'t str)>,
    of: Option<&'t str>,
    by: Vec<(&'t str, f64)>,
    second: Vec<([&'t str; 2], f64)>,
}

fn cases(text: &str) -> Vec<Case<'_>> {
    let mut cases: Vec<Case> = Vec::new();
    for line in text.lines().filter(|line| !line.is_empty()) {
        if let Some(title) = line.strip_prefix("case ") {
            cases.push(Case { title, ..Case::default() });
        } else {
            read(line, cases.last_mut().expect("a file begins with a case")).expect(line);
        }
    }
    cases
}

fn read<'t>(line: &'t str, case: &mut Case<'t>) -> Option<()> {
    let (word, rest) = line.split_once(' ')?;
    match (word, rest.split_once(" = ")) {
        ("of", None) => case.of = Some(rest),
        ("set", Some(change)) => case.set.push(change),
        ("by", Some((name, value))) => case.by.push((name, value.parse().ok()?)),
        ("second", Some((names, value))) => {
            let (a, b) = names.split_once(' ')?;
            case.second.push(([a, b], value.parse().ok()?));
        }
        _ => return None,
    }
    Some(())
}

fn quantity(system: &System, name: &str) -> Quantity {
    match name.strip_suffix("(start)") {
        Some(state) => {
            Quantity::Start(system.states.iter().position(|it| it.name == state).expect("a state"))
        }
        None => {
            Quantity::Parameter(system.parameters.iter().position(|it| it.name == name).expect("a parameter"))
        }
    }
}

fn text_of(name: &str) -> String {
    let own = documents("tests/simulations", "fdc");
    match own.into_iter().find(|(other, _)| other == name) {
        Some((_, text)) => text,
        None => fdcc_tests::models::text_of(name),
    }
}

fn differentiated(text: &str, case: &Case) -> (System, Sensitivity) {
    let text = match case.of {
        Some(output) => format!("{text}\nminimize {output}\n"),
        None => text.to_string(),
    };
    let text = without_earlier_objective(&text);
    let mut model = meaning(&text);
    for (name, value) in &case.set {
        if model.set_param(name, value).is_err() {
            model.set_free(name, value.parse().expect("a number"));
        }
    }
    let system = compile_sensitivities(&model).expect("the model can be simulated");
    let quantities: Vec<Quantity> = case.by.iter().map(|(name, _)| quantity(&system, name)).collect();
    let found = gradient(&system, &Controls::Guess, &Options::default(), &quantities);
    let found = found.unwrap_or_else(|stopped| panic!("{}: {:?}", case.title, stopped.status));
    (system, found)
}

/// A model has one objective: the last that is written.
fn without_earlier_objective(text: &str) -> String {
    let is_objective = |line: &&str| line.starts_with("minimize ");
    let last = text.lines().rfind(is_objective).unwrap_or_default();
    let kept = text.lines().filter(|line| !is_objective(line) || *line == last);
    kept.collect::<Vec<_>>().join("\n")
}

fn check(name: &str, text: &str, case: &Case) {
    let (system, found) = differentiated(text, case);
    let name = format!("{name}, {}", case.title);
    assert!(found.agreement <= AGREEMENT, "{name}: forward {:?}, adjoint {:?}", found.forward, found.adjoint);
    for ((by, expected), got) in case.by.iter().zip(&found.forward) {
        let error = (got - expected).abs();
        assert!(error <= TOLERANCE * expected.abs().max(1.0), "{name}: by {by} {got}, not {expected}");
    }
    for (names, expected) in &case.second {
        let quantities = names.map(|name| quantity(&system, name));
        let hessian = hessian(&system, &Controls::Guess, &found.simulation, &quantities);
        let got = hessian.expect("it does not come to rest")[0][1];
        let error = (got - expected).abs();
        assert!(error <= TOLERANCE * expected.abs().max(1.0), "{name}: by {names:?} {got}, not {expected}");
    }
}

#[test]
fn every_derivative_is_what_its_source_says() {
    let files = documents("tests/gradients", "expected");
    assert!(!files.is_empty());
    for (name, expected) in files {
        let text = text_of(&name);
        cases(&expected).iter().for_each(|case| check(&name, &text, case));
    }
}
