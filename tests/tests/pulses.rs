//! A pulse of the right side that is short beside the time is not stepped over, whatever its shape
//! and its place, and systems without pulses are not integrated in shorter steps for it.
//!
//! Ends are closed forms: a pulse is the derivative of `log cosh`, `erf` or `atan` terms.

use fdcc_compiler::{compile_sensitivities, compile_simulation};
use fdcc_runtime::sensitivity::{Quantity, gradient};
use fdcc_runtime::simulate::{Controls, Integrator, Options, Simulation, Status, simulate};
use fdcc_tests::models::meaning;
use std::f64::consts::PI;

const LAST: f64 = 10.0;

/// A pulse around 0 as a model writes it, with `{}` for its argument.
struct Shape {
    text: &'static str,
    /// The integral of the pulse from 0, which is odd.
    integral: fn(f64) -> f64,
    /// From so many widths on the closed form holds.
    clear: f64,
}

const SHAPES: [Shape; 3] = [
    Shape {
        text: "(tanh({} + 1) - tanh({} - 1))",
        integral: |z| if z.abs() < 30.0 { step_pair(z) } else { 2.0 * z.signum() },
        clear: 0.0,
    },
    Shape { text: "exp(-({})^2)", integral: |z| 0.5 * PI.sqrt() * z.signum(), clear: 7.0 },
    Shape { text: "1/(1 + ({})^2)", integral: f64::atan, clear: 0.0 },
];

fn step_pair(z: f64) -> f64 {
    ((z + 1.0).cosh() / (z - 1.0).cosh()).ln()
}

fn run(text: &str, options: &Options) -> Simulation {
    let system = compile_simulation(&meaning(text)).expect("the model can be simulated");
    let simulation = simulate(&system, &Controls::Guess, options);
    assert!(matches!(simulation.status, Status::Completed), "{:?}\n{text}", simulation.status);
    simulation
}

/// A pulse moves `y` by about 1, half of it until its middle, where a surface is crossed.
fn check(shape: &Shape, [width, middle]: [f64; 2], argument: &str, options: &Options) {
    let (width, middle) = (width * LAST, middle * LAST);
    if middle.min(LAST - middle) < shape.clear * width {
        return;
    }
    let whole = 2.0 * (shape.integral)(1e6);
    let height = 1.0 / (whole * width);
    let [before, after] =
        [middle, LAST - middle].map(|time| (shape.integral)(time / width) / whole);
    let pulse = shape.text.replace("{}", &format!("({argument} - {middle})/{width}"));
    let text = format!(
        "time t in [0, {LAST}]
state x start 0
state y start 0
state z start 0
surface half = y - {before}
dynamics {{
  x' = 1
  y' = {height}*{pulse}
  z' in Sgn(half)
}}
"
    );
    let simulation = run(&text, options);
    let times: Vec<f64> = simulation.events.iter().map(|event| event.time).collect();
    assert!(times.len() == 1 && (times[0] - middle).abs() < 1e-6, "{times:?}\n{text}");
    let expected = [LAST, before + after, LAST - 2.0 * middle];
    let is_near = |(got, end): (&f64, f64)| (got - end).abs() < 1e-6;
    assert!(simulation.end.iter().zip(expected).all(is_near), "{:?}\n{text}", simulation.end);
}

/// Widths are parts of the whole time, from those that no step misses to a thousandth.
fn check_all(widths: &[f64], middles: &[f64], options: &Options) {
    for shape in &SHAPES {
        for width in widths {
            for middle in middles {
                check(shape, [*width, *middle], "t", options);
                check(shape, [*width, *middle], "x", options);
            }
        }
    }
}

#[test]
fn pulses_in_time_and_in_a_state_are_seen() {
    let middles = [0.04, 0.21, 0.3, 0.4999, 0.5037, 0.66, 0.8, 0.95];
    check_all(&[0.05, 0.02, 0.01, 0.005, 0.002, 0.001], &middles, &Options::default());
}

#[test]
fn the_stiff_method_sees_them_too() {
    let options = Options { integrator: Integrator::Stiff, rtol: 1e-8, ..Options::default() };
    check_all(&[0.02, 0.001], &[0.21, 0.5037, 0.8], &options);
}

/// `h = 1 - 20 sqrt(pi) ((t - c) (1 + erf(z)) + w/sqrt(pi) exp(-z^2))` with `z = (t - c)/w`; root
/// and end by bisection of the closed form in double precision.
#[test]
fn a_blow_that_throws_a_ball_to_the_ground_makes_it_bounce() {
    let simulation = run(
        "time t in [0, 10]
state h start 1
state v start 0
surface ground = h
jump bounce on ground falling { v := -v }
dynamics {
  h' = v
  v' = -2000*exp(-((t - 5.13)/0.02)^2)
}
",
        &Options::default(),
    );
    assert_eq!(simulation.events.len(), 1);
    assert!((simulation.events[0].time - 5.142_674_584_764_085).abs() < 1e-9);
    assert!((simulation.end[0] - 217.012_875_099_011_92).abs() < 1e-7, "{:?}", simulation.end);
    assert!((simulation.end[1] - 44.656_567_394_389).abs() < 1e-8, "{:?}", simulation.end);
}

/// The integral of `1000 exp(-((t - 5.037)/w)^2) + 1` is `1000 w sqrt(pi) + 10`.
#[test]
fn a_pulse_of_an_integrand_counts() {
    let simulation = run(
        "time t in [0, 10]
state x start 0
control u guess 1
dynamics { x' = u }
minimize integral(1000*exp(-((x - 5.037)/1e-3)^2) + u^2)
",
        &Options::default(),
    );
    let objective = simulation.objective.expect("the end is reached");
    assert!((objective - 10.0 - PI.sqrt()).abs() < 1e-7, "{objective}");
}

/// The selector answers to the pulse, 0.8 of what it may, and what it drives takes `80 w sqrt(pi)`.
#[test]
fn a_pulse_that_a_sliding_selector_passes_on_is_seen() {
    let simulation = run(
        "time t in [0, 10]
state v start 0
state y start 0
surface slip = v
dynamics {
  v' in 0.8*exp(-((t - 6.3)/0.01)^2) - Sgn(slip)
  y' in 100*Sgn(slip)
}
",
        &Options::default(),
    );
    assert!((simulation.end[1] - 0.8 * PI.sqrt()).abs() < 1e-7, "{:?}", simulation.end);
}

/// Ten pulses; a state that begins far from 0 moves no farther for it.
#[test]
fn a_train_of_pulses_and_an_offset_hide_nothing() {
    let train = "time t in [0, 10]
state y start 0
dynamics { y' = exp(2000*(cos(2*pi*t) - 1)) }
";
    let fine = run(train, &Options { max_step: 1e-3, ..Options::default() }).end[0];
    let end = run(train, &Options::default()).end[0];
    assert!(fine > 0.06 && (end - fine).abs() < 1e-8, "{end}, not {fine}");
    let far = run(
        "time t in [0, 10]
state y start 1e4
dynamics { y' = 5*(tanh((t - 5)/0.01) - tanh((t - 5.2)/0.01)) }
",
        &Options::default(),
    );
    assert!((far.end[0] - 1e4 - 2.0).abs() < 1e-5, "{:?}", far.end);
}

/// `y` ends at `a w sqrt(pi)`.
#[test]
fn derivatives_know_of_pulses() {
    let model = meaning(
        "param a = 3
time t in [0, 10]
state y start 0
dynamics { y' = a*exp(-((t - 5.13)/0.02)^2) }
minimize y(end)
",
    );
    let system = compile_sensitivities(&model).expect("the model can be simulated");
    let by = [Quantity::Parameter(0)];
    let found = gradient(&system, &Controls::Guess, &Options::default(), &by);
    let found = found.unwrap_or_else(|stopped| panic!("{:?}", stopped.status));
    assert!((found.forward[0] - 0.02 * PI.sqrt()).abs() < 1e-8, "{:?}", found.forward);
}

/// Smooth systems, with the steps and evaluations that they took when nobody looked for pulses, at
/// a tolerance of 1e-10.
const SMOOTH: [(&str, [usize; 2]); 6] = [
    (
        "time t in [0, 20]
state x start 1
state v start 0
dynamics {
  x' = v
  v' = -4*sin(x) - 0.1*v/(1 + v^2)
}
",
        [1237 + 37, 7649],
    ),
    (
        "time t in [0, 50]
state s start 5
state c start 1
dynamics {
  s' = 0.3*(6 - s) - 0.8*s*c/(0.4 + s + s^2/4)
  c' = 0.7*s*c/(0.4 + s + s^2/4) - 0.35*c
}
",
        [115, 695],
    ),
    (
        "time t in [0, 20]
state x start 0.4
state y start 0
state u start 0
state v start 2
dynamics {
  x' = u
  y' = v
  u' = -x/(x^2 + y^2)^1.5
  v' = -y/(x^2 + y^2)^1.5
}
",
        [946 + 22, 5813],
    ),
    (
        "time t in [0, 10]
state c start 1
state T start 350
dynamics {
  c' = 1 - c - 7.2e10*exp(-8750/T)*c
  T' = 350 - T + 209.2*7.2e10*exp(-8750/T)*c + 2.09*(300 - T)
}
",
        [2556 + 8, 15389],
    ),
    (
        "time t in [0, 5]
state a start 0.3
state b start 1
state p start 0
state q start 0
dynamics {
  a' = p
  b' = q
  p' = (sin(b)*(p + q)^2 + sin(b)*cos(b)*p^2 - 3*sin(a) + cos(t))/(5/3 - cos(b)^2)
  q' = (-sin(b)*(2 + cos(b))*p^2 - sin(b)*cos(b)*(p + q)^2)/(5/3 - cos(b)^2)
}
",
        [360 + 8, 2213],
    ),
    (
        "time t in [0, 10]
state y start 2
dynamics { y' = -1e6*(y - cos(t)) - sin(t) }
",
        [213 + 6, 1465],
    ),
];

#[test]
fn smooth_systems_take_no_shorter_steps() {
    for (text, [steps, evaluations]) in SMOOTH {
        let counts = run(text, &Options::default()).counts;
        let taken = [counts.steps + counts.rejected, counts.evaluations];
        println!("{taken:?} for {steps}, {evaluations}");
        assert!(taken[0] as f64 <= 1.2 * steps as f64, "{taken:?} for {steps}\n{text}");
        assert!(taken[1] as f64 <= 1.6 * evaluations as f64, "{taken:?}, {evaluations}\n{text}");
    }
}

/// Only what is no polynomial of a low degree in what moves can have a pulse.
#[test]
fn polynomials_have_no_pulses() {
    let model = meaning(
        "param k = 2
time t in [0, 1]
state a start 0
state b start 0
state c start 0
state d start 0
dynamics {
  a' = t^4 - a*b/exp(k)
  b' = a^2*b^3
  c' = exp(-t)
  d' = a/(1 + b)
}
",
    );
    let system = compile_simulation(&model).expect("the model can be simulated");
    assert_eq!(system.enclosures.sudden, [1, 2, 3]);
}
