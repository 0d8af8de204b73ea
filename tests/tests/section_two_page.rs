//! The tables and figures of `docs/method/stepping.md`; what they claim is checked where it is
//! computed.

use fdcc_compiler::compile_sensitivities;
use fdcc_runtime::fixed_step::{Grid, step_through};
use fdcc_runtime::simulate::{Controls, System};
use fdcc_tests::models::meaning;
use fdcc_tests::pages::{check_file, check_tables};
use fdcc_tests::section_two::{
    exact, implicit_euler, inclusion, inclusion_to_the_end, objective, set, smoothed,
    smoothed_to_the_end, stepped,
};
use fdcc_tests::svg::{Axis, Figure};

const PAGE: &str = "docs/method/stepping.md";
const STEPS: [usize; 4] = [20, 40, 100, 200];
const WIDTHS: [f64; 6] = [0.1, 0.05, 0.02, 0.01, 0.005, 0.001];

type Rows = Vec<Vec<String>>;

/// `count` points of an interval, none of them where two steps meet.
fn starts(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..count).map(|k| low + (high - low) * (k as f64 + 0.37) / count as f64).collect()
}

#[test]
fn the_tables_are_what_is_computed() {
    check_tables(
        PAGE,
        &[
            ("one-start", one_start()),
            ("minima", minima()),
            ("shares", shares()),
            ("widths", widths()),
            ("chattering", chattering()),
        ],
    );
}

/// Values converge, derivatives do not.
fn one_start() -> Rows {
    let (mut system, truth) = (inclusion_to_the_end(), exact(-1.003));
    let mut rows = Vec::new();
    for steps in [20, 40, 100, 200] {
        let mut row = vec![format!("{}", 2.0 / steps as f64)];
        for theta in [0.0, 0.5, 0.75, 1.0] {
            let [value, slope] = objective(&mut system, -1.003, steps, theta);
            let h = 2.0 / steps as f64;
            assert!(
                (value - truth[0]).abs() < 5.0 * h && (slope - truth[1]).abs() > 0.4,
                "h = {h}, theta = {theta}"
            );
            row.extend([format!("{value:.4}"), format!("{slope:.4}")]);
        }
        rows.push(row);
    }
    let exact = [format!("{:.4}", truth[0]), format!("{:.4}", truth[1])];
    rows.push(
        [vec!["exact".to_owned()], [exact.clone(), exact.clone(), exact.clone(), exact].concat()]
            .concat(),
    );
    rows
}

/// How many local minima the computed objective has (the true one has one), and how far it is from
/// the true one.
fn minima() -> Rows {
    let mut system = inclusion();
    let known = [[4, 9, 24, 46], [5, 10, 24, 46], [5, 9, 23, 45]];
    let mut rows = Vec::new();
    for (theta, known) in [0.0, 0.5, 1.0].into_iter().zip(known) {
        let (mut counts, mut errors) = (Vec::new(), Vec::new());
        for (steps, known) in STEPS.into_iter().zip(known) {
            let starts = starts(-2.0, -0.6, 1400);
            let values: Vec<f64> =
                starts.iter().map(|x0| value(&mut system, *x0, steps, theta)).collect();
            let count = values.windows(3).filter(|v| v[1] < v[0] && v[1] < v[2]).count();
            let errors_here =
                starts.iter().zip(&values).map(|(x0, value)| (value - exact(*x0)[0]).abs());
            assert_eq!(count, known, "minima for theta = {theta}, {steps} steps");
            counts.push(count.to_string());
            errors.push(format!("{:.3}", errors_here.fold(0.0, f64::max)));
        }
        rows.push([vec![theta.to_string()], counts, errors].concat());
    }
    rows
}

/// `J_h` from the trapezoidal sum.
fn value(system: &mut System, x0: f64, steps: usize, theta: f64) -> f64 {
    set(system, &[("x0", x0)]);
    let stepped =
        step_through(system, &Controls::Guess, &Grid::theta(system, theta, steps)).expect("steps");
    let x = &stepped.states[0];
    let sum: f64 = x.windows(2).map(|x| (x[0] * x[0] + x[1] * x[1]) / steps as f64).sum();
    (x[steps] - 5.0 / 3.0).powi(2) + sum
}

/// The two derivatives of the end by the start, how often each occurs, and their mean: the true
/// derivative, 1/3.
fn shares() -> Rows {
    let mut system = inclusion_to_the_end();
    let mut rows = Vec::new();
    for theta in [0.25, 0.5, 0.75, 1.0] {
        // Four times what x moves by in a step.
        let slopes: Vec<f64> =
            starts(-1.12, -1.0, 120).iter().map(|x0| slope(&mut system, *x0, theta)).collect();
        let crossing = -(1.0 - theta) / theta;
        let is_crossing = |slope: &&f64| (**slope - crossing).abs() < 1e-9;
        let share = slopes.iter().filter(is_crossing).count() as f64 / 120.0;
        let mean = slopes.iter().sum::<f64>() / 120.0;
        assert!(
            (share - 2.0 * theta / 3.0).abs() < 1e-9 && (mean - 1.0 / 3.0).abs() < 1e-9,
            "theta = {theta}: {share}, {mean}"
        );
        assert!(slopes.iter().all(|slope| is_crossing(&slope) || (slope - 1.0).abs() < 1e-9));
        rows.push(vec![
            theta.to_string(),
            format!("{:.4}", crossing + 0.0),
            format!("{share:.4}"),
            format!("{mean:.4}"),
        ]);
    }
    rows
}

fn slope(system: &mut System, x0: f64, theta: f64) -> f64 {
    set(system, &[("x0", x0)]);
    stepped(system, &Grid::theta(system, theta, 200)).1.starts[0]
}

/// Smoothed: the derivative at -1, and what it varies in near it.
fn widths() -> Rows {
    let (mut whole, mut to_the_end) = (smoothed(), smoothed_to_the_end());
    let mut rows = Vec::new();
    let known = [
        (0.333_333_334, 0.648_310),
        (0.333_333_350, 0.615_584),
        (0.333_104_620, 0.595_613),
        (0.340_508_629, 0.610_027),
        (0.381_800_684, 0.721_040),
        (0.288_033, 0.458_495),
    ];
    for (sigma, known) in WIDTHS.into_iter().zip(known) {
        let width = [("sigma(zero)", sigma)];
        set(&mut whole, &width);
        set(&mut to_the_end, &width);
        let found = [slope(&mut to_the_end, -1.0, 1.0), implicit_euler(&mut whole, -1.0, 200)[1]];
        assert!(
            (found[0] - known.0).abs() < 1e-6 && (found[1] - known.1).abs() < 1e-6,
            "sigma = {sigma}: {found:?}"
        );
        let near: Vec<f64> =
            starts(-1.1, -0.9, 100).iter().map(|x0| slope(&mut to_the_end, *x0, 1.0)).collect();
        let (least, most) =
            near.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), s| (l.min(*s), m.max(*s)));
        rows.push(
            [
                sigma.to_string(),
                format!("{:.2}", 0.01 / sigma),
                format!("{:.6}", found[0]),
                format!("{least:.3} to {most:.3}"),
                format!("{:.6}", found[1]),
            ]
            .to_vec(),
        );
    }
    rows
}

const FRICTION: &str = "model friction time t in [0, 9] state x start 1 surface zero = x dynamics \
                        { x' in -Sgn(zero) }";

fn friction(theta: f64) -> [Vec<f64>; 2] {
    let system = compile_sensitivities(&meaning(FRICTION)).expect("the model can be simulated");
    let mut stepped =
        step_through(&system, &Controls::Guess, &Grid::theta(&system, theta, 300)).expect("steps");
    [stepped.time, stepped.states.remove(0)]
}

/// `x' in -Sgn(x)` from 1 with steps of 0.03: what is left after 300 of them.
fn chattering() -> Rows {
    let mut rows = Vec::new();
    for (theta, known) in [
        (0.0, 0.02),
        (0.1, 0.02),
        (0.25, 0.02),
        (0.4, 0.015),
        (0.5, 0.01),
        (0.6, 0.0),
        (0.75, 0.0),
        (0.9, 0.0),
        (1.0, 0.0),
    ] {
        let [_, x] = friction(theta);
        let (last, left) = (&x[299..], x[299].abs().max(x[300].abs()));
        assert!((left - known).abs() < 1e-12, "theta = {theta}: {last:?}");
        rows.push(vec![
            theta.to_string(),
            last.iter()
                .map(|x| format!("{:.3}", if x.abs() < 1e-12 { 0.0 } else { *x }))
                .collect::<Vec<_>>()
                .join(", "),
        ]);
    }
    rows
}

/// Values and derivatives over the start, as two curves.
fn curves(points: &[f64], mut both: impl FnMut(f64) -> [f64; 2]) -> [Vec<[f64; 2]>; 2] {
    let found: Vec<[f64; 2]> = points.iter().map(|x0| both(*x0)).collect();
    [0, 1].map(|part| points.iter().zip(&found).map(|(x0, both)| [*x0, both[part]]).collect())
}

fn figures(points: &[f64]) -> [Figure; 2] {
    let [values, slopes] = curves(points, exact);
    let figure = |label: &str| Figure::new(Axis::new("x0"), Axis::new(label));
    [figure("J").line("exact", &values), figure("dJ/dx0").line("exact", &slopes)]
}

fn check_figures(name: &str, [values, slopes]: [Figure; 2]) {
    check_file(&format!("docs/method/figures/{name}.svg"), &values.svg());
    check_file(&format!("docs/method/figures/{name}-gradient.svg"), &slopes.svg());
}

#[test]
fn figure_2_1_is_what_is_computed() {
    let (mut system, points) = (inclusion(), starts(-1.6, -0.6, 400));
    let [mut values, mut slopes] = figures(&points);
    for steps in STEPS {
        let name = format!("h = {}", 2.0 / steps as f64);
        let found = curves(&points, |x0| implicit_euler(&mut system, x0, steps));
        values = values.line(&name, &found[0]);
        // Two step sizes show that the jumps stay.
        if steps == 40 || steps == 200 {
            slopes = slopes.dots(&name, &found[1]);
        }
    }
    check_figures("figure-2.1", [values, slopes]);
}

#[test]
fn figure_2_2_is_what_is_computed() {
    let (mut system, points) = (smoothed(), starts(-1.1, -0.9, 201));
    let [mut values, mut slopes] = figures(&points);
    for sigma in WIDTHS {
        set(&mut system, &[("sigma(zero)", sigma)]);
        let found = curves(&points, |x0| implicit_euler(&mut system, x0, 200));
        let name = format!("sigma = {sigma}");
        values = values.line(&name, &found[0]);
        slopes = slopes.line(&name, &found[1]);
    }
    check_figures("figure-2.2", [values, slopes]);
}

#[test]
fn the_figure_of_chattering_is_what_is_computed() {
    let mut figure =
        Figure::new(Axis::new("t").between(0.9, 1.5), Axis::new("x").between(-0.03, 0.05));
    for theta in [0.0, 0.4, 0.5, 0.6, 1.0] {
        let [time, x] = friction(theta);
        let points: Vec<[f64; 2]> = time.into_iter().zip(x).map(|(t, x)| [t, x]).collect();
        figure = figure.line(&format!("theta = {theta}"), &points);
    }
    check_file("docs/method/figures/chattering.svg", &figure.svg());
}
