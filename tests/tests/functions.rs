//! Interpreter = machine code, derivatives = differences: for every function of every model.

use std::sync::Arc;

use fdcc_compiler::differentiate::Differentiated;
use fdcc_compiler::differentiate::differentiate;
use fdcc_compiler::generate::{clif, generate};
use fdcc_compiler::graph::Graph;
use fdcc_compiler::lower::lower;
use fdcc_compiler::{Model, compile};
use fdcc_runtime::problem::{Columns, Function, Problem};
use fdcc_tests::documents;
use fdcc_tests::functions::{check_differences, check_machine_code};
use fdcc_tests::models::{changed, in_phases, refusal};
use fdcc_tests::random::Random;
use fdcc_tests::symbols::table;

/// Kernels that are smooth everywhere; differences across a knot of the others would say nothing.
const KERNELS: [&str; 2] = ["tanh", "sqrt"];
/// Wide, so that the steps of the differences are short within the layer.
const SIGMA: f64 = 0.5;

fn functions(problem: &Problem) -> [Arc<dyn Function>; 7] {
    let Problem { dynamics, path, boundary, guess, interval, switching, report, .. } = problem;
    [dynamics, path, boundary, guess, interval, switching, report].map(Arc::clone)
}

/// The expressions behind [`functions`], in the same order.
fn symbols(model: &Model) -> (Graph, Vec<Differentiated>) {
    let program = lower(model);
    let functions: Vec<_> = program.functions().into_iter().cloned().collect();
    let mut graph = program.graph;
    let functions =
        functions.into_iter().map(|function| differentiate(&mut graph, function)).collect();
    (graph, functions)
}

/// The parameters of the problem, each unknown a little off its guess, each layer wide.
fn parameters(problem: &Problem, random: &mut Random) -> Vec<f64> {
    let mut parameters: Vec<f64> =
        problem.parameters.iter().map(|parameter| parameter.value).collect();
    for unknown in &problem.unknowns {
        parameters[unknown.parameter] *= random.between(0.9, 1.1);
    }
    problem.surfaces.iter().for_each(|surface| parameters[surface.sigma] = SIGMA);
    parameters
}

/// Times in the unit interval, everything else around the origin.
fn points(function: &dyn Function, random: &mut Random) -> Columns {
    let mut points = table(random, function.layout().point_inputs(), 9, -2.0, 2.0);
    if function.layout().t == 1 {
        points.column_mut(0).iter_mut().for_each(|tau| *tau = random.between(0.1, 0.9));
    }
    points
}

fn check(text: &str, kernel: &str) -> Result<(), String> {
    let model = changed(text, &[], &[("kernel", kernel)]);
    let all = in_phases(&model);
    let mut phases = all.iter().flat_map(|chained| chained.phases());
    phases.try_for_each(|(model, problem)| check_model(model, problem, kernel))
}

fn check_model(model: &Model, problem: &Problem, kernel: &str) -> Result<(), String> {
    let (graph, symbols) = symbols(model);
    let mut random = Random::new(1);
    for (function, symbols) in functions(problem).iter().zip(&symbols) {
        let parameters = parameters(problem, &mut random);
        let points = points(&**function, &mut random);
        let multipliers = table(&mut random, function.outputs(), points.count(), -1.0, 1.0);
        let by = &symbols.function.by;
        check_machine_code(&graph, symbols, &**function, &points, &parameters, &multipliers, 1e-13)
            .and_then(|()| {
                check_differences(&**function, by, &points, &parameters, &multipliers, 1e-6)
            })
            .map_err(|error| format!("{}, kernel {kernel}: {error}", symbols.function.name))?;
    }
    Ok(())
}

#[test]
fn the_functions_of_every_model_are_their_interpreter_and_their_derivatives_are_differences() {
    for (name, text) in documents("models", "fdc") {
        if refusal(&text).is_none() {
            for kernel in KERNELS {
                check(&text, kernel).unwrap_or_else(|error| panic!("{name}: {error}"));
            }
        }
    }
}

/// So long that registers are chosen in one pass.
#[test]
fn a_long_function_is_its_interpreter_too() {
    let terms: Vec<String> = (1..=200).map(|i| format!("sin({i}/100 * x + v)")).collect();
    let text = format!(
        "time t in [0, 1] state x start 1 state v start 0 control u in [-1, 1]\n\
         dynamics {{ x' = v  v' = u + {} }}\nminimize integral(u^2)\nmethod {{ N = 10 scheme = rk4 \
         }}",
        terms.join(" + ")
    );
    let model = changed(&text, &[], &[]);
    let problem = compile(&model).expect("the model can be solved");
    let (graph, symbols) = symbols(&model);
    assert!(
        clif(&graph, &symbols[..1]).lines().count() > 60_000,
        "three orders of more than 20,000"
    );
    let mut random = Random::new(4);
    let points = points(&*problem.dynamics, &mut random);
    let multipliers = table(&mut random, problem.dynamics.outputs(), points.count(), -1.0, 1.0);
    let parameters = parameters(&problem, &mut random);
    check_machine_code(
        &graph,
        &symbols[0],
        &*problem.dynamics,
        &points,
        &parameters,
        &multipliers,
        1e-12,
    )
    .unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn functions_of_another_model_are_told_apart() {
    let text = "time t in [0, 1] state x start 1 dynamics { x' = sin(x) } minimize x(end)";
    let other =
        compile(&changed(&text.replace("sin", "cos"), &[], &[])).expect("the model can be solved");
    let (graph, symbols) = symbols(&changed(text, &[], &[]));
    let points = points(&*other.dynamics, &mut Random::new(2));
    let multipliers = table(&mut Random::new(3), 1, points.count(), -1.0, 1.0);
    let own = generate(graph.clone(), symbols.clone()).remove(0);
    let against = |function: &dyn Function| {
        check_machine_code(&graph, &symbols[0], function, &points, &[], &multipliers, 1e-13)
    };
    against(&*own).expect("its own machine code");
    against(&*other.dynamics).expect_err("the machine code of another model");
}

/// What has no value has none by steps and by machine code, whatever it is compared with.
#[test]
fn an_extremum_of_what_has_no_value_has_none() {
    for right in ["max(log(x), 0)", "max(0, log(x))", "min(sqrt(x), 0)", "min(0, asin(x - 2))"] {
        let text =
            format!("time t in [0, 1] state x start 1 dynamics {{ x' = {right} }} minimize x(end)");
        let problem = compile(&changed(&text, &[], &[])).expect("the model can be solved");
        let function = &*problem.dynamics;
        let points = table(&mut Random::new(5), function.layout().point_inputs(), 5, -2.0, -1.0);
        for is_prepared in [false, true] {
            (0..3).filter(|_| is_prepared).for_each(|order| function.prepare(order));
            let mut values = Columns::new(1, points.count());
            function.value(&points, &[], &mut values);
            assert!(values.column(0).iter().all(|value| value.is_nan()), "{right}: {values:?}");
        }
    }
}
