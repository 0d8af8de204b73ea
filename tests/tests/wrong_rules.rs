//! What the printed rules would give: the adjoint (5.9) without its transpose, the projections
//! (6.13) with `u u^T` and with the normal, beside the right ones, on examples (c) and (d), whose
//! numbers come from the reference problems.
//!
//! Written by hand in a few lines, so that the difference stays visible; and the costates of the
//! program in the gauge of the limit of smoothed adjoints.

use fdcc_compiler::compile_sensitivities;
use fdcc_runtime::sensitivity::{Costates, gradient};
use fdcc_runtime::simulate::{Controls, Options};
use fdcc_tests::models::meaning;
use fdcc_tests::repository;

type Vector = [f64; 2];
type Matrix = [Vector; 2];

const UNIT: Matrix = [[1.0, 0.0], [0.0, 1.0]];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn times(a: Matrix, b: Matrix) -> Matrix {
    let column = |j| [b[0][j], b[1][j]];
    [0, 1].map(|i| [0, 1].map(|j| dot(a[i], column(j))))
}

/// `M + factor * column row`.
fn plus(m: Matrix, column: Vector, row: Vector, factor: f64) -> Matrix {
    [0, 1].map(|i| [0, 1].map(|j| m[i][j] + factor * column[i] * row[j]))
}

fn transposed(m: Matrix) -> Matrix {
    [0, 1].map(|i| [m[0][i], m[1][i]])
}

fn apply(m: Matrix, v: Vector) -> Vector {
    m.map(|row| dot(row, v))
}

/// State and derivative after `x' = f(x)`, `S' = f_x S`, by the classical Runge-Kutta method with
/// 4000 steps.
fn flow(
    mut x: Vector,
    mut s: Matrix,
    time: f64,
    f: impl Fn(Vector) -> (Vector, Matrix),
) -> (Vector, Matrix) {
    let h = time / 4000.0;
    let moved = |x: Vector, k: Vector, h: f64| [0, 1].map(|i| x[i] + h * k[i]);
    let moved_all = |s: Matrix, k: Matrix, h: f64| [0, 1].map(|i| moved(s[i], k[i], h));
    let rate = |x, s| {
        let (rate, slope) = f(x);
        (rate, times(slope, s))
    };
    for _ in 0..4000 {
        let (k1, l1) = rate(x, s);
        let (k2, l2) = rate(moved(x, k1, h / 2.0), moved_all(s, l1, h / 2.0));
        let (k3, l3) = rate(moved(x, k2, h / 2.0), moved_all(s, l2, h / 2.0));
        let (k4, l4) = rate(moved(x, k3, h), moved_all(s, l3, h));
        for i in 0..2 {
            x[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            for j in 0..2 {
                s[i][j] += h / 6.0 * (l1[i][j] + 2.0 * l2[i][j] + 2.0 * l3[i][j] + l4[i][j]);
            }
        }
    }
    (x, s)
}

#[track_caller]
fn near(got: Vector, expected: Vector) {
    let error = (0..2).map(|i| (got[i] - expected[i]).abs()).fold(0.0, f64::max);
    assert!(error < 1e-9, "{got:?}, not {expected:?}");
}

/// `lambda(0)` of (c) for `x(T)`, where the jump at the event is `lambda- = jump(f2 - f1, d, g1)
/// lambda+`.
fn adjoint_of_c(jump: impl Fn(Vector, Vector, f64) -> Matrix) -> Vector {
    let below = |[x, y]: Vector| ([1.0 + y / 4.0, 0.5 - x * y], [[0.0, 0.25], [-y, -x]]);
    let above = |[_, y]: Vector, x: f64| {
        ([0.5 - y * y / 4.0, -x + y / 2.0], [[0.0, -y / 2.0], [-1.0, 0.5]])
    };
    let event = 0.819094105236721;
    let (x, before) = flow([0.0, 0.2], UNIT, event, below);
    let (_, after) = flow(x, UNIT, 2.0 - event, |x| above(x, x[0]));
    let (first, second, normal) = (below(x).0, above(x, x[0]).0, [1.0, x[1]]);
    let difference = [second[0] - first[0], second[1] - first[1]];
    let lambda = apply(jump(difference, normal, dot(normal, first)), after[0]);
    apply(transposed(before), lambda)
}

#[test]
fn the_adjoint_jumps_with_the_transpose() {
    let right = adjoint_of_c(|difference, normal, g| plus(UNIT, normal, difference, 1.0 / g));
    near(right, [0.2437264049929583, -0.020382299484995238]);
    let printed = adjoint_of_c(|difference, normal, g| plus(UNIT, difference, normal, 1.0 / g));
    near(printed, [0.3852167811301185, -0.2166180944892755]);
}

/// `dx(4)/dx(0)` of (d), with a projection `P(u, d)` at the entry into sliding; `u = f2 - f1 = (1,
/// -2)`. On the arc `sin p + 2 cos p - t` is constant, and `x(4)` is this constant and a number.
fn sliding_of_d(projection: impl Fn(Vector, Vector) -> Matrix) -> Vector {
    let (entry, tangent) = ([-0.3, 0.91_f64.sqrt()], [-(0.91_f64.sqrt()), -0.3]);
    let along = apply(transposed(projection([1.0, -2.0], entry)), tangent);
    along.map(|part| part * dot([2.0, 1.0], tangent))
}

#[test]
fn the_projection_is_oblique() {
    let right = sliding_of_d(|u, d| plus(UNIT, u, d, -1.0 / dot(u, d)));
    near(right, [2.0, 1.0]);
    let printed = sliding_of_d(|u, _| plus(UNIT, u, u, -1.0 / dot(u, u)));
    near(printed, [1.9498908166801339, 0.9749454083400669]);
    let normal = sliding_of_d(|_, d| plus(UNIT, d, d, -1.0 / dot(d, d)));
    near(normal, [2.1061817604250836, 0.6623635208501674]);
}

/// The costates of a model of `tests/simulations/` for `x(end)`.
fn costates(name: &str) -> Costates {
    let path = repository().join("tests/simulations").join(name).with_extension("fdc");
    let text = std::fs::read_to_string(path).expect("the model");
    let system = compile_sensitivities(&meaning(&format!("{text}\nminimize x(end)\n")));
    let system = system.expect("the model can be simulated");
    gradient(&system, &Controls::Guess, &Options::default(), &[])
        .expect("it reaches the end")
        .costates
}

/// Between two times.
fn between(costates: &Costates, first: f64, last: f64) -> Vec<Vector> {
    let times = costates.time.iter().enumerate().filter(|(_, time)| (first..last).contains(*time));
    times.map(|(at, _)| [0, 1].map(|state| costates.columns[state][at])).collect()
}

#[test]
fn the_costate_on_a_sliding_arc_jumps_at_the_exit_and_not_at_the_entry() {
    let costates = costates("circle");
    let sides = [(0.0, 2.5213, [2.0, 1.0]), (2.5214, 4.1, [1.0, 0.0])];
    for (first, last, expected) in sides {
        let found = between(&costates, first, last);
        assert!(!found.is_empty());
        found.into_iter().for_each(|lambda| near(lambda, expected));
    }
}

#[test]
fn the_costate_jumps_at_a_crossing() {
    let found = between(&costates("curved"), 0.8190941052, 0.8190941053);
    let [first, .., last] = found.as_slice() else { panic!("two entries at the event") };
    near(*first, [0.227397246176965, -0.09188234350817528]);
    near(*last, [0.8216020155803174, 0.18304772370450603]);
}
