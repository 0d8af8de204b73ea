//! Derivatives of the true system are what the files of `tests/gradients/` say, to 1e-8, from a
//! source that is not this program; forward and adjoint agree to 1e-10.
//!
//! ```text
//! case WHAT, AND WHO SAYS SO
//! set NAME = VALUE                  a `param` or a `free`
//! control TIME VALUE                held from TIME on; the guess if left out
//! fixed times                       these TIMEs do not move with the end of the interval
//! of EXPRESSION                     the model's own objective if left out
//! by PARAM = VALUE                  or STATE(start), or CONTROL[ROW]
//! second A B = VALUE                a second derivative, by two of these
//! ```

use fdcc_compiler::compile_sensitivities;
use fdcc_runtime::problem::Variable;
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
    controls: Vec<[f64; 2]>,
    is_fixed: bool,
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
        ("control", None) => {
            let (time, value) = rest.split_once(' ')?;
            case.controls.push([time.parse().ok()?, value.parse().ok()?]);
        }
        ("fixed", None) => case.is_fixed = true,
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
    let place = |variables: &[Variable], name| variables.iter().position(|it| it.name == name);
    if let Some(state) = name.strip_suffix("(start)") {
        return Quantity::Start(place(&system.states, state).expect("a state"));
    }
    if let Some((control, row)) = name.strip_suffix(']').and_then(|name| name.split_once('[')) {
        let control = place(&system.controls, control).expect("a control");
        return Quantity::Control { row: row.parse().expect("a row"), control };
    }
    Quantity::Parameter(
        system.parameters.iter().position(|it| it.name == name).expect("a parameter"),
    )
}

fn text_of(name: &str) -> String {
    let own = ["tests/gradients", "tests/simulations"]
        .into_iter()
        .flat_map(|folder| documents(folder, "fdc"));
    match { own }.find(|(other, _)| other == name) {
        Some((_, text)) => text,
        None => fdcc_tests::models::text_of(name),
    }
}

impl Case<'_> {
    fn system(&self, text: &str) -> System {
        let text = match self.of {
            Some(output) => format!("{}\nminimize {output}\n", without_objective(text)),
            None => text.to_string(),
        };
        let mut model = meaning(&text);
        for (name, value) in &self.set {
            if model.set_param(name, value).is_err() {
                model.set_free(name, value.parse().expect("a number"));
            }
        }
        compile_sensitivities(&model).expect("the model can be simulated")
    }

    fn controls(&self) -> Controls {
        if self.controls.is_empty() {
            return Controls::Guess;
        }
        let times = self.controls.iter().map(|row| row[0]).collect();
        let rows = self.controls.iter().map(|row| vec![row[1]]).collect();
        Controls::Held { times, rows, is_stretched: !self.is_fixed }
    }
}

fn without_objective(text: &str) -> String {
    text.lines().filter(|line| !line.starts_with("minimize ")).collect::<Vec<_>>().join("\n")
}

/// What is wrong with a number.
fn difference(what: &str, got: f64, expected: f64) -> Option<String> {
    let is_near = (got - expected).abs() <= TOLERANCE * expected.abs().max(1.0);
    (!is_near).then(|| format!("{what} is {got}, not {expected}"))
}

fn first_order(system: &System, case: &Case) -> (Sensitivity, Vec<String>) {
    let quantities: Vec<Quantity> =
        case.by.iter().map(|(name, _)| quantity(system, name)).collect();
    let found = gradient(system, &case.controls(), &Options::default(), &quantities);
    let found = found.unwrap_or_else(|stopped| panic!("{}: {:?}", case.title, stopped.status));
    let mut wrong: Vec<String> = case
        .by
        .iter()
        .zip(&found.forward)
        .filter_map(|((name, expected), got)| difference(&format!("by {name}"), *got, *expected))
        .collect();
    if found.agreement > AGREEMENT {
        wrong.push(format!("forward {:?}, adjoint {:?}", found.forward, found.adjoint));
    }
    (found, wrong)
}

fn second_order(system: &System, case: &Case, found: &Sensitivity) -> Vec<String> {
    if case.second.is_empty() {
        return Vec::new();
    }
    let names: Vec<&str> = case.by.iter().map(|by| by.0).collect();
    let quantities: Vec<Quantity> = names.iter().map(|name| quantity(system, name)).collect();
    let matrix = hessian(system, &case.controls(), &found.simulation, &quantities);
    let matrix = matrix.expect("it does not come to rest");
    let place =
        |name: &str| names.iter().position(|other| *other == name).expect("one of those above");
    let entry = |[a, b]: [&str; 2]| matrix[place(a)][place(b)];
    let wrong = |(names, expected): &([&str; 2], f64)| {
        difference(&format!("by {}, {}", names[0], names[1]), entry(*names), *expected)
    };
    case.second.iter().filter_map(wrong).collect()
}

fn check(name: &str, text: &str, case: &Case) -> Vec<String> {
    let system = case.system(text);
    let (found, mut wrong) = first_order(&system, case);
    wrong.extend(second_order(&system, case, &found));
    wrong.iter().map(|wrong| format!("{name}, {}: {wrong}", case.title)).collect()
}

#[test]
fn every_derivative_is_what_its_source_says() {
    let files = documents("tests/gradients", "expected");
    assert!(!files.is_empty());
    let mut wrong = Vec::new();
    for (name, expected) in files {
        let text = text_of(&name);
        wrong.extend(cases(&expected).iter().flat_map(|case| check(&name, &text, case)));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
