//! Time for each point of the race car's dynamics, and to compile all functions of a model of its
//! size.
//!
//! `cargo bench -p fdcc-tests --bench evaluation`; the column "item/s" counts points.

use std::sync::Arc;

use divan::{Bencher, black_box, counter::ItemsCount};
use fdcc_compiler::differentiate::Differentiated;
use fdcc_compiler::differentiate::differentiate;
use fdcc_compiler::generate::generate;
use fdcc_compiler::graph::{ExprId, Graph};
use fdcc_compiler::kernels;
use fdcc_compiler::lower::{Order, VectorFunction};
use fdcc_runtime::problem::{Columns, Function, Layout, Origin};

const POINTS: usize = 1000;
/// `[t | x: pos.x pos.y vel.x vel.y th | u: a s | p: muN w T sigma]`
const LAYOUT: Layout = Layout { t: 1, x: 5, u: 2, p: 4, s: 0 };
const PARAMETERS: [f64; 4] = [1.0, 0.5, 6.0, 0.1];
/// States, controls and T.
const BY: [u32; 8] = [1, 2, 3, 4, 5, 6, 7, 10];

fn main() {
    divan::main();
}

fn inputs(graph: &mut Graph) -> [ExprId; 12] {
    std::array::from_fn(|position| graph.input(position as u32))
}

/// The right side of `racecar.fdc` over normalised time, with the friction smoothed.
fn dynamics(g: &mut Graph, kernel: &str) -> VectorFunction {
    let [_, _, _, vx, vy, th, a, s, mu, _, duration, sigma] = inputs(g);
    let (sine, cosine) = (g.sin(th), g.cos(th));
    let (slip, along) = velocities(g, vx, vy, sine, cosine);
    let kernel = kernels::find(kernel).expect("a kernel of the table");
    let step = kernels::step(g, kernel, slip, sigma);
    let friction = g.mul(mu, step);
    let (throttle_x, throttle_y) = (g.mul(a, cosine), g.mul(a, sine));
    let (friction_x, friction_y) = (g.mul(friction, sine), g.mul(friction, cosine));
    let rates =
        [vx, vy, g.add(throttle_x, friction_x), g.sub(throttle_y, friction_y), g.mul(s, along)];
    function("dynamics", rates.map(|rate| g.mul(duration, rate)).to_vec(), &BY)
}

/// Across and along the car.
fn velocities(
    g: &mut Graph,
    vx: ExprId,
    vy: ExprId,
    sine: ExprId,
    cosine: ExprId,
) -> (ExprId, ExprId) {
    let [a, b, c, d] = [g.mul(cosine, vy), g.mul(sine, vx), g.mul(cosine, vx), g.mul(sine, vy)];
    (g.sub(a, b), g.add(c, d))
}

/// Distance from the centre line, which is a sine, a straight line and a sine.
fn track(g: &mut Graph) -> VectorFunction {
    let [_, x, y, ..] = inputs(g);
    let sine = g.sin(x);
    let [pi, two_pi, minus_pi] = [1.0, 2.0, -1.0].map(|k| g.number(k * std::f64::consts::PI));
    let (straight, second) = (g.sub(pi, x), g.sub(minus_pi, sine));
    let rest = g.select_le(x, two_pi, straight, second);
    let centre = g.select_le(x, pi, sine, rest);
    let distance = g.sub(y, centre);
    function("path", vec![distance], &BY)
}

/// Objective and end conditions, over both ends; guess and interval, over time and parameters
/// alone.
fn once(g: &mut Graph) -> Vec<VectorFunction> {
    let ends = Layout { x: 10, p: 4, ..Layout::default() };
    let [x, y, duration] = [5, 6, 12].map(|input| g.input(input));
    let target = [3.0, -1.0].map(|k| g.number(k * std::f64::consts::PI));
    let (dx, dy) = (g.sub(x, target[0]), g.sub(y, target[1]));
    let (dx2, dy2) = (g.square(dx), g.square(dy));
    let distance2 = g.add(dx2, dy2);
    let penalty = g.scale(10.0, distance2);
    let objective = g.add(penalty, duration);
    let mut outputs = vec![objective];
    outputs.extend((0..5).map(|input| g.input(input)));
    let by: Vec<u32> = (0..10).chain([12]).collect();
    let boundary = VectorFunction { layout: ends, ..function("boundary", outputs, &by) };
    let [tau, x] = [0, 1].map(|input| g.input(input));
    let slope = g.cos(x);
    let angle = g.atan2(slope, tau);
    let guess = function("guess", vec![x, slope, angle], &[]);
    let zero = g.number(0.0);
    vec![boundary, guess, function("interval", vec![zero, duration], &[])]
}

fn guards_and_report(g: &mut Graph) -> Vec<VectorFunction> {
    let [_, _, _, vx, vy, th, ..] = inputs(g);
    let (sine, cosine) = (g.sin(th), g.cos(th));
    let (slip, along) = velocities(g, vx, vy, sine, cosine);
    let angle = g.atan2(vy, vx);
    vec![function("switching", vec![slip], &[]), function("report", vec![slip, along, angle], &[])]
}

fn function(name: &str, outputs: Vec<ExprId>, by: &[u32]) -> VectorFunction {
    let origins = vec![Origin::default(); outputs.len()];
    VectorFunction {
        name: name.into(),
        layout: LAYOUT,
        outputs,
        origins,
        by: by.to_vec(),
        order: Order::Second,
    }
}

fn all_functions(graph: &mut Graph) -> Vec<Differentiated> {
    let mut functions = vec![dynamics(graph, "sqrt"), track(graph)];
    functions.extend(once(graph));
    functions.extend(guards_and_report(graph));
    functions.into_iter().map(|function| differentiate(graph, function)).collect()
}

struct Case {
    function: Arc<dyn Function>,
    points: Columns,
    multipliers: Columns,
    tables: [Columns; 3],
}

fn case(kernel: &str) -> Case {
    let mut graph = Graph::new();
    let function = dynamics(&mut graph, kernel);
    let function = differentiate(&mut graph, function);
    let function = generate(graph.clone(), vec![function]).remove(0);
    (0..3).for_each(|order| function.prepare(order));
    let mut points = Columns::new(LAYOUT.point_inputs(), POINTS);
    for column in 0..points.columns() {
        for (point, value) in points.column_mut(column).iter_mut().enumerate() {
            *value = (0.37 * (column * POINTS + point) as f64).sin();
        }
    }
    let mut multipliers = Columns::new(function.outputs(), POINTS);
    multipliers.as_mut_slice().fill(0.7);
    let sizes = [
        function.outputs(),
        function.jacobian_pattern().entries.len(),
        function.hessian_pattern().entries.len(),
    ];
    Case {
        function,
        points,
        multipliers,
        tables: sizes.map(|columns| Columns::new(columns, POINTS)),
    }
}

const SMOOTHING: [&str; 3] = ["sqrt", "tanh", "cubic"];

#[divan::bench(args = SMOOTHING)]
fn values(bencher: Bencher, kernel: &str) {
    let Case { function, points, tables: [mut values, ..], .. } = case(kernel);
    bencher
        .counter(ItemsCount::new(POINTS))
        .bench_local(|| function.value(black_box(&points), &PARAMETERS, &mut values));
}

#[divan::bench(args = SMOOTHING)]
fn values_and_jacobian(bencher: Bencher, kernel: &str) {
    let Case { function, points, tables: [mut values, mut jacobian, _], .. } = case(kernel);
    bencher.counter(ItemsCount::new(POINTS)).bench_local(|| {
        function.jacobian(black_box(&points), &PARAMETERS, &mut values, &mut jacobian)
    });
}

#[divan::bench(args = SMOOTHING)]
fn values_jacobian_and_hessian(bencher: Bencher, kernel: &str) {
    let Case { function, points, multipliers, tables: [mut values, mut jacobian, mut hessian] } =
        case(kernel);
    bencher.counter(ItemsCount::new(POINTS)).bench_local(|| {
        function.derivatives(
            black_box(&points),
            &PARAMETERS,
            &multipliers,
            &mut values,
            &mut jacobian,
            &mut hessian,
        );
    });
}

#[divan::bench]
fn symbols(bencher: Bencher) {
    bencher.bench_local(|| all_functions(&mut Graph::new()));
}

#[divan::bench]
fn symbols_to_machine_code(bencher: Bencher) {
    bencher.bench_local(|| {
        let mut graph = Graph::new();
        let functions = all_functions(&mut graph);
        generate(graph.clone(), functions)
    });
}
