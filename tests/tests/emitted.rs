//! The functions that `emit` writes as C are those of the machine code: to the bit where no
//! function of libm enters, else to 1e-14. Skipped with a word where there is no C compiler.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;

use fdcc_compiler::{Model, compile_chain, emit_c, with_times};
use fdcc_grammar::Code;
use fdcc_runtime::linalg::is_fused;
use fdcc_runtime::problem::{Columns, Function, Problem};
use fdcc_tests::functions::derivatives;
use fdcc_tests::models::{changed, meaning, text_of};
use fdcc_tests::random::Random;
use fdcc_tests::repository;
use fdcc_tests::symbols::table;

const POINTS: usize = 24;

/// What functions of libm may differ by, relative, in any entry.
const OF_LIBM: f64 = 1e-14;

fn compiler() -> Option<&'static str> {
    let runs = |name: &&str| Command::new(name).arg("--version").output().is_ok();
    let found = ["cc", "gcc", "clang"].into_iter().find(runs);
    if found.is_none() {
        eprintln!("skipped: there is no C compiler");
    }
    found
}

/// A function of a problem with its name in C.
type Named = (String, Arc<dyn Function>);

fn of_problem(name: &str, problem: &Problem) -> Vec<Named> {
    let own = [
        ("dynamics", &problem.dynamics),
        ("path", &problem.path),
        ("boundary", &problem.boundary),
        ("guess", &problem.guess),
        ("interval", &problem.interval),
        ("switching", &problem.switching),
        ("report", &problem.report),
    ];
    let own = own.map(|(of, function)| (format!("{name}_{of}"), Arc::clone(function)));
    let sums = problem.measurements.iter().enumerate();
    let sums = sums.map(|(at, it)| (format!("{name}_sum{}", at + 1), Arc::clone(&it.function)));
    own.into_iter().chain(sums).filter(|it| it.1.outputs() > 0).collect()
}

/// All functions of a model, as machine code.
fn functions(model: &Model) -> Vec<Named> {
    let chain = compile_chain(model).expect("the model can be solved");
    if model.phases.is_empty() {
        return of_problem(&model.name, &chain.phases[0]);
    }
    let phases = model.phases.iter().zip(&chain.phases);
    let of = |(phase, problem): (&fdcc_compiler::Phase, &Problem)| {
        let own = phase.place.name.replace(' ', "_");
        of_problem(&format!("{}_{own}", model.name), problem)
    };
    let links = chain.links.iter().enumerate();
    let links =
        links.map(|(at, it)| (format!("{}_link{}", model.name, at + 1), Arc::clone(&it.function)));
    phases.flat_map(of).chain(links).collect()
}

fn sizes(function: &dyn Function) -> [usize; 6] {
    let layout = function.layout();
    let [jacobian, hessian] = [function.jacobian_pattern(), function.hessian_pattern()];
    let entries = [jacobian.entries.len(), hessian.entries.len()];
    let outputs = function.outputs();
    [layout.point_inputs(), layout.p, outputs, outputs, entries[0], entries[1]]
}

/// Whether a file has derivatives of a function.
fn is_differentiated(text: &str, name: &str) -> bool {
    text.contains(&format!("void {name}_jacobian("))
}

/// Compiles a file with a program behind it, as strictly as the compiler can.
fn build(compiler: &str, name: &str, text: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let (source, program) = (folder.join(format!("{name}.c")), folder.join(name));
    fs::write(&source, text).expect("the folder can be written to");
    let mut command = Command::new(compiler);
    command.args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off"]);
    if cfg!(target_arch = "x86_64") && !is_fused() {
        command.arg("-DFDCC_FMA(a,b,c)=((a)*(b)+(c))");
    }
    let output = command.arg("-O1").arg(&source).arg("-o").arg(&program).arg("-lm").output();
    let output = output.expect("the compiler runs");
    assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    program
}

/// Runs a program on numbers.
fn run(program: &Path, numbers: &[f64]) -> Vec<f64> {
    let mut command = Command::new(program);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it runs");
    let mut stream = child.stdin.take().expect("it is a pipe");
    let bytes: Vec<u8> = numbers.iter().flat_map(|it| it.to_ne_bytes()).collect();
    let writer = std::thread::spawn(move || stream.write_all(&bytes));
    let output = child.wait_with_output().expect("it ends");
    writer.join().expect("no panic").expect("the program reads everything");
    assert!(output.status.success(), "{}: {:?}", program.display(), output.status);
    let number = |bytes: &[u8]| f64::from_ne_bytes(bytes.try_into().expect("eight bytes"));
    output.stdout.chunks_exact(size_of::<f64>()).map(number).collect()
}

/// What a function is called with, and what the machine code says of it, call by call.
struct Trial {
    points: Columns,
    parameters: Vec<f64>,
    multipliers: Columns,
    /// For values, for the Jacobian and for everything: tables one after the other.
    tables: Vec<Columns>,
}

impl Trial {
    fn new(random: &mut Random, function: &dyn Function, is_differentiated: bool) -> Self {
        let layout = function.layout();
        (0..3).for_each(|order| function.prepare(order));
        let points = table(random, layout.point_inputs(), POINTS, -1.5, 1.5);
        let parameters: Vec<f64> = (0..layout.p).map(|_| random.between(0.2, 1.8)).collect();
        let multipliers = table(random, function.outputs(), POINTS, -1.0, 1.0);
        let mut values = Columns::new(function.outputs(), POINTS);
        function.value(&points, &parameters, &mut values);
        let mut tables = vec![values.clone()];
        if is_differentiated {
            let mut jacobian = Columns::new(function.jacobian_pattern().entries.len(), POINTS);
            function.jacobian(&points, &parameters, &mut values, &mut jacobian);
            let all = derivatives(function, &points, &parameters, &multipliers);
            tables.extend([values, jacobian, all.values, all.jacobian, all.hessian]);
        }
        Trial { points, parameters, multipliers, tables }
    }

    fn at(table: &Columns, point: usize) -> impl Iterator<Item = f64> {
        (0..table.columns()).map(move |column| table.column(column)[point])
    }

    /// What the program reads for a point.
    fn inputs(&self, point: usize) -> Vec<f64> {
        let parameters = self.parameters.iter().copied();
        let points = Self::at(&self.points, point).chain(parameters);
        points.chain(Self::at(&self.multipliers, point)).collect()
    }
}

/// The largest relative difference of the entries of a table.
fn difference(wanted: &[f64], found: &[f64]) -> f64 {
    let of = |(wanted, found): (&f64, &f64)| match wanted {
        _ if wanted.to_bits() == found.to_bits() || (wanted.is_nan() && found.is_nan()) => 0.0,
        _ => (wanted - found).abs() / wanted.abs(),
    };
    // What is no number is the largest.
    wanted.iter().zip(found).map(of).fold(0.0, |most, it| if most >= it { most } else { it })
}

/// Whether the kernels of a function call libm for more than a square root.
fn calls_libm(text: &str, name: &str) -> bool {
    let library = ["sin", "cos", "tan", "exp", "log", "pow", "sinh", "cosh", "tanh", "atan2"];
    let more = ["asin", "acos", "atan", "fdcc_log_cosh"];
    let of = |kernel: &str| {
        let head = format!("void {name}_{kernel}(");
        let body = text.split_once(&head).and_then(|it| it.1.split_once("\n}\n"));
        let calls = |it: &&str| body.is_some_and(|body| body.0.contains(&format!(" {it}(")));
        library.iter().chain(&more).any(calls)
    };
    ["value", "jacobian", "hessian"].into_iter().any(of)
}

/// The largest difference of all functions of a model where libm is called.
fn compare(name: &str, model: &Model, of_libm: f64) -> Option<f64> {
    let compiler = compiler()?;
    let text = emit_c(model).expect("it can be written");
    let functions = functions(model);
    let mut random = Random::new(21);
    let mut trials = Vec::new();
    let mut calls = String::new();
    for (name, function) in &functions {
        let is_differentiated = is_differentiated(&text, name);
        trials.push(Trial::new(&mut random, &**function, is_differentiated));
        let [z, p, l, y, j, h] = sizes(&**function);
        calls += &match is_differentiated {
            true => format!(" DERIVATIVES({name}, {z}, {p}, {l}, {y}, {j}, {h})"),
            false => format!(" VALUES({name}, {z}, {p}, {l}, {y})"),
        };
    }
    let driver = include_str!("emitted/kernels.c");
    let program = format!("{text}\n#define POINTS {POINTS}\n#define CALLS{calls}\n{driver}");
    let program = build(compiler, &format!("emitted_{name}"), &program);
    let inputs = (0..POINTS).flat_map(|point| trials.iter().flat_map(move |it| it.inputs(point)));
    let found = run(&program, &inputs.collect::<Vec<f64>>());
    let mut found = found.into_iter();
    let (mut worst, mut finite): (f64, usize) = (0.0, 0);
    for point in 0..POINTS {
        for ((of, _), trial) in functions.iter().zip(&trials) {
            for (which, table) in trial.tables.iter().enumerate() {
                let wanted: Vec<f64> = Trial::at(table, point).collect();
                let got: Vec<f64> = found.by_ref().take(wanted.len()).collect();
                assert_eq!(got.len(), wanted.len(), "{of}: the program wrote too little");
                finite += wanted.iter().filter(|it| it.is_finite()).count();
                let difference = difference(&wanted, &got);
                let allowed = if calls_libm(&text, of) { of_libm } else { 0.0 };
                let head = format!("{of}, table {which}, point {point}: {difference:e}");
                assert!(difference <= allowed, "{head}\n{wanted:?}\n{got:?}");
                worst = worst.max(difference);
            }
        }
    }
    assert_eq!(found.next(), None, "{name}: the program wrote too much");
    assert!(finite > POINTS, "{name}: hardly any number is finite");
    Some(worst)
}

/// What CasADi calls of each differentiated function.
fn check_interface(name: &str, model: &Model) {
    let Some(compiler) = compiler() else { return };
    let text = emit_c(model).expect("it can be written");
    let names = functions(model).into_iter().map(|it| it.0);
    let names = names.filter(|name| is_differentiated(&text, name));
    let checks: String = names.map(|name| format!(" CHECK({name})")).collect();
    let driver = include_str!("emitted/interface.c");
    let program = build(
        compiler,
        &format!("called_{name}"),
        &format!("{text}\n#define CHECKS{checks}\n{driver}"),
    );
    let output = Command::new(program).output().expect("it runs");
    let words = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{name}: {:?}\n{words}", output.status);
}

/// The models of `models/` without jumps.
fn examples() -> Vec<(String, Model)> {
    let files = fs::read_dir(repository().join("models")).expect("there are models");
    let paths = files.map(|it| it.expect("a file").path());
    let names = paths.filter(|it| it.extension().is_some_and(|it| it == "fdc"));
    let mut names: Vec<String> =
        names.filter_map(|it| Some(it.file_stem()?.to_string_lossy().into_owned())).collect();
    names.sort();
    let model = |name: String| (meaning(&text_of(&name)), name);
    let all = names.into_iter().map(model).filter(|it| it.0.jumps.is_empty());
    all.map(|(model, name)| (name, model)).collect()
}

#[test]
fn the_functions_of_all_examples_are_those_of_the_machine_code() {
    for (name, model) in examples() {
        let Some(worst) = compare(&name, &model, OF_LIBM) else { return };
        println!("{name}: {worst:e}");
    }
}

#[test]
fn casadi_gets_the_derivatives_of_all_examples() {
    for (name, model) in examples() {
        check_interface(&name, &model);
    }
}

/// A row for each function of the language, and formulas that only the compiler writes.
const EVERYTHING: &str = "model everything
param a = 0.3
param b = 0.7
free T in [0.5, 2] guess 1
time t in [0, T]
state x start 0.5
state y start 0.5
control u in [-1, 1]
dynamics {
  x' = sin(x) * cos(y) + tan(0.3 * u) + exp(-x) + tanh(y * u) + abs(x * y) / (1 + u^2)
  y' = sinh(x) - cosh(y) + atan(x) + atan2(y, 2 + x) + asin(0.1 * x) + acos(0.1 * y) + t * u
}
path 0 <= log(3 + x) + (3 + y)^a + sqrt(2 + u * u) + min(x, y) - max(x, u) <= 9
end x * y + b * T == 1
minimize integral(u^2 + exp(x)) + x(end)^2
report { twice = 2 * x }
method { sigma = 0.1 kernel = tanh }
";

#[test]
fn every_function_of_the_language_is_written() {
    let model = meaning(EVERYTHING);
    // `1 - tanh(u)^2` cancels a digit.
    compare("everything", &model, 10.0 * OF_LIBM);
    check_interface("everything", &model);
}

#[test]
fn right_sides_do_not_depend_on_the_scheme() {
    let of = |scheme: &str| {
        let model = changed(&text_of("block"), &[], &[("scheme", scheme)]);
        emit_c(&model).expect("it can be written")
    };
    assert_eq!(of("rk4"), of("implicit_euler"));
}

#[test]
fn conditions_at_times_divide_a_model_into_phases() {
    let text = "model between
param place = 0.4
free tm in [0.2, 0.8] guess 0.5
time t in [0, 1]
state x start 0
control u in [-9, 9]
dynamics { x' = u * cos(x) }
at tm: x == place
end x == 1
minimize integral(u^2)
";
    let model = with_times(&meaning(text)).expect("the time is inside");
    assert_eq!(emit_c(&model), emit_c(&meaning(text)));
    compare("between", &model, OF_LIBM);
    check_interface("between", &model);
}

#[test]
fn what_cannot_be_written_is_told() {
    let found = emit_c(&meaning(&text_of("bounce"))).expect_err("it has jumps");
    assert_eq!(found[0].code, Code::NotYet);
    assert!(found[0].message.contains("jumps"), "{found:?}");
}
