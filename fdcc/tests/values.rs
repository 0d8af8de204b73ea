//! A variant with another value of a parameter is what a fresh compile of a model with that value
//! is, to the bit: for every parameter of every model.

use fdcc::Model;
use fdcc_runtime::problem::{Columns, Function, Problem};
use std::fs;

fn models() -> Vec<String> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../models");
    let files = fs::read_dir(folder).expect("there are models");
    let paths = files.map(|file| file.expect("it can be read").path());
    let models = paths.filter(|path| path.extension().is_some_and(|ending| ending == "fdc"));
    let mut names: Vec<String> = models.map(|path| path.display().to_string()).collect();
    names.sort();
    names
}

/// Everything of a problem that is a number, as bits; functions at a few points.
fn bits(problem: &Problem) -> Vec<u64> {
    let variables = problem.states.iter().chain(&problem.controls);
    let bounds = variables
        .map(|it| it.bounds)
        .chain(problem.unknowns.iter().map(|it| it.bounds))
        .chain(problem.path_bounds.iter().copied())
        .chain(problem.boundary_bounds.iter().copied());
    let mut numbers: Vec<f64> = bounds.flat_map(|it| [it.lower, it.upper]).collect();
    let parameters: Vec<f64> = problem.parameters.iter().map(|it| it.value).collect();
    numbers.extend(problem.start.iter().map(|start| start.unwrap_or(f64::NAN)));
    numbers.extend(&parameters);
    let functions: [&dyn Function; 7] = [
        &*problem.dynamics,
        &*problem.path,
        &*problem.boundary,
        &*problem.guess,
        &*problem.interval,
        &*problem.switching,
        &*problem.report,
    ];
    functions.iter().for_each(|function| numbers.extend(sampled(*function, &parameters)));
    numbers.into_iter().map(f64::to_bits).collect()
}

/// Values and first derivatives.
fn sampled(function: &dyn Function, parameters: &[f64]) -> Vec<f64> {
    let inputs = function.layout().point_inputs();
    let mut points = Columns::new(inputs, 3);
    for column in 0..inputs {
        for point in 0..3 {
            points.column_mut(column)[point] = 0.1 + 0.3 * column as f64 + 0.7 * point as f64;
        }
    }
    let entries = function.jacobian_pattern().entries.len();
    let mut values = Columns::new(function.outputs(), 3);
    let mut slopes = Columns::new(entries, 3);
    function.jacobian(&points, parameters, &mut values, &mut slopes);
    let values = (0..function.outputs()).flat_map(|row| values.column(row).to_vec());
    values.chain((0..entries).flat_map(|entry| slopes.column(entry).to_vec())).collect()
}

#[test]
fn a_variant_is_a_fresh_compile_to_the_bit() {
    let mut compared = 0;
    for path in models() {
        let model = Model::from_file(&path).expect("the models are right");
        // Not all of them can be solved yet.
        let Ok(problem) = model.problem() else { continue };
        let before = bits(&problem);
        for (at, param) in model.meaning().params.iter().enumerate() {
            let name = &param.place.name;
            let value = problem.parameters[at].value;
            // A parameter may have bounds, and may be 0.
            let other = [1.1 * value, 0.9 * value, value + 0.1].into_iter().find_map(|value| {
                let changed = model.changed(|meaning| meaning.set_param_number(name, value));
                Some((value, changed.ok()?))
            });
            let (value, fresh) = other.unwrap_or_else(|| panic!("{path}: no value for `{name}`"));
            let variant = model.with(name, value).expect("the fresh one took it");
            let [variant, fresh] =
                [variant, fresh].map(|it| bits(&it.problem().expect("it can be solved")));
            assert!(variant == fresh, "{path}: `{name}` = {value}");
            compared += usize::from(variant != before);
        }
        assert!(before == bits(&model.problem().expect("as before")), "{path} itself has changed");
    }
    assert!(compared > 20, "only {compared} values make a difference");
}

#[test]
fn a_variant_is_solved_to_the_same_bits() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/block.fdc");
    let model = Model::from_file(path).expect("the model is right");
    let options = fdcc::Options::default();
    model.solve(&options).expect("it can be solved");
    let solve = |model: Model| model.solve(&options).expect("it can be solved").outcome.solution.v;
    let variant = solve(model.with("mu", 0.2).expect("a parameter"));
    let fresh = Model::from_file(path).and_then(|model| model.with("mu", "0.2"));
    assert!(variant == solve(fresh.expect("the model is right")));
}
