//! Every model of the repository has an expectation, and meets it.

use fdcc_compiler::{Model, compile};
use fdcc_runtime::nlp::Status;
use fdcc_runtime::solution::phases::joined;
use fdcc_tests::expected::Expected;
use fdcc_tests::models::{borrowed, changed, in_phases, meaning, refusal, solve_chain, text_of};
use fdcc_tests::{Solved, documents, repository};

fn expected(name: &str) -> Expected {
    let path = repository().join("models").join(name).with_extension("expected");
    let text = std::fs::read_to_string(&path)
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    Expected::read(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The best of all sequences of jumps.
fn best(model: &Model) -> Solved {
    let between = compile(model).expect("the model can be solved");
    let solved = in_phases(model).into_iter().map(|it| {
        let outcome = solve_chain(&it.chain);
        assert_eq!(outcome.solution.status, Status::Solved, "{}", model.name);
        Solved { problem: between.clone(), outcome: joined(&between, &it.chain, &outcome).0 }
    });
    let better = |a: Solved, b: Solved| if b.objective() < a.objective() { b } else { a };
    solved.reduce(better).expect("there is at least one")
}

fn check_values(name: &str, text: &str, expected: &Expected) {
    let solved = best(&changed(text, &[], &borrowed(&expected.methods)));
    assert!(!expected.values.is_empty(), "{name}: nothing is expected");
    for value in &expected.values {
        let got = solved.quantity(&value.name);
        let gap = got - value.value;
        let near =
            if value.is_limit { gap <= value.tolerance } else { gap.abs() <= value.tolerance };
        assert!(near, "{name}: {} = {got}, but {} from {}", value.name, value.value, value.source);
    }
}

fn check_refusal(name: &str, text: &str, code: &str, message: &str) {
    let found =
        refusal(text).unwrap_or_else(|| panic!("{name} can be solved now: give it a value"));
    assert_eq!((found.len(), found[0].code.as_str()), (1, code), "{name}: {found:?}");
    assert!(found[0].message.starts_with(message), "{name}: {}", found[0].message);
}

#[test]
fn every_model_meets_its_expectation() {
    for (name, text) in documents("models", "fdc") {
        // Those with phases say themselves what is expected, and `fdcc test` compares.
        if text.contains("\nphase ") {
            continue;
        }
        let (expected, smoothed) = (expected(&name), text_of(&name));
        match &expected.error {
            Some((code, message)) => check_refusal(&name, &text, code, message),
            None => check_values(&name, &smoothed, &expected),
        }
    }
}

#[test]
fn every_expectation_belongs_to_a_model() {
    let models: Vec<String> =
        documents("models", "fdc").into_iter().map(|(name, _)| name).collect();
    for (name, _) in documents("models", "expected") {
        assert!(models.contains(&name), "models/{name}.expected has no model");
    }
}

#[test]
fn every_model_has_a_name_of_its_own_and_says_what_it_is() {
    for (name, text) in documents("models", "fdc") {
        assert_eq!(meaning(&text).name, name);
        assert!(text.starts_with("#! "), "{name} begins with a line that says what it is");
    }
}

#[test]
#[should_panic(expected = "block: objective = 59.8")]
fn a_wrong_expectation_is_noticed() {
    let mut wrong = expected("block");
    wrong.values[0].value += 3.0 * wrong.values[0].tolerance;
    check_values("block", &fdcc_tests::models::text_of("block"), &wrong);
}
