//! The tables and figures of `docs/method/convergence.md`: smoothed derivatives `S_sigma`, those of
//! steps `S_h,sigma`, and the true ones `S`, compared with each other and with the numbers of an
//! independent program.

use fdcc_runtime::sensitivity::{Quantity, gradient};
use fdcc_runtime::simulate::{Controls, Options};
use fdcc_tests::pages::{check_file, check_tables};
use fdcc_tests::planar::{Matrix, Smoothed, derivative, distance, exact, simulated};
use fdcc_tests::section_two::{set, smoothed_to_the_end};
use fdcc_tests::svg::{Axis, Figure};

type Rows = Vec<Vec<String>>;

const WIDTHS: [f64; 6] = [0.1, 0.05, 0.025, 0.0125, 0.00625, 0.003125];

/// Sliding on the circle between fields that depend on the state: held from 0.719 to 1.905.
const BENT: &str = "model bent
param T = 1.5
time t in [0, T]
state x start -0.3
state y start 0.2
surface rim = x^2 + y^2 - 1
dynamics {
  x' in match rim { below => y/4,     above => 1 + y/5 }
  y' in match rim { below => 1 - x/3, above => -1 - x*y/2 }
}
";

/// A text, its surface and its last time.
struct Case {
    text: String,
    surface: &'static str,
    last: f64,
}

impl Case {
    fn crossing() -> Self {
        Case { text: simulated("curved"), surface: "edge", last: 2.0 }
    }

    fn arc() -> Self {
        Case { text: simulated("circle").replace("T = 4", "T = 1.5"), surface: "rim", last: 1.5 }
    }

    fn held() -> Self {
        Case { text: BENT.into(), surface: "rim", last: 1.5 }
    }

    fn left() -> Self {
        Case { text: BENT.replace("T = 1.5", "T = 4"), surface: "rim", last: 4.0 }
    }

    fn exact(&self) -> Matrix {
        derivative(&exact(&self.text, "x(end)"))
    }

    fn smoothed(&self, kernel: &str) -> Smoothed {
        Smoothed::new(&self.text, self.surface, kernel)
    }

    /// `S_sigma` for all widths.
    fn derivatives(&self, kernel: &str) -> Vec<Matrix> {
        let mut smoothed = self.smoothed(kernel);
        WIDTHS.iter().map(|sigma| smoothed.derivative(*sigma)).collect()
    }

    /// `|S_sigma - S|`
    fn bias(&self, kernel: &str) -> Vec<f64> {
        self.distances(&self.derivatives(kernel))
    }

    fn distances(&self, found: &[Matrix]) -> Vec<f64> {
        let exact = self.exact();
        found.iter().map(|found| distance(found, &exact)).collect()
    }
}

/// Numbers that are known to some digits, as many as there are.
#[track_caller]
fn near(found: &[f64], known: &[f64], digits: i32) {
    for (found, known) in found.iter().zip(known) {
        let unit = 10_f64.powi(known.log10().floor() as i32 + 1 - digits);
        assert!((found - known).abs() < 0.6 * unit, "{found}, not {known}");
    }
}

/// Columns of errors over widths; below them the rate between the last two.
fn over_widths(columns: &[Vec<f64>], digits: usize) -> Rows {
    let most = columns.iter().map(Vec::len).max().unwrap_or_default();
    let widths = &WIDTHS[WIDTHS.len() - most..];
    let mut rows: Rows = widths.iter().map(|sigma| vec![sigma.to_string()]).collect();
    let mut rates = vec!["rate".to_owned()];
    for errors in columns {
        let missing = most - errors.len();
        let shown = errors.iter().map(|error| format!("{error:.digits$e}"));
        let cells = std::iter::repeat_n(String::new(), missing).chain(shown);
        rows.iter_mut().zip(cells).for_each(|(row, cell)| row.push(cell));
        let [.., before, last] = errors.as_slice() else { panic!("a rate needs two errors") };
        rates.push(format!("{:.2}", (before / last).log2()));
    }
    rows.push(rates);
    rows
}

#[test]
fn the_tables_are_what_is_computed() {
    check_tables(
        "docs/method/convergence.md",
        &[
            ("scalar", scalar()),
            ("crossing", crossing()),
            ("sliding", sliding()),
            ("extrapolated", extrapolated()),
            ("rules", rules()),
            ("ratios", ratios()),
        ],
    );
}

/// Example (2.3), in closed form: `dx(T)/dx0 = f(x(T))/f(x0)` with `f = 2 - tanh(x/sigma)`, and
/// `x(T) = 5/3 + sigma ln(3)/3`.
fn scalar() -> Rows {
    let mut system = smoothed_to_the_end();
    let mut rows = Vec::new();
    for sigma in [0.4, 0.2, 0.1] {
        set(&mut system, &[("sigma(zero)", sigma)]);
        let found = gradient(&system, &Controls::Guess, &Options::default(), &[Quantity::Start(0)]);
        let found = found.expect("the simulation reaches its end");
        let field = |x: f64| 2.0 - (x / sigma).tanh();
        let (slope, bias) = (field(found.value) / field(-1.0), sigma * 3_f64.ln() / 3.0);
        assert!((found.adjoint[0] - slope).abs() < 1e-9, "sigma = {sigma}: {found:?}");
        assert!((found.value - 5.0 / 3.0 - bias).abs() < 2.0 * sigma * (-2.0 / sigma).exp() + 1e-9);
        rows.push(vec![
            sigma.to_string(),
            format!("{:.6}", found.value - 5.0 / 3.0),
            format!("{bias:.6}"),
            format!("{:.1e}", slope - 1.0 / 3.0),
        ]);
    }
    rows
}

/// Theorem 5.1 and 5.2.
fn crossing() -> Rows {
    let found =
        ["tanh", "sqrt", "linear", "cubic", "quintic"].map(|kernel| Case::crossing().bias(kernel));
    near(&found[0], &[8.4e-2, 5.8e-2, 3.6e-2, 2.1e-2, 1.1e-2, 5.7e-3], 2);
    near(&found[2], &[8.3e-2], 2);
    near(&found[3], &[6.7e-2, 3.9e-2, 2.1e-2, 1.1e-2, 5.6e-3, 2.8e-3], 2);
    near(&found[4], &[5.8e-2, 3.4e-2, 1.8e-2, 9.4e-3, 4.8e-3], 2);
    over_widths(&found, 2)
}

/// Theorem 6.1, at the end of an arc and after it.
fn sliding() -> Rows {
    let of = |case: Case| ["tanh", "cubic"].map(|kernel| case.bias(kernel));
    let arc = of(Case::arc());
    near(&arc[0], &[2.6e-2, 1.4e-2, 7.0e-3, 3.5e-3, 1.8e-3, 8.9e-4], 2);
    near(&arc[1], &[1.8e-2, 9.3e-3, 4.7e-3, 2.4e-3, 1.2e-3, 6.0e-4], 2);
    over_widths(&[arc, of(Case::held()), of(Case::left())].concat(), 2)
}

/// `R1 = 2 S_sigma - S_2sigma` and `R2 = (4 R1(sigma) - R1(2 sigma))/3`, each in the row of its
/// finest width.
fn extrapolated() -> Rows {
    let combined = |all: &[Matrix], a: f64, b: f64| -> Vec<Matrix> {
        let one =
            |pair: &[Matrix]| [0, 1].map(|i| [0, 1].map(|j| a * pair[1][i][j] - b * pair[0][i][j]));
        all.windows(2).map(one).collect()
    };
    let of = |case: Case, kernel| {
        let first = combined(&case.derivatives(kernel), 2.0, 1.0);
        let second = combined(&first, 4.0 / 3.0, 1.0 / 3.0);
        [case.distances(&first), case.distances(&second)]
    };
    let [tanh, cubic] = ["tanh", "cubic"].map(|kernel| of(Case::crossing(), kernel));
    near(&tanh[0], &[3.3e-2, 1.4e-2, 5.0e-3, 1.5e-3, 4.1e-4], 2);
    near(&tanh[1], &[7.6e-3, 2.0e-3, 3.6e-4, 4.6e-5], 2);
    near(&cubic[0], &[1.2e-2, 3.2e-3, 8.0e-4, 2.0e-4, 4.8e-5], 2);
    near(&cubic[1], &[3.7e-4, 5.6e-5], 2);
    near(&cubic[1][2..], &[7.2e-6, 1.0e-6], 1);
    let [left, _] = of(Case::left(), "cubic");
    over_widths(&[tanh.as_slice(), &cubic, &of(Case::held(), "cubic"), &[left]].concat(), 1)
}

/// `|S_h,sigma - S|` where the step follows the width.
fn rules() -> Rows {
    let (crossing, held, widths) = (Case::crossing(), Case::held(), [0.1, 0.025, 0.00625]);
    let mut rows = Vec::new();
    for (name, theta, step, known, digits) in RULES {
        let mut row = vec![name.to_owned()];
        for case in [&crossing, &held] {
            let mut smoothed = case.smoothed("tanh");
            let steps = |sigma: f64| (case.last / step(sigma)).round() as usize;
            let found = widths.iter().map(|sigma| smoothed.stepped(*sigma, theta, steps(*sigma)));
            let errors = case.distances(&found.collect::<Vec<_>>());
            if case.surface == "edge" {
                near(&errors, &known, digits);
            }
            row.extend(errors.iter().map(|error| format!("{error:.4}")));
        }
        rows.push(row);
    }
    rows
}

/// Name, theta, step for a width; the errors of the crossing that are known, with their digits.
type Rule = (&'static str, f64, fn(f64) -> f64, [f64; 3], i32);

const RULES: [Rule; 7] = [
    ("explicit, h = sigma/50", 0.0, |sigma| sigma / 50.0, [0.0838, 0.0361, 0.0110], 3),
    ("explicit, h = sigma/10", 0.0, |sigma| sigma / 10.0, [0.0831, 0.0355, 0.0108], 3),
    ("explicit, h = sigma^2", 0.0, |sigma| sigma * sigma, [0.0831, 0.0360, 0.0110], 3),
    ("implicit, h = sigma^2", 1.0, |sigma| sigma * sigma, [0.0850, 0.0364, 0.0111], 3),
    ("explicit, h = sigma/4", 0.0, |sigma| sigma / 4.0, [0.0817, 0.0343, 0.0104], 3),
    ("explicit, h = sigma", 0.0, |sigma| sigma, [0.125, 0.0335, 0.0089], 2),
    ("implicit, h = sigma", 1.0, |sigma| sigma, [0.115, 0.0443, 0.0137], 2),
];

const RATIOS: [f64; 6] = [0.1, 0.5, 1.0, 2.0, 4.0, 8.0];

/// `|S_h,sigma - S_sigma|` for one width and several ratios `h/sigma`, both schemes.
fn over_ratios(case: &Case, sigma: f64, ratios: &[f64]) -> [Vec<f64>; 2] {
    let mut smoothed = case.smoothed("tanh");
    let limit = smoothed.derivative(sigma);
    [0.0, 1.0].map(|theta| {
        let steps = ratios.iter().map(|ratio| (case.last / (ratio * sigma)).round() as usize);
        steps.map(|steps| distance(&smoothed.stepped(sigma, theta, steps), &limit)).collect()
    })
}

/// A step that keeps its ratio to the width.
fn ratios() -> Rows {
    let mut rows: Rows = RATIOS.iter().map(|ratio| vec![ratio.to_string()]).collect();
    for case in [Case::crossing(), Case::held()] {
        let found = [0.05, 0.0125, 0.003125].map(|sigma| over_ratios(&case, sigma, &RATIOS));
        for scheme in 0..2 {
            for (row, at) in rows.iter_mut().zip(0..) {
                let errors = found.each_ref().map(|found| found[scheme][at]);
                row.push(errors.map(|error| format!("{error:.1e}")).join(", "));
                check_ratio(&case, scheme, at, &errors);
            }
        }
    }
    rows
}

/// Crossing explicitly needs steps below the width, sliding explicitly needs stability; implicit
/// Euler converges always.
fn check_ratio(case: &Case, scheme: usize, at: usize, errors: &[f64; 3]) {
    let falls = errors.windows(2).all(|pair| pair[1] < 0.5 * pair[0]);
    let ratio = RATIOS[at];
    assert_eq!(falls, scheme == 1 || ratio <= 1.0, "ratio {ratio}, scheme {scheme}: {errors:?}");
    if case.surface == "edge" && scheme == 0 && ratio <= 1.0 {
        near(
            errors,
            &[[6.5e-3, 1.7e-3, 4.3e-4], [3.2e-2, 8.5e-3, 2.2e-3], [6.3e-2, 1.8e-2, 3.2e-3]][at],
            2,
        );
    }
}

fn over<'a>(xs: &'a [f64], ys: &'a [f64]) -> Vec<[f64; 2]> {
    xs.iter().zip(ys).map(|(x, y)| [*x, *y]).collect()
}

#[test]
fn the_figure_over_widths_is_what_is_computed() {
    let (width, error) = (Axis::new("sigma").logarithmic(), Axis::new("error of S").logarithmic());
    let mut figure = Figure::new(width, error);
    let cases = [
        ("crossing, tanh", Case::crossing(), "tanh"),
        ("crossing, sqrt", Case::crossing(), "sqrt"),
        ("crossing, cubic", Case::crossing(), "cubic"),
        ("sliding, cubic", Case::held(), "cubic"),
        ("after it, tanh", Case::left(), "tanh"),
        ("after it, cubic", Case::left(), "cubic"),
    ];
    for (name, case, kernel) in cases {
        figure = figure.line(name, &over(&WIDTHS, &case.bias(kernel)));
    }
    let line = over(&WIDTHS, &WIDTHS.map(|sigma| 0.2 * sigma));
    check_file(
        "docs/method/figures/convergence-widths.svg",
        &figure.dashed("sigma/5", &line).svg(),
    );
}

#[test]
fn the_figure_over_ratios_is_what_is_computed() {
    let ratios: Vec<f64> = (0..25).map(|k| 0.05 * 160_f64.powf(f64::from(k) / 24.0)).collect();
    let error =
        Axis::new("error of S against its limit for h to 0").logarithmic().between(5e-5, 20.0);
    let mut figure = Figure::new(Axis::new("h/sigma").logarithmic(), error);
    for (name, case) in [("crossing", Case::crossing()), ("sliding", Case::held())] {
        let [explicit, implicit] = over_ratios(&case, 0.0125, &ratios);
        figure = figure.line(&format!("{name}, explicit"), &over(&ratios, &explicit));
        figure = figure.line(&format!("{name}, implicit"), &over(&ratios, &implicit));
    }
    check_file("docs/method/figures/convergence-ratios.svg", &figure.svg());
}
