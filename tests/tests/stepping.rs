//! Fixed steps through inclusions: what they compute, the gradient of it, and what they refuse.

use fdcc_compiler::{compile_sensitivities, compile_simulation, compile_smoothed};
use fdcc_runtime::fixed_step::{Failure, Gradient, Grid, Stepped, gradient, step_through};
use fdcc_runtime::problem::{Grid as Intervals, Method};
use fdcc_runtime::simulate::{Controls, Options, Polynomials, Status, System, simulate};
use fdcc_tests::models::{meaning, problem, text_of};
use fdcc_tests::{documents, rate};

/// A block on a table that moves, pushed; the surface depends on time and on a parameter, and is
/// held for a while.
const PUSHED: &str = "model pushed
param m = 1.2
param mu = 0.9
param first = 0.2
param last = 2.3
param x0 = 0.1
param v0 = -0.4
param push = 0.6
time t in [first, last]
state x start x0
state v start v0
control F guess push*t
surface slip = v - 0.2*m*sin(t)
dynamics {
  x' in v + 0.1*Sgn(slip)*x^2
  v' in (F - mu*(1 + x^2)*Sgn(slip) - x)/m
}
minimize m*x(end)^2 + v(end) + x(start)*v(end) + integral(v^2 + mu*F*x)
method { smooth sigma = 0.05 grid N = 40 scheme SCHEME }
";

const SCHEMES: [&str; 5] =
    ["euler", "implicit_euler", "implicit_euler lagged (x)", "midpoint", "trapezoid"];

struct Case {
    system: System,
    controls: Controls,
    grid: Grid,
}

impl Case {
    fn stepped(&self) -> Stepped {
        step_through(&self.system, &self.controls, &self.grid)
            .expect("the system can be stepped through")
    }

    fn gradient(&self) -> Gradient {
        gradient(&self.system, &self.controls, &self.grid, &self.stepped())
            .expect("there is a gradient")
    }

    fn objective(&self) -> f64 {
        self.stepped().objective.expect("the model has an objective")
    }

    /// A central difference of the objective.
    fn difference(&mut self, change: impl Fn(&mut Case, f64)) -> f64 {
        let step = 1e-6;
        change(self, step);
        let above = self.objective();
        change(self, -2.0 * step);
        let below = self.objective();
        change(self, step);
        (above - below) / (2.0 * step)
    }
}

/// Every scheme with one and with three steps for each control, for the inclusion and the smoothed
/// system.
fn cases(controls: &Controls) -> Vec<(String, Case)> {
    let mut cases = Vec::new();
    for scheme in SCHEMES {
        let text = PUSHED.replace("SCHEME", scheme);
        let method = problem(&text, &[], &[]).method;
        for system in both(&text) {
            for steps in [1, 3] {
                let title = format!("{scheme}, {steps} steps, {} surfaces", system.surfaces.len());
                let grid = Grid::new(&system, &Method { steps, ..method.clone() });
                let case = Case { system: system.clone(), controls: controls.clone(), grid };
                cases.push((title, case));
            }
        }
    }
    let [system, _] = both(&PUSHED.replace("SCHEME", SCHEMES[0]));
    let grid = Grid::theta(&system, 0.7, 50);
    cases.push(("theta".into(), Case { system, controls: controls.clone(), grid }));
    cases
}

/// The inclusion and the smoothed system.
fn both(text: &str) -> [System; 2] {
    let model = meaning(text);
    [compile_sensitivities(&model), compile_smoothed(&model)]
        .map(|system| system.expect("the model compiles"))
}

fn assert_same(found: f64, difference: f64, what: &str) {
    assert!(
        (found - difference).abs() <= 1e-7 * difference.abs().max(1.0),
        "{what}: gradient {found}, difference {difference}"
    );
}

#[test]
fn the_gradient_is_the_derivative_of_what_the_steps_compute() {
    for (title, mut case) in cases(&Controls::Guess) {
        let gradient = case.gradient();
        for at in 0..case.system.parameters.len() {
            let difference = case.difference(|case, step| case.system.parameters[at].value += step);
            let name = &case.system.parameters[at].name;
            assert_same(gradient.parameters[at], difference, &format!("{title}, {name}"));
        }
        let [x0, v0] = ["x0", "v0"].map(|name| {
            case.system.parameters.iter().position(|it| it.name == name).expect("a parameter")
        });
        assert_eq!(
            gradient.starts[..2],
            [gradient.parameters[x0], gradient.parameters[v0]],
            "{title}"
        );
    }
}

#[test]
fn the_gradient_by_held_controls_is_that_of_their_rows() {
    let times: Vec<f64> = (0..10).map(|row| 0.2 + 0.21 * f64::from(row)).collect();
    let rows = times.iter().map(|t| vec![0.7 * t]).collect();
    check_by_rows(&Controls::Held { times, rows, is_stretched: true });
}

#[test]
fn the_gradient_by_polynomials_is_that_of_their_values_at_nodes() {
    let nodes: Vec<f64> = (0..6).map(|row| 0.3 + 0.35 * f64::from(row)).collect();
    check_by_rows(&Controls::Polynomial(Polynomials {
        times: vec![0.2, 1.25, 2.3],
        ranges: vec![0..3, 3..6],
        rows: nodes.iter().map(|t| vec![0.7 * t * t]).collect(),
        nodes,
        is_stretched: true,
    }));
}

fn check_by_rows(controls: &Controls) {
    for (title, mut case) in cases(controls) {
        let gradient = case.gradient();
        for row in 0..controls.rows().len() {
            let difference = case.difference(|case, step| case.controls.rows_mut()[row][0] += step);
            assert_same(gradient.controls[row][0], difference, &format!("{title}, row {row}"));
        }
    }
}

/// Selectors strictly between their ends were computed from their switching functions, not given.
#[test]
fn the_block_of_these_gradients_sticks_for_a_third_of_the_time() {
    let is_implicit = |title: &str| title.contains("1 surfaces") && !title.starts_with("euler");
    for (title, case) in cases(&Controls::Guess).into_iter().filter(|(title, _)| is_implicit(title))
    {
        let selectors = case.stepped().selectors.remove(0);
        let free = selectors.iter().filter(|s| s.abs() < 1.0).count();
        assert!(4 * free >= selectors.len(), "{title}: {free} of {}", selectors.len());
    }
}

/// The model of a file in `tests/simulations/`.
fn simulation(name: &str) -> String {
    let all = documents("tests/simulations", "fdc");
    all.into_iter().find(|(other, _)| other == name).expect("the model is there").1
}

fn inclusion(text: &str) -> System {
    compile_sensitivities(&meaning(text)).expect("the model can be simulated")
}

fn theta(system: &System, theta: f64, steps: usize) -> Result<Stepped, Failure> {
    step_through(system, &Controls::Guess, &Grid::theta(system, theta, steps))
}

/// The errors of an independent program with the same steps.
#[test]
fn implicit_euler_takes_the_limit_of_the_smoothing_on_two_surfaces_at_once() {
    let system = inclusion(
        &simulation("codimension_two")
            .replace("[0, 2]", "[0, END]")
            .replace("time", "param END = 2\ntime"),
    );
    for (h, expected) in [(0.03, 8.5e-4), (0.01, 2.8e-4), (0.003, 1.1e-4), (0.001, 3.7e-5)] {
        let steps = (2.0_f64 / h).floor();
        let mut system = system.clone();
        system.parameters[0].value = steps * h;
        let end = theta(&system, 1.0, steps as usize).expect("an end").states[2][steps as usize];
        let error = end - (3.062_145_328_719_723 - (2.0 - steps * h) * 4062.0 / 7225.0);
        assert!((error / expected - 1.0).abs() < 0.03, "h = {h}: {error}");
    }
}

/// 3.04, as an independent program found with h = 0.01 and 0.001, is no closer for the smaller
/// step.
#[test]
fn explicit_euler_does_not_converge_on_two_surfaces_at_once() {
    let system = inclusion(&simulation("codimension_two"));
    for steps in [200, 2000] {
        let end = theta(&system, 0.0, steps).expect("an end").states[2][steps];
        assert!((end - 3.04).abs() < 1e-6, "{steps} steps: {end}");
    }
}

#[test]
fn implicit_euler_converges_to_the_simulation_of_every_model() {
    let mut compared = 0;
    for (name, text) in documents("tests/simulations", "fdc") {
        let Ok(system) = compile_simulation(&meaning(&text)) else { continue };
        let exact = simulate(&system, &Controls::Guess, &Options::default());
        if !system.jumps.is_empty()
            || !system.balls.is_empty()
            || !matches!(exact.status, Status::Completed)
        {
            continue;
        }
        let [coarse, fine] = [500, 4000].map(|steps| {
            let stepped =
                theta(&system, 1.0, steps).unwrap_or_else(|failure| panic!("{name}: {failure:?}"));
            let errors = exact
                .end
                .iter()
                .zip(&stepped.states)
                .map(|(end, state)| (end - state[steps]) / (1.0 + end.abs()));
            errors.fold(0.0, |largest: f64, error| largest.max(error.abs()))
        });
        assert!(fine <= 2e-3 || fine <= 0.4 * coarse, "{name}: errors {coarse}, {fine}");
        compared += 1;
    }
    assert!(compared >= 15, "only {compared} models were compared");
}

/// Closed forms of the end and of its derivative by the start: `(2, 1)`, exact for any mixture of
/// the fields on the arc.
#[test]
fn the_gradient_through_a_sliding_arc_converges() {
    let system = inclusion(&(simulation("circle") + "\nminimize x(end)\n"));
    for steps in [130, 1300, 13000] {
        let case = Case {
            grid: Grid::theta(&system, 1.0, steps),
            system: system.clone(),
            controls: Controls::Guess,
        };
        let (h, starts) = (4.0 / steps as f64, case.gradient().starts);
        assert!((case.objective() - 2.185_786_437_626_905).abs() < h, "{steps} steps");
        assert!(
            (starts[0] - 2.0).abs() < 3.0 * h && (starts[1] - 1.0).abs() < 3.0 * h,
            "{steps} steps: {starts:?}"
        );
    }
}

/// `x'' = -x` over one radian.
#[test]
fn smooth_systems_get_the_order_of_the_scheme() {
    for (scheme, order) in SCHEMES.into_iter().zip([1.0, 1.0, 1.0, 2.0, 2.0]) {
        let text = "model swing time t in [0, 1] state x start 1 state v start 0
            dynamics { x' = v  v' = -x } method { grid N = 10 scheme SCHEME }";
        let text = text.replace("SCHEME", scheme);
        let (system, method) = (inclusion(&text), problem(&text, &[], &[]).method);
        let steps = [20, 40, 80];
        let errors = steps.map(|intervals| {
            let grid = Grid::new(
                &system,
                &Method { grid: Intervals::Uniform(intervals), ..method.clone() },
            );
            let stepped = step_through(&system, &Controls::Guess, &grid).expect("an end");
            (stepped.states[0][intervals] - 1.0_f64.cos())
                .hypot(stepped.states[1][intervals] + 1.0_f64.sin())
        });
        let found = rate(&steps.map(|steps| 1.0 / steps as f64), &errors);
        assert!((found - order).abs() < 0.1, "{scheme}: order {found}");
    }
}

#[test]
fn what_cannot_be_stepped_through_is_refused() {
    let failure = |text: &str, steps| theta(&inclusion(text), 1.0, steps).err().expect("a failure");
    assert_eq!(failure(&text_of("bounce"), 10), Failure::Jumps);
    let puck = compile_simulation(&meaning(&simulation("puck_stops")))
        .expect("the model can be simulated");
    assert_eq!(theta(&puck, 1.0, 10).err(), Some(Failure::Directions));
    let text = |rate: &str| {
        format!("model one time t in [0, 2] state x start 1 dynamics {{ x' = {rate} }}")
    };
    match failure(&text("log(x - 1.5)"), 10) {
        Failure::NotFinite { time, origin } => assert_eq!((time, &*origin.label), (0.2, "x'")),
        other => panic!("{other:?}"),
    }
    // x+ = 1 + 2 x+ for one step of 2; x+ = 1 + x+ has no solution, and neither has x+ = 1 + 2
    // (x+)^2.
    assert_eq!(theta(&inclusion(&text("x")), 1.0, 1).expect("an end").states[0][1], -1.0);
    assert_eq!(failure(&text("x"), 2), Failure::Singular { step: 0, time: 1.0 });
    assert_eq!(failure(&text("x^2"), 1), Failure::NotConverged { step: 0, time: 2.0 });
}

#[test]
fn a_model_without_objective_has_no_gradient() {
    let system = inclusion("model one time t in [0, 2] state x start 1 dynamics { x' = -x }");
    let (grid, controls) = (Grid::theta(&system, 1.0, 10), Controls::Guess);
    let stepped = step_through(&system, &controls, &grid).expect("an end");
    assert_eq!(stepped.objective, None);
    assert_eq!(gradient(&system, &controls, &grid, &stepped), Err(Failure::NoObjective));
}
