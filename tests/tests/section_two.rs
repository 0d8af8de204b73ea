//! Section 2 of Stewart & Anitescu (2005): values that converge and gradients that do not.

use fdcc_runtime::fixed_step::Grid;
use fdcc_tests::repository;
use fdcc_tests::section_two::{
    exact, implicit_euler, inclusion, inclusion_to_the_end, objective, set, smoothed, stepped,
};
use serde_json::Value;

fn reference(table: &str) -> Vec<Value> {
    let path = repository().join("tests/reference/section-2.json");
    let text = std::fs::read_to_string(path).expect("the reference is there");
    let all: Value = serde_json::from_str(&text).expect("JSON");
    all[table].as_array().expect("rows").clone()
}

fn number(row: &Value, key: &str) -> f64 {
    row[key].as_f64().unwrap_or_else(|| panic!("{key} in {row}"))
}

/// The columns of a table with headings.
fn csv(name: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let text =
        std::fs::read_to_string(repository().join("tests/reference").join(name)).expect("the data");
    let mut lines = text.lines();
    let headings = lines.next().expect("headings").split(',').map(String::from).collect();
    let row = |line: &str| line.split(',').map(|word| word.parse().expect("a number")).collect();
    (headings, lines.map(row).collect())
}

fn assert_close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (found - expected).abs() / expected.abs().max(1.0);
    assert!(error <= tolerance, "{what}: expected {expected}, got {found}");
}

#[test]
fn the_theta_scheme_computes_what_its_closed_form_says() {
    let mut system = inclusion_to_the_end();
    for row in reference("theta_scheme") {
        let steps = (2.0 / number(&row, "h")).round() as usize;
        let (x0, theta) = (number(&row, "x0"), number(&row, "theta"));
        set(&mut system, &[("x0", x0), ("T", 2.0)]);
        let (run, gradient) = stepped(&system, &Grid::theta(&system, theta, steps));
        let mut found = vec![run.states[0][steps], gradient.starts[0]];
        // The derivative of the integral costs a run for each step.
        if steps <= 200 {
            found.extend(objective(&mut system, x0, steps, theta));
        }
        for (key, found) in ["xT", "dxT", "J", "dJ"].into_iter().zip(found) {
            assert_close(found, number(&row, key), 1e-12, &format!("{key} of {row}"));
        }
    }
}

#[test]
fn euler_steps_of_the_smoothed_system_agree_with_another_program() {
    let mut system = smoothed();
    for row in reference("tanh") {
        let (h, theta) = (number(&row, "h"), number(&row, "theta"));
        let missing = (theta - 0.5) * h;
        let sigma = number(&row, "sigma");
        set(
            &mut system,
            &[("x0", number(&row, "x0")), ("missing", missing), ("sigma(zero)", sigma)],
        );
        let (stepped, gradient) =
            stepped(&system, &Grid::theta(&system, theta, (2.0 / h).round() as usize));
        assert_close(
            stepped.states[0][stepped.time.len() - 1],
            number(&row, "xT"),
            1e-11,
            &row.to_string(),
        );
        assert_close(stepped.objective.expect("J"), number(&row, "J"), 1e-11, &row.to_string());
        assert_close(gradient.starts[0], number(&row, "dJ"), 1e-8, &row.to_string());
    }
}

#[test]
fn the_curves_of_figure_2_1_are_those_of_another_program() {
    let (_, rows) = csv("figure-2.1.csv");
    let mut system = inclusion();
    for row in rows {
        let truth = exact(row[0]);
        assert_close(truth[0], row[1], 1e-14, "J");
        assert_close(truth[1], row[2], 1e-14, "J'");
        for (steps, expected) in [20, 40, 100, 200].into_iter().zip(&row[3..]) {
            let found = implicit_euler(&mut system, row[0], steps)[0];
            assert_close(found, *expected, 1e-12, &format!("J_h({}) for {steps} steps", row[0]));
        }
    }
}

const WIDTHS: [f64; 6] = [0.1, 0.05, 0.02, 0.01, 0.005, 0.001];

#[test]
fn the_curves_of_figure_2_2_are_those_of_another_program() {
    let (_, rows) = csv("figure-2.2.csv");
    let mut system = smoothed();
    for row in rows {
        assert_close(exact(row[0])[0], row[1], 1e-14, "J");
        for (at, sigma) in WIDTHS.into_iter().enumerate() {
            set(&mut system, &[("sigma(zero)", sigma)]);
            let found = implicit_euler(&mut system, row[0], 200);
            assert_close(
                found[0],
                row[2 + at],
                1e-11,
                &format!("J({}) for sigma = {sigma}", row[0]),
            );
            assert_close(
                found[1],
                row[8 + at],
                1e-8,
                &format!("J'({}) for sigma = {sigma}", row[0]),
            );
        }
    }
}
