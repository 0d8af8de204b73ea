//! Examples (e0) and (e1): how the least time from rest, or from the wrong direction, to rest at a
//! distance of 1 depends on the data.
//!
//! The model of `tests/gradients/bang_bang.fdc` turns its force at `turn` and ends a time `REST`
//! before it stops; with `F = U + mu` its end conditions are `v = F REST` and `x + F REST^2/2 = 1`.
//! They determine `T` and `turn`, so derivatives of both follow from those of the end by the
//! implicit function theorem.

use fdcc_compiler::compile_sensitivities;
use fdcc_runtime::sensitivity::{Quantity, gradient};
use fdcc_runtime::simulate::{Controls, Options};
use fdcc_tests::models::meaning;
use fdcc_tests::repository;

const REST: f64 = 0.1;

/// `dT` by some parameters, for a start at a speed, the time at which the force turns and the final
/// time.
fn final_time_by(v0: &str, turn: &str, last: f64, names: &[&str]) -> Vec<f64> {
    let path = repository().join("tests/gradients/bang_bang.fdc");
    let mut model = meaning(&std::fs::read_to_string(path).expect("the model"));
    model.set_param("v0", v0).expect("a parameter");
    model.set_param("turn", turn).expect("a parameter");
    model.set_free("T", last - REST);
    let system = compile_sensitivities(&model).expect("it can be simulated");
    let quantity = |name: &&str| {
        let place = system.parameters.iter().position(|it| it.name == *name);
        Quantity::Parameter(place.expect("a parameter"))
    };
    let quantities: Vec<Quantity> = ["T", "turn"].iter().chain(names).map(quantity).collect();
    let found = gradient(&system, &Controls::Guess, &Options::default(), &quantities);
    let found = found.expect("it reaches the end");
    let [x, v] = [0, 1].map(|state| found.end[state].clone());
    let determinant = x[0] * v[1] - x[1] * v[0];
    let by = |(at, name): (usize, &&str)| {
        let moves = if ["U", "mu"].contains(name) { 1.0 } else { 0.0 };
        let (x_by, v_by) = (x[at + 2] + moves * REST * REST / 2.0, v[at + 2] - moves * REST);
        -(x_by * v[1] - v_by * x[1]) / determinant
    };
    names.iter().enumerate().map(by).collect()
}

#[track_caller]
fn near(got: &[f64], expected: &[f64]) {
    let is_near = got.iter().zip(expected).all(|(a, b)| (a - b).abs() <= 1e-8);
    assert!(is_near, "{got:?}, not {expected:?}");
}

/// `T = 2 sqrt(d U/(U^2 - mu^2))`; a start further on is a distance less.
#[test]
fn the_least_time_from_rest_to_rest() {
    let got = final_time_by("0", "0.9128709291752769", 1.4605934866804429, &["mu", "U", "x0"]);
    near(&got, &[0.19474579822405907, -0.4138348212261255, -0.7302967433402214]);
}

/// By the start: the costate there.
#[test]
fn the_least_time_from_the_wrong_direction() {
    near(&final_time_by("-1", "1.4", 2.0, &["x0", "v0"]), &[-2.0 / 3.0, -2.0 / 3.0]);
}
