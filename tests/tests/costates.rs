//! The tables and figures of `docs/method/costate.md`: costates of the true system, with their
//! jumps, and the smoothed ones that converge to them.

use std::f64::consts::SQRT_2;

use fdcc_compiler::compile_sensitivities;
use fdcc_runtime::sensitivity::{Costates, gradient};
use fdcc_runtime::simulate::{Controls, Options, simulate};
use fdcc_tests::Solved;
use fdcc_tests::models::{changed, load, text_of};
use fdcc_tests::pages::{check_file, check_tables};
use fdcc_tests::planar::{Smoothed, costates, exact, simulated};
use fdcc_tests::svg::{Axis, Figure};

type Rows = Vec<Vec<String>>;

#[track_caller]
fn near(found: [f64; 2], known: [f64; 2], tolerance: f64) {
    let error = (0..2).map(|i| (found[i] - known[i]).abs()).fold(0.0, f64::max);
    assert!(error < tolerance, "{found:?}, not {known:?}");
}

/// The costates of both states at a time that was asked for.
fn at(costates: &Costates, time: f64) -> [f64; 2] {
    let place =
        costates.time.iter().position(|other| *other == time).expect("a time that was asked for");
    [0, 1].map(|state| costates.columns[state][place])
}

/// The costates on both sides of a jump.
fn sides(costates: &Costates, time: f64) -> [[f64; 2]; 2] {
    let is_here = |place: &usize| (costates.time[*place] - time).abs() < 1e-8;
    let here: Vec<usize> = (0..costates.time.len()).filter(is_here).collect();
    let [first, .., last] = here.as_slice() else { panic!("two entries at the event") };
    [*first, *last].map(|place| [0, 1].map(|state| costates.columns[state][place]))
}

fn pair([x, y]: [f64; 2], digits: usize) -> String {
    format!("({x:.digits$}, {y:.digits$})")
}

#[test]
fn the_tables_are_what_is_computed() {
    check_tables(
        "docs/method/costate.md",
        &[
            ("arc", arc()),
            ("crossing", crossing()),
            ("crossing-widths", crossing_widths()),
            ("time", time()),
        ],
    );
}

/// (d): the smoothed adjoints early on the arc and near its exit; the independent numbers are those
/// of the second time.
fn arc() -> Rows {
    let mut smoothed =
        ["tanh", "cubic"].map(|kernel| Smoothed::new(&simulated("circle"), "rim", kernel));
    let known = [
        (0.1, [1.875, 0.805], [1.921, 0.885]),
        (0.05, [1.900, 0.859], [1.955, 0.940]),
        (0.025, [1.937, 0.916], [1.985, 0.981]),
        (0.0125, [1.973, 0.965], [1.998, 0.998]),
        (0.00625, [1.994, 0.993], [1.99996, 0.99996]),
    ];
    let mut rows = Vec::new();
    for (sigma, tanh, cubic) in known {
        let mut row = vec![sigma.to_string()];
        for (smoothed, known) in smoothed.iter_mut().zip([tanh, cubic]) {
            let found = smoothed.costates(sigma, &[1.0, 2.45]);
            near(at(&found, 1.0), [2.0, 1.0], 1e-6);
            near(at(&found, 2.45), known, 6e-4);
            row.extend([pair(at(&found, 1.0), 5), pair(at(&found, 2.45), 5)]);
        }
        rows.push(row);
    }
    let truth = costates(&exact(&simulated("circle"), "x(end)"), &[1.0, 2.45, 3.0]);
    near(at(&truth, 1.0), [2.0, 1.0], 1e-10);
    near(at(&truth, 2.45), [2.0, 1.0], 1e-10);
    near(at(&truth, 3.0), [1.0, 0.0], 1e-10);
    let exact = [1.0, 2.45, 1.0, 2.45].map(|time| pair(at(&truth, time), 5));
    rows.push([vec!["exact".to_owned()], exact.to_vec()].concat());
    rows
}

const CROSSES: f64 = 0.819094105236721;

/// (c): both sides of the event, the Hamiltonian on both sides, and the start.
fn crossing() -> Rows {
    let (x, y) = (0.892960957851587, 0.462685729514998);
    let fields = [[1.0 + y / 4.0, 0.5 - x * y], [0.5 - y * y / 4.0, -x + y / 2.0]];
    let known = [
        (
            "x(end)",
            [0.8216020155803174, 0.1830477237045065],
            [0.227397246176965, -0.09188234350817529],
            0.2457215755001086,
        ),
        (
            "y(end)",
            [-1.5870109701180907, 1.8431149607947423],
            [-1.8616834031924232, 1.7160279457200853],
            -1.928007623713015,
        ),
    ];
    let starts =
        [[0.2437264049929583, -0.02038229949499524], [-2.222875255281964, 0.8120227886660936]];
    let mut rows = Vec::new();
    for ((objective, after, before, hamiltonian), start) in known.into_iter().zip(starts) {
        let found = costates(&exact(&simulated("curved"), objective), &[]);
        let sides = sides(&found, CROSSES);
        near(sides[0], before, 1e-9);
        near(sides[1], after, 1e-9);
        near(at(&found, 0.0), start, 1e-9);
        let products =
            [0, 1].map(|side| sides[side][0] * fields[side][0] + sides[side][1] * fields[side][1]);
        near(products, [hamiltonian; 2], 1e-9);
        let lambdas = [at(&found, 0.0), sides[0], sides[1]].map(|lambda| pair(lambda, 8));
        rows.push(
            [vec![objective.to_owned()], lambdas.to_vec(), vec![format!("{:.8}", products[0])]]
                .concat(),
        );
    }
    rows
}

/// (c): before the event and after it.
fn crossing_widths() -> Rows {
    let times = [0.0, 0.5, 1.2];
    let mut smoothed = Smoothed::new(&simulated("curved"), "edge", "cubic");
    let row = |name: String, found: &Costates| {
        [vec![name], times.map(|time| pair(at(found, time), 4)).to_vec()].concat()
    };
    let truth = costates(&exact(&simulated("curved"), "x(end)"), &times[1..]);
    let mut rows = Vec::new();
    for sigma in [0.1, 0.025, 0.00625] {
        let found = smoothed.costates(sigma, &times[1..]);
        times.iter().for_each(|time| near(at(&found, *time), at(&truth, *time), 0.6 * sigma));
        rows.push(row(sigma.to_string(), &found));
    }
    rows.push(row("exact".into(), &truth));
    rows
}

/// (e1): the least time as a function of the state, `-2/3 dx + 2/5 dv` at its end, along the
/// optimal run.
fn least_time() -> Costates {
    let text = text_of("coulomb_reverse")
        .replace("minimize T ", "minimize -2 [s/m]/3*x(end) + 2 [s^2/m]/5*v(end) ");
    let mut model = changed(&text, &[], &[]);
    model.set_free("T", 2.0);
    let system = compile_sensitivities(&model).expect("the model can be simulated");
    let controls = Controls::Held {
        times: vec![0.0, 1.4],
        rows: vec![vec![2.0], vec![-2.0]],
        is_stretched: true,
    };
    gradient(&system, &controls, &Options::default(), &[]).expect("it reaches the end").costates
}

/// The smoothed problem, solved, and the times of its grid.
fn solved(sigma: f64) -> (Solved, Vec<f64>) {
    let solved = Solved::of(load("coulomb_reverse", &[], &[("sigma", &sigma.to_string())]));
    let time = solved.outcome.trajectory.time.clone();
    (solved, time)
}

/// (e1): what the solver says of the smoothed problem, next to closed forms.
fn time() -> Rows {
    let truth = least_time();
    let [before, after] = sides(&truth, 0.4);
    near(at(&truth, 0.0), [-2.0 / 3.0, -2.0 / 3.0], 1e-10);
    near(before, [-2.0 / 3.0, -0.4], 1e-10);
    near(after, [-2.0 / 3.0, -2.0 / 3.0], 1e-10);
    near(at(&truth, 2.0), [-2.0 / 3.0, 0.4], 1e-10);
    let mut rows = Vec::new();
    for sigma in [0.1, 0.03, 0.01] {
        let (solved, time) = solved(sigma);
        let near_to = |wanted: f64| time.partition_point(|time| *time < wanted);
        let [x, v] = ["x", "v"].map(|state| solved.costate(state));
        let found = [x[0], v[0], v[near_to(0.2)], v[near_to(0.8)], v[near_to(1.8)]];
        let known = [-2.0 / 3.0, -2.0 / 3.0, -8.0 / 15.0, -0.4, 4.0 / 15.0];
        let error = (0..5).map(|i| (found[i] - known[i]).abs()).fold(0.0, f64::max);
        assert!(error < 0.006, "sigma = {sigma}: {found:?}, not {known:?}");
        // In the layer the Hamiltonian 1 + lambda_v u vanishes, but for the steps.
        assert!((v[time.len() - 1] - 0.5).abs() < 0.06, "sigma = {sigma}: {}", v[time.len() - 1]);
        let all = found.into_iter().chain([v[time.len() - 1]]).map(|it| format!("{it:.4}"));
        rows.push([sigma.to_string()].into_iter().chain(all).collect());
    }
    let exact = ["-2/3", "-2/3", "-8/15", "-2/5", "4/15", "2/5"].map(str::to_owned);
    rows.push([vec!["exact".to_owned()], exact.to_vec()].concat());
    rows
}

/// A costate over time, all entries.
fn curve(costates: &Costates, state: usize) -> Vec<[f64; 2]> {
    costates
        .time
        .iter()
        .zip(&costates.columns[state])
        .map(|(time, lambda)| [*time, *lambda])
        .collect()
}

/// A smoothed costate at these times.
fn smoothed_curve(smoothed: &mut Smoothed, sigma: f64, times: &[f64]) -> Vec<[f64; 2]> {
    let found = smoothed.costates(sigma, times);
    times.iter().map(|time| [*time, at(&found, *time)[0]]).collect()
}

fn times(first: f64, last: f64) -> Vec<f64> {
    (0..=240).map(|k| first + (last - first) * f64::from(k) / 240.0).collect()
}

/// The figure of a model of `tests/simulations/`: exact, and for three widths.
fn with_widths(name: &str, surface: &str, [first, last]: [f64; 2]) -> Figure {
    let axis = Axis::new("t").between(first, last);
    let mut figure = Figure::new(axis, Axis::new("lambda_x"));
    figure = figure.line("exact", &curve(&costates(&exact(&simulated(name), "x(end)"), &[]), 0));
    let mut smoothed = Smoothed::new(&simulated(name), surface, "tanh");
    for sigma in [0.1, 0.025, 0.00625] {
        let points = smoothed_curve(&mut smoothed, sigma, &times(first + 1e-6, last - 1e-6));
        figure = figure.line(&format!("sigma = {sigma}"), &points);
    }
    figure
}

/// The representative of the paper on the arc, `(2, 1) - sqrt 2 x`.
fn of_the_paper() -> Vec<[f64; 2]> {
    let system = exact(&simulated("circle"), "x(end)");
    let arc = times(0.753939201416946, 2.5213203435596);
    let found =
        simulate(&system, &Controls::Guess, &Options { times: arc.clone(), ..Options::default() });
    arc.iter().zip(&found.states[0]).map(|(time, x)| [*time, 2.0 - SQRT_2 * x]).collect()
}

#[test]
fn the_figure_of_the_arc_is_what_is_computed() {
    let figure = with_widths("circle", "rim", [0.0, 4.0]).dashed("the paper's", &of_the_paper());
    check_file("docs/method/figures/costate-arc.svg", &figure.svg());
}

#[test]
fn the_figure_of_the_crossing_is_what_is_computed() {
    let figure = with_widths("curved", "edge", [0.0, 2.0]);
    check_file("docs/method/figures/costate-crossing.svg", &figure.svg());
}

#[test]
fn the_figure_of_the_least_time_is_what_is_computed() {
    let mut figure = Figure::new(Axis::new("t"), Axis::new("lambda_v"));
    figure = figure.line("exact", &curve(&least_time(), 1));
    for sigma in [0.1, 0.03, 0.01] {
        let (solved, time) = solved(sigma);
        let points =
            time.into_iter().zip(solved.costate("v")).map(|(time, lambda)| [time, *lambda]);
        figure = figure.line(&format!("sigma = {sigma}"), &points.collect::<Vec<_>>());
    }
    check_file("docs/method/figures/costate-time.svg", &figure.svg());
}
