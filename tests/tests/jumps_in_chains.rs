//! What a model with jumps can do since its pieces are phases of a chain.

use fdcc::{Model, Options, Solution};
use fdcc_tests::models::text_of;

fn solve(text: &str, settings: &[(&str, &str)]) -> Solution {
    let mut model = Model::from_text("a test", text).expect("a model");
    for (key, value) in settings {
        model = model.with_method(key, *value).expect("a setting");
    }
    let solution = model.solve(&Options::default()).expect("it can be solved");
    // What is certified of it is tested elsewhere.
    assert!(solution.status().is_solved(), "{settings:?}: {}", solution.status_name());
    solution
}

/// With many short intervals all shapes come to one optimum, and each is replayed as it is.
#[test]
fn controls_of_every_shape_go_with_jumps() {
    let text = text_of("bounce");
    let held = solve(&text, &[("scheme", "midpoint"), ("N", "200")]).objective();
    for [scheme, shape, intervals] in
        [["trapezoid", "linear", "100"], ["radau3", "polynomial", "30"]]
    {
        let settings = [("scheme", scheme), ("controls", shape), ("N", intervals)];
        let found = solve(&text, &settings);
        assert!((found.objective() / held - 1.0).abs() < 1e-4, "{shape}: {}", found.objective());
        assert_eq!(found.jumps.len(), 1);
        let verified = found.verify().expect("it can be replayed");
        assert!(verified.confirms(1e-3), "{shape} is not followed");
    }
}

/// Only the last interval before the jump matters, and its control has to be 1/2.
#[test]
fn a_reset_reads_the_control_just_before_it() {
    let text = "model dose\ntime t in [0, 1]\nstate clock start 0\nstate x start 0\n\
                control u in [-1, 1]\nsurface half = clock - 0.5\n\
                dynamics {\n  clock' = 1\n  x' = 0\n}\n\
                jump dose on half rising at most 1 { x := x + u }\nend x == 0.5\n\
                minimize integral(u^2)\nmethod { N = 20  scheme = midpoint }\n";
    let found = solve(text, &[]);
    assert!((found.objective() - 0.25 * 0.5 / 20.0).abs() < 1e-8, "{}", found.objective());
    let control = found.control("u").expect("it is declared");
    assert!((control[19] - 0.5).abs() < 1e-6 && control[18].abs() < 1e-6, "{control:?}");
}

/// Each piece is refined by itself.
#[test]
fn pieces_have_grids_of_their_own() {
    let found = solve(&text_of("bounce"), &[("scheme", "radau2"), ("N", "auto")]);
    let phases = found.between_jumps.as_ref().expect("it has a jump");
    let intervals: Vec<usize> =
        phases.chain.phases.iter().map(|it| it.method.intervals()).collect();
    assert_eq!(intervals.iter().sum::<usize>() + 1, found.time().len(), "{intervals:?}");
    assert!(found.time().windows(2).all(|pair| pair[0] < pair[1]));
    assert!((found.objective() - 20.970192).abs() < 1e-3, "{}", found.objective());
}

/// The derivative by a parameter of the links and of both phases, against two solves.
#[test]
fn an_optimum_of_phases_is_worth_to_its_parameters_what_two_solves_say() {
    let model = Model::from_text("twostage", &text_of("twostage")).expect("a model");
    let solved = |model: &Model| model.solve(&Options::default()).expect("it can be solved");
    for (name, value, step) in [("c", 2500.0, 1.0), ("drop", 300.0, 1.0)] {
        let at = |value: f64| solved(&model.with(name, value).expect("a parameter")).objective();
        let difference = (at(value + step) - at(value - step)) / (2.0 * step);
        let solution = solved(&model);
        let own = solution.sensitivities();
        let own = own.iter().find(|it| it.0 == name).expect("it is a parameter").1;
        assert!((own - difference).abs() < 1e-3 * difference.abs(), "{name}: {own} {difference}");
    }
}
