//! Interpreter = machine code, derivatives = differences: for every builtin and random expressions.

use fdcc_compiler::builtins::{self, Builtin, Domain, Notation, Smoothness};
use fdcc_compiler::differentiate::Differentiated;
use fdcc_compiler::differentiate::differentiate;
use fdcc_compiler::generate::clif;
use fdcc_compiler::graph::{ExprId, Graph, evaluate, print, verify};
use fdcc_compiler::lower::{Order, VectorFunction};
use fdcc_runtime::problem::{Columns, Degree, Function, Layout, Origin};
use fdcc_tests::expressions::random_expressions;
use fdcc_tests::functions::{check_differences, check_machine_code, derivatives};
use fdcc_tests::random::Random;
use fdcc_tests::symbols::{compile, function, states_and_parameters, table};

const COUNTS: [usize; 6] = [0, 1, 2, 3, 7, 1000];

/// Both checks on random points between `low` and `high`.
fn check(graph: &Graph, symbols: &Differentiated, low: f64, high: f64) -> Result<(), String> {
    verify(graph)?;
    let mut random = Random::new(1);
    let layout = symbols.function.layout;
    for count in COUNTS {
        let compiled = compile(graph, symbols);
        let points = table(&mut random, layout.point_inputs(), count, low, high);
        let multipliers = table(&mut random, symbols.function.outputs.len(), count, -1.0, 1.0);
        let parameters: Vec<f64> = (0..layout.p).map(|_| random.between(low, high)).collect();
        check_machine_code(graph, symbols, &*compiled, &points, &parameters, &multipliers, 1e-13)?;
        check_differences(
            &*compiled,
            &symbols.function.by,
            &points,
            &parameters,
            &multipliers,
            1e-7,
        )?;
    }
    Ok(())
}

/// A range inside the domain, away from where derivatives grow without bound.
fn range(domain: Domain) -> (f64, f64) {
    match domain {
        Domain::All => (-1.4, 1.4),
        Domain::NonNegative(_) | Domain::Positive(_) | Domain::NonZero(_) => (0.4, 1.8),
        Domain::Unit(_) => (-0.8, 0.8),
    }
}

/// `builtin` of as many states as it has operands; of one parameter instead of the last state if
/// `parameter`.
fn call_of_inputs(graph: &mut Graph, builtin: Builtin, parameter: bool) -> Differentiated {
    let arity = builtin.row().arity;
    let inputs: Vec<ExprId> = (0..arity as u32).map(|input| graph.input(input)).collect();
    let call = graph.call(builtin, &inputs);
    let parameters = usize::from(parameter);
    function(graph, vec![call], states_and_parameters(arity - parameters, parameters))
}

#[test]
fn every_smooth_builtin_is_its_interpreter_and_its_partials_are_differences() {
    for &builtin in
        builtins::ALL.iter().filter(|builtin| builtin.row().smoothness == Smoothness::Analytic)
    {
        for parameter in [false, true] {
            let mut graph = Graph::new();
            let symbols = call_of_inputs(&mut graph, builtin, parameter);
            let (low, high) = range(builtin.row().domain);
            check(&graph, &symbols, low, high)
                .unwrap_or_else(|error| panic!("{}: {error}", builtin.row().name));
        }
    }
}

#[test]
fn builtins_with_kinks_have_the_partials_of_the_branch_they_are_on() {
    for &builtin in
        builtins::ALL.iter().filter(|builtin| builtin.row().smoothness != Smoothness::Analytic)
    {
        let mut graph = Graph::new();
        let symbols = call_of_inputs(&mut graph, builtin, false);
        let compiled = compile(&graph, &symbols);
        let arity = symbols.function.layout.x;
        let mut points = Columns::new(arity, 2);
        // Operands 1/4 apart, in one order and in the other: the differences stay on their branch.
        for operand in 0..arity {
            points
                .column_mut(operand)
                .copy_from_slice(&[0.25 + 0.25 * operand as f64, 0.25 - 0.5 * operand as f64]);
        }
        let multipliers = table(&mut Random::new(2), 1, 2, -1.0, 1.0);
        let name = builtin.row().name;
        check_machine_code(&graph, &symbols, &*compiled, &points, &[], &multipliers, 1e-15)
            .and_then(|()| {
                check_differences(
                    &*compiled,
                    &symbols.function.by,
                    &points,
                    &[],
                    &multipliers,
                    1e-9,
                )
            })
            .unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

#[test]
fn every_kind_of_input_is_read_from_its_own_place() {
    let mut graph = Graph::new();
    let layout = Layout { t: 1, x: 2, u: 1, p: 2, s: 2 };
    let inputs: Vec<ExprId> = (0..8).map(|input| graph.input(input)).collect();
    let weighted: Vec<ExprId> = inputs
        .iter()
        .map(|&input| graph.scale(f64::from(input.index() as u32 + 1), input))
        .collect();
    let sum = graph.sum(&weighted);
    let output = graph.sin(sum);
    let parameter = graph.mul(inputs[4], inputs[5]);
    let symbols = function(&mut graph, vec![output, parameter, sum], layout);
    check(&graph, &symbols, -0.5, 0.5).expect("all inputs in their places");
}

#[test]
fn a_wrong_partial_is_caught() {
    let mut graph = Graph::new();
    let (x, y) = (graph.input(0), graph.input(1));
    let sine = graph.sin(x);
    let product = graph.mul(sine, y);
    let right = function(&mut graph, vec![product], states_and_parameters(2, 0));
    check(&graph, &right, -1.0, 1.0).expect("the right derivative passes");

    let mut wrong = right.clone();
    wrong.jacobian.1[0] = graph.scale(1.0001, right.jacobian.1[0]);
    let error = check(&graph, &wrong, -1.0, 1.0).expect_err("a Jacobian that is wrong by 1e-4");
    assert!(error.contains("d output 0 / d z0"), "{error}");

    let mut wrong = right.clone();
    wrong.hessian.1[0] = graph.neg(right.hessian.1[0]);
    let error = check(&graph, &wrong, -1.0, 1.0).expect_err("a Hessian of the wrong sign");
    assert!(error.contains("d2 lagrangian / d z0 d z0"), "{error}");

    let mut missing = right.clone();
    missing.jacobian.0.entries.pop();
    missing.jacobian.1.pop();
    check(&graph, &missing, -1.0, 1.0).expect_err("an entry that is missing in the pattern");
}

#[test]
fn a_wrong_instruction_is_caught() {
    let mut graph = Graph::new();
    let x = graph.input(0);
    let sine = graph.sin(x);
    let cosine = graph.cos(x);
    let symbols = function(&mut graph, vec![sine], states_and_parameters(1, 0));
    let other = function(&mut graph, vec![cosine], states_and_parameters(1, 0));
    let points = table(&mut Random::new(3), 1, 5, 0.1, 0.5);
    let multipliers = table(&mut Random::new(4), 1, 5, 0.1, 0.5);
    check_machine_code(
        &graph,
        &symbols,
        &*compile(&graph, &other),
        &points,
        &[],
        &multipliers,
        1e-13,
    )
    .expect_err("the machine code of another function");
}

/// Numbers that matter: both signs of a dense sample over many magnitudes, and the edges.
fn arguments(random: &mut Random) -> Vec<f64> {
    let mut arguments: Vec<f64> = (0..20_000)
        .flat_map(|_| {
            let magnitude = random.between(1.0, 2.0) * 2f64.powi(random.below(80) as i32 - 55);
            [magnitude, -magnitude, random.between(-40.0, 40.0)]
        })
        .collect();
    let quarter = std::f64::consts::FRAC_PI_2;
    arguments.extend((0..2000).flat_map(|k| {
        let multiple = f64::from(k) * quarter;
        [multiple, multiple.next_up(), multiple.next_down(), multiple + 0.5 * quarter]
    }));
    arguments.extend([0.0, -0.0, f64::MIN_POSITIVE, f64::INFINITY, f64::NEG_INFINITY, f64::NAN]);
    arguments.extend([
        1e22,
        1_048_576.0,
        1_048_577.0,
        708.0,
        708.5,
        -708.0,
        -708.5,
        709.9,
        745.0,
        -745.0,
        -746.0,
    ]);
    arguments.extend([20.0, 19.999, 20.001, 1e-300, 1e-310, -1e-310]);
    arguments
}

fn units_in_the_last_place(got: f64, expected: f64) -> f64 {
    (got - expected).abs()
        / (expected.next_up() - expected).abs().min((expected - expected.next_down()).abs())
}

/// Of a function with one output.
fn values(function: &dyn Function, points: &Columns) -> Vec<f64> {
    let mut values = Columns::new(1, points.count());
    function.value(points, &[], &mut values);
    values.column(0).to_vec()
}

#[test]
fn functions_written_out_are_accurate_to_a_few_units_in_the_last_place() {
    let arguments = arguments(&mut Random::new(5));
    for (builtin, bound) in
        [(Builtin::Sin, 2.0), (Builtin::Cos, 2.0), (Builtin::Exp, 2.0), (Builtin::Tanh, 4.0)]
    {
        let mut graph = Graph::new();
        let symbols = call_of_inputs(&mut graph, builtin, false);
        let mut points = Columns::new(1, arguments.len());
        points.column_mut(0).copy_from_slice(&arguments);
        let compiled = compile(&graph, &symbols);
        let by_steps = values(&*compiled, &points);
        compiled.prepare(0);
        let by_code = values(&*compiled, &points);
        for (&x, &got) in arguments.iter().chain(&arguments).zip(by_steps.iter().chain(&by_code)) {
            let expected = (builtin.row().value)(&[x]);
            let same = got == expected || (got.is_nan() && expected.is_nan());
            let near =
                units_in_the_last_place(got, expected) <= bound || (got - expected).abs() < 1e-30;
            assert!(same || near, "{}({x:e}) = {expected:e}, got {got:e}", builtin.row().name);
        }
    }
}

#[test]
fn what_is_not_a_number_goes_through_every_builtin() {
    for &builtin in
        builtins::ALL.iter().filter(|builtin| builtin.row().notation != Notation::Internal)
    {
        for bad in 0..builtin.row().arity {
            let mut graph = Graph::new();
            let symbols = call_of_inputs(&mut graph, builtin, false);
            let mut points = Columns::new(builtin.row().arity, 3);
            points.as_mut_slice().fill(0.5);
            points.column_mut(bad)[1] = f64::NAN;
            let compiled = compile(&graph, &symbols);
            let by_steps = values(&*compiled, &points);
            compiled.prepare(0);
            for values in [by_steps, values(&*compiled, &points)] {
                let nan: Vec<bool> = values.iter().map(|value| value.is_nan()).collect();
                assert_eq!(nan, [false, true, false], "{}", builtin.row().name);
            }
        }
    }
}

#[test]
fn random_expressions_are_compiled_to_what_they_mean() {
    let mut random = Random::new(6);
    for case in 0..60 {
        let mut graph = Graph::new();
        let outputs = random_expressions(&mut graph, &mut random, 10 + case);
        let symbols = function(&mut graph, outputs, states_and_parameters(3, 1));
        verify(&graph).expect("well formed");
        let points = table(&mut random, 3, 9, -2.0, 2.0);
        let multipliers = table(&mut random, 3, 9, -1.0, 1.0);
        let parameters = [random.between(-2.0, 2.0)];
        let compiled = compile(&graph, &symbols);
        check_machine_code(&graph, &symbols, &*compiled, &points, &parameters, &multipliers, 1e-11)
            .unwrap_or_else(|error| panic!("case {case}: {error}"));
    }
}

#[test]
fn deep_expressions_need_no_deep_stack() {
    let mut graph = Graph::new();
    let (x, one) = (graph.input(0), graph.number(1.0));
    let mut deep = x;
    for _ in 0..2000 {
        let sum = graph.add(one, deep);
        deep = graph.sqrt(sum);
    }
    let small_stack = std::thread::Builder::new().stack_size(256 * 1024);
    let text = small_stack.spawn(move || {
        let symbols = function(&mut graph, vec![deep], states_and_parameters(1, 0));
        compile(&graph, &symbols);
        print(&graph, &[("y".into(), deep)], &|_| "x".into())
    });
    assert!(text.expect("a thread").join().expect("no overflow").contains("y = sqrt("));
}

#[test]
fn machine_code_is_the_same_every_time() {
    let build = || {
        let mut graph = Graph::new();
        let outputs = random_expressions(&mut graph, &mut Random::new(7), 60);
        let symbols = function(&mut graph, outputs, states_and_parameters(3, 1));
        clif(&graph, &[symbols])
    };
    assert_eq!(build(), build());
}

/// Evaluates `builtin(operands)` without the graph's simplification.
fn meaning(builtin: Builtin, operands: &[f64]) -> f64 {
    (builtin.row().value)(operands)
}

#[test]
fn simplification_preserves_meaning() {
    let mut random = Random::new(8);
    for _ in 0..20_000 {
        let mut graph = Graph::new();
        let z: Vec<f64> = (0..3).map(|_| random.between(0.2, 0.9)).collect();
        let mut pool: Vec<(ExprId, f64)> =
            z.iter().enumerate().map(|(i, &x)| (graph.input(i as u32), x)).collect();
        pool.extend([-2.0, -1.0, 0.0, 0.5, 1.0].map(|number| (graph.number(number), number)));
        for _ in 0..8 {
            let builtin = builtins::ALL[random.below(builtins::ALL.len())];
            let operands: Vec<(ExprId, f64)> =
                (0..builtin.row().arity).map(|_| pool[random.below(pool.len())]).collect();
            let (ids, numbers): (Vec<ExprId>, Vec<f64>) = operands.into_iter().unzip();
            let expected = meaning(builtin, &numbers);
            if !expected.is_finite()
                || expected.abs() > 100.0
                || !builtin.row().domain.contains(&numbers)
            {
                continue;
            }
            let id = graph.call(builtin, &ids);
            let got = evaluate(&graph, &[id], &z, &[])[0];
            assert!(
                (got - expected).abs() <= 1e-9 * (1.0 + expected.abs()),
                "{} of {numbers:?}: {expected} became {got}",
                builtin.row().name
            );
            // From here on what was simplified counts, so that rounding does not add up.
            pool.push((id, got));
        }
    }
}

/// A branch that is not taken may be infinite or undefined, also in derivatives.
#[test]
fn derivatives_do_not_see_the_branch_not_taken() {
    let mut graph = Graph::new();
    let x = graph.input(0);
    let zero = graph.number(0.0);
    let root = graph.sqrt(x);
    let power = graph.mul(root, x);
    let guarded = graph.select_le(x, zero, zero, power);
    let doubled = graph.scale(2.0, guarded);
    let output = graph.sin(doubled);
    let symbols = function(&mut graph, vec![output], states_and_parameters(1, 0));
    let mut points = Columns::new(1, 3);
    points.column_mut(0).copy_from_slice(&[-1.0, 0.0, -0.5]);
    let mut multipliers = Columns::new(1, 3);
    multipliers.column_mut(0).fill(1.0);
    let results = derivatives(&*compile(&graph, &symbols), &points, &[], &multipliers);
    assert_eq!(results.jacobian.column(0), [0.0; 3]);
    assert_eq!(results.hessian.column(0), [0.0; 3]);
}

#[test]
fn degrees_are_those_of_polynomials_in_what_is_differentiated() {
    let mut graph = Graph::new();
    let (x, y, p) = (graph.input(0), graph.input(1), graph.input(2));
    let sine = graph.sin(p);
    let affine = graph.mul(sine, x);
    let quadratic = graph.mul(x, y);
    let bilinear_in_parameter = graph.mul(affine, p);
    let sine_of_state = graph.sin(x);
    let outputs = vec![affine, quadratic, bilinear_in_parameter, sine_of_state, p];
    let layout = Layout { x: 2, p: 1, ..Layout::default() };
    let origins = vec![Origin::default(); 5];
    let symbols = differentiate(
        &mut graph,
        VectorFunction {
            name: "degrees".into(),
            layout,
            outputs,
            origins,
            by: vec![0, 1],
            order: Order::Second,
        },
    );
    use Degree::{Affine, Nonlinear, Quadratic};
    assert_eq!(symbols.degrees, [Affine, Quadratic, Affine, Nonlinear, Affine]);
    assert_eq!(symbols.jacobian.0.entries, [(0, 0), (1, 0), (1, 1), (2, 0), (3, 0)]);
    assert_eq!(symbols.hessian.0.entries, [(0, 0), (1, 0)]);
}

#[test]
#[should_panic(expected = "columns of the Jacobian")]
fn a_table_of_the_wrong_size_is_refused() {
    let mut graph = Graph::new();
    let x = graph.input(0);
    let output = graph.sin(x);
    let symbols = function(&mut graph, vec![output], states_and_parameters(1, 0));
    let (points, mut values) = (Columns::new(1, 4), Columns::new(1, 4));
    compile(&graph, &symbols).jacobian(&points, &[], &mut values, &mut Columns::new(2, 4));
}
