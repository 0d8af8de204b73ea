//! Table 7.1: all ten rows, from the model and its own guess, judged by formulas written out by
//! hand.
//!
//! ```text
//! v+  = v  + h (a t(th) - muN S(n(th).v+) n(th))       S(z) = z / sqrt(z^2 + sigma^2)
//! x+  = x  + h v+                                       h = T/N
//! th+ = th + h s t(th).v+
//! t(th) = (cos th, sin th),  n(th) = (-sin th, cos th)
//! |y_k - y_cl(x_k)| <= w/2 for k = 1..N,  |a| <= 2,  |s| <= 2,  x_0 = v_0 = 0,  th_0 = 0
//! minimise  alpha |x_N - target|^2 + T
//! ```

use std::f64::consts::PI;

use fdcc_tests::models::load;
use fdcc_tests::{Solved, repository};
use serde_json::Value;

const MU_N: f64 = 1.0;
const WIDTH: f64 = 0.5;
const ALPHA: f64 = 10.0;
const LIMIT: f64 = 2.0;

/// A row of the table: the width of the layer, the number of steps, and the better of the two known
/// objectives.
struct Row {
    sigma: f64,
    steps: usize,
    objective: f64,
}

fn rows() -> Vec<Row> {
    let path = repository().join("tests/reference/table-7.1.json");
    let table: Value =
        serde_json::from_str(&std::fs::read_to_string(path).expect("the table is there"))
            .expect("JSON");
    let number = |row: &Value, key: &str| row[key].as_f64().expect("a number");
    let row = |row: &Value| Row {
        sigma: number(row, "sigma"),
        steps: number(row, "N") as usize,
        objective: number(row, "paper_objective").min(number(row, "ipopt_objective")),
    };
    table["rows"].as_array().expect("rows").iter().map(row).collect()
}

/// State and control of the car at one time.
#[derive(Clone, Copy)]
struct Car {
    x: f64,
    y: f64,
    vx: f64,
    vy: f64,
    th: f64,
    a: f64,
    s: f64,
}

/// The whole run, with its duration; the last control is held.
fn cars(solved: &Solved) -> (Vec<Car>, f64) {
    let [x, y, vx, vy, th] =
        ["pos.x", "pos.y", "vel.x", "vel.y", "th"].map(|name| solved.state(name));
    let [a, s] = ["a", "s"].map(|name| solved.control(name));
    let car = |k: usize| {
        let held = k.min(a.len() - 1);
        Car { x: x[k], y: y[k], vx: vx[k], vy: vy[k], th: th[k], a: a[held], s: s[held] }
    };
    ((0..x.len()).map(car).collect(), solved.value("T"))
}

fn centre_line(x: f64) -> f64 {
    match x {
        x if x <= PI => x.sin(),
        x if x <= 2.0 * PI => PI - x,
        x => -PI - x.sin(),
    }
}

/// By how much one step breaks the dynamics.
fn defect(from: &Car, to: &Car, h: f64, sigma: f64) -> f64 {
    let (sin, cos) = from.th.sin_cos();
    let (along, across) = (cos * to.vx + sin * to.vy, -sin * to.vx + cos * to.vy);
    let friction = -MU_N * across / (across * across + sigma * sigma).sqrt();
    let expected = [
        from.x + h * to.vx,
        from.y + h * to.vy,
        from.vx + h * (from.a * cos - friction * sin),
        from.vy + h * (from.a * sin + friction * cos),
        from.th + h * from.s * along,
    ];
    let got = [to.x, to.y, to.vx, to.vy, to.th];
    expected.iter().zip(got).map(|(expected, got)| (expected - got).abs()).fold(0.0, f64::max)
}

/// By how much anything at all is broken.
fn violation(run: &[Car], duration: f64, sigma: f64) -> f64 {
    let h = duration / (run.len() - 1) as f64;
    let Car { x, y, vx, vy, th, .. } = run[0];
    let start = [x, y, vx, vy, th].into_iter().map(f64::abs);
    let dynamics = run.windows(2).map(|pair| defect(&pair[0], &pair[1], h, sigma));
    let track = run[1..].iter().map(|car| (car.y - centre_line(car.x)).abs() - WIDTH / 2.0);
    let controls = run.iter().map(|car| car.a.abs().max(car.s.abs()) - LIMIT);
    let all: Vec<f64> = start.chain(dynamics).chain(track).chain(controls).collect();
    assert!(all.iter().all(|value| value.is_finite()));
    all.into_iter().fold(0.0, f64::max)
}

fn objective(run: &[Car], duration: f64) -> f64 {
    let last = run[run.len() - 1];
    ALPHA * ((last.x - 3.0 * PI).powi(2) + (last.y + PI).powi(2)) + duration
}

fn check(row: &Row) {
    let (sigma, steps) = (row.sigma.to_string(), row.steps.to_string());
    let solved = Solved::of(load("racecar", &[], &[("sigma", &sigma), ("N", &steps)]));
    let (run, duration) = cars(&solved);
    let what = format!("sigma {sigma}, N {steps}");
    assert_eq!(run.len(), row.steps + 1, "{what}");
    let (found, violation) = (objective(&run, duration), violation(&run, duration, row.sigma));
    assert!(
        (found - solved.objective()).abs() < 1e-10,
        "{what}: {found}, but it says {}",
        solved.objective()
    );
    assert!(found <= row.objective + 2e-5, "{what}: {found}, known {}", row.objective);
    assert!(violation <= 1e-8, "{what}: violated by {violation:e}");
}

#[test]
fn the_rows_with_the_widest_layer_are_as_good_as_the_better_known_objective() {
    let rows = rows();
    let wide: Vec<&Row> = rows.iter().filter(|row| row.sigma == 0.1).collect();
    assert_eq!(wide.len(), 4);
    wide.into_iter().for_each(check);
}

#[test]
fn the_rows_with_the_middle_layer_are_as_good_as_the_better_known_objective() {
    let rows = rows();
    let middle: Vec<&Row> = rows.iter().filter(|row| row.sigma == 0.05).collect();
    assert_eq!(middle.len(), 3);
    middle.into_iter().for_each(check);
}

#[test]
fn the_rows_with_the_narrowest_layer_are_as_good_as_the_better_known_objective() {
    let rows = rows();
    let narrow: Vec<&Row> = rows.iter().filter(|row| row.sigma == 0.025).collect();
    assert_eq!(narrow.len(), 3);
    narrow.into_iter().for_each(check);
}

#[test]
fn a_step_of_the_wrong_scheme_is_a_violation() {
    let text = fdcc_tests::models::text_of("racecar").replace(" lagged (th)", "");
    let solved = Solved::new(&text, &[], &[("N", "100")]);
    let (run, duration) = cars(&solved);
    assert!(violation(&run, duration, 0.1) > 1e-4);
}
