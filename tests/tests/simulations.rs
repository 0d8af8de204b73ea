//! Every model of `tests/simulations/` does what the file beside it says, to 1e-9, from a source
//! that is not this program.
//!
//! ```text
//! case WHAT, AND WHO SAYS SO
//! set PARAM = VALUE
//! control TIME VALUE               every control, held from TIME on; the guess if left out
//! event TIME SURFACE KIND          every event, in order; `events many` if there are too many
//! status STATUS TIME               completed if left out; with the time where it ended
//! at TIME STATE = VALUE            on the way
//! STATE = VALUE                    at the end; also `objective = VALUE`
//! ```

use fdcc::names::event_name;
use fdcc_compiler::compile_simulation;
use fdcc_runtime::simulate::{Controls, Options, Simulation, Status, System, simulate};
use fdcc_tests::documents;
use fdcc_tests::models::changed;

const TOLERANCE: f64 = 1e-9;

/// One case of a file.
#[derive(Default)]
struct Case<'t> {
    title: &'t str,
    set: Vec<(&'t str, &'t str)>,
    controls: Vec<(f64, f64)>,
    events: Vec<(f64, &'t str, &'t str)>,
    has_many_events: bool,
    at: Vec<(f64, &'t str, f64)>,
    status: Option<(&'t str, f64)>,
    end: Vec<(&'t str, f64)>,
}

fn cases(text: &str) -> Vec<Case<'_>> {
    let mut cases: Vec<Case> = Vec::new();
    for line in text.lines().filter(|line| !line.is_empty()) {
        if let Some(title) = line.strip_prefix("case ") {
            cases.push(Case { title, ..Case::default() });
        } else {
            read(line, cases.last_mut().expect("a file begins with a case")).expect(line);
        }
    }
    cases
}

fn read<'t>(line: &'t str, case: &mut Case<'t>) -> Option<()> {
    let words: Vec<&str> = line.split(' ').collect();
    match *words.as_slice() {
        ["set", name, "=", value] => case.set.push((name, value)),
        ["control", time, value] => case.controls.push((time.parse().ok()?, value.parse().ok()?)),
        ["events", "many"] => case.has_many_events = true,
        ["at", time, name, "=", value] => {
            case.at.push((time.parse().ok()?, name, value.parse().ok()?))
        }
        ["event", time, surface, kind] => case.events.push((time.parse().ok()?, surface, kind)),
        ["status", status, time] => case.status = Some((status, time.parse().ok()?)),
        [name, "=", value] => case.end.push((name, value.parse().ok()?)),
        _ => return None,
    }
    Some(())
}

fn status(simulation: &Simulation) -> (&'static str, f64) {
    let reached = simulation.end_time;
    match &simulation.status {
        Status::Completed => ("completed", reached),
        Status::NotUnique { .. } => ("not_unique", reached),
        Status::Zeno { limit_time, .. } => ("zeno", *limit_time),
        Status::NotFinite(_) => ("not_finite", reached),
        Status::Discontinuous { .. } => ("discontinuous", reached),
        Status::NotHeld { .. } => ("not_held", reached),
        Status::StepLimit => ("step_limit", reached),
        Status::Stopped(_) => ("stopped", reached),
    }
}

fn run(
    text: &str,
    set: &[(&str, &str)],
    controls: &Controls,
    options: &Options,
) -> (System, Simulation) {
    let system = compile_simulation(&changed(text, set, &[])).expect("the model can be simulated");
    let simulation = simulate(&system, controls, options);
    (system, simulation)
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= TOLERANCE * b.abs().max(1.0)
}

fn position(system: &System, name: &str) -> usize {
    system.states.iter().position(|state| state.name == name).expect(name)
}

fn end(system: &System, simulation: &Simulation, name: &str) -> f64 {
    match name {
        "objective" => simulation.objective.expect("the end is reached"),
        _ => simulation.end[position(system, name)],
    }
}

/// What is wanted of a case: its held controls, and the states at its times.
fn wanted(case: &Case) -> (Controls, Options) {
    let (times, rows) = case.controls.iter().map(|(time, value)| (*time, vec![*value])).unzip();
    let controls = if case.controls.is_empty() {
        Controls::Guess
    } else {
        Controls::Held { times, rows, is_stretched: true }
    };
    let mut times: Vec<f64> = case.at.iter().map(|at| at.0).collect();
    times.dedup();
    (controls, Options { times, ..Options::default() })
}

fn check_events(name: &str, case: &Case, system: &System, simulation: &Simulation) {
    let seen = simulation.events.iter();
    let seen: Vec<_> =
        seen.map(|it| (it.time, system.name_of(it.surface), event_name(it.kind))).collect();
    let agrees = |(a, b): (&(f64, &str, &str), &(f64, &str, &str))| {
        near(a.0, b.0) && (a.1, a.2) == (b.1, b.2)
    };
    let are_expected = seen.len() == case.events.len() && seen.iter().zip(&case.events).all(agrees);
    assert!(case.has_many_events || are_expected, "{name}: {seen:?}");
}

fn check(name: &str, text: &str, case: &Case) {
    let (controls, options) = wanted(case);
    let (system, simulation) = run(text, &case.set, &controls, &options);
    let name = format!("{name}, {}", case.title);
    let last = system.interval[1];
    let (expected, got) = (case.status.unwrap_or(("completed", last)), status(&simulation));
    assert!(expected.0 == got.0 && near(got.1, expected.1), "{name}: {got:?}, not {expected:?}");
    check_events(&name, case, &system, &simulation);
    for (time, state, value) in &case.at {
        let row = simulation.time.iter().position(|at| at == time).expect("the time is asked for");
        let got = simulation.states[position(&system, state)][row];
        assert!(near(got, *value), "{name}: {state}({time}) = {got}, not {value}");
    }
    for (state, value) in &case.end {
        let got = end(&system, &simulation, state);
        assert!(near(got, *value), "{name}: {state} = {got}, not {value}");
    }
}

#[test]
fn every_system_does_what_its_source_says() {
    let models = documents("tests/simulations", "fdc");
    let expected = documents("tests/simulations", "expected");
    assert_eq!(models.len(), expected.len(), "each model has a file with what is expected");
    for ((name, text), (other, expectation)) in models.iter().zip(&expected) {
        assert_eq!(name, other);
        cases(expectation).iter().for_each(|case| check(name, text, case));
    }
}

fn text(name: &str) -> String {
    let all = documents("tests/simulations", "fdc");
    all.into_iter().find(|(own, _)| own == name).expect(name).1
}

/// `u = 2` drives with rate 1 for a second, `u = 0` stops within another, then the block sticks
/// until `u = -3` moves it.
#[test]
fn held_controls_restart_the_integration_at_their_rows() {
    let controls = Controls::Held {
        times: vec![0.0, 1.0, 2.5],
        rows: vec![vec![2.0], vec![0.0], vec![-3.0]],
        is_stretched: true,
    };
    let (system, simulation) = run(&text("sticks"), &[], &controls, &Options::default());
    let events: Vec<_> =
        simulation.events.iter().map(|event| (event.time, event_name(event.kind))).collect();
    let expected = [(2.0, "enters_sliding"), (2.5, "leaves_down")];
    assert!(events.len() == 2, "{events:?}");
    assert!(events.iter().zip(expected).all(|(a, b)| near(a.0, b.0) && a.1 == b.1), "{events:?}");
    assert!(near(end(&system, &simulation, "v"), -1.0));
    assert!(near(end(&system, &simulation, "x"), 0.5 + 0.5 - 0.25));
    assert!(near(simulation.objective.expect("the end is reached"), 4.0 + 0.5 * 9.0));
}

/// Example (2.3): `x = -1 + 3 t` until 1/3, then `x = t - 1/3`.
#[test]
fn states_are_given_at_the_times_asked_for() {
    let text = fdcc_tests::models::text_of("crossing");
    let times = vec![0.0, 0.25, 1.0 / 3.0, 1.0, 2.0];
    let options = Options { times: times.clone(), ..Options::default() };
    let (_, simulation) = run(&text, &[], &Controls::Guess, &options);
    assert_eq!(simulation.time, times);
    for (got, exact) in simulation.states[0].iter().zip([-1.0, -0.25, 0.0, 2.0 / 3.0, 5.0 / 3.0]) {
        assert!(near(*got, exact), "{got}, not {exact}");
    }
    assert!(near(simulation.objective.expect("the end is reached"), 134.0 / 81.0));
}

#[test]
fn too_many_steps_end_with_the_trajectory_so_far() {
    let options = Options { max_steps: 10, ..Options::default() };
    let (_, simulation) = run(&text("block_on_table"), &[], &Controls::Guess, &options);
    assert!(matches!(simulation.status, Status::StepLimit) && simulation.time.len() > 5);
}

/// `A cos(t)`, `-A sin(t)` beside a decay from 1e6: nothing depends on the unit that lengths are
/// written in.
#[test]
fn small_oscillators_are_as_exact_as_large_ones() {
    for amplitude in [1e-300, 1e-100, 1e-30, 1e-12, 1.0, 1e12, 1e100] {
        for (x, v) in [(amplitude, 0.0), (0.0, amplitude)] {
            let text = format!(
                "time t in [0, 10]\nstate X start 1e6\nstate x start {x:e}\nstate v start {v:e}\n\
                 dynamics {{\n X' = -X/10\n x' = v\n v' = -x\n}}\n"
            );
            let (system, simulation) = run(&text, &[], &Controls::Guess, &Options::default());
            let (sine, cosine) = 10.0_f64.sin_cos();
            let exact = [("x", x * cosine + v * sine), ("v", v * cosine - x * sine)];
            for (name, exact) in exact {
                let got = end(&system, &simulation, name);
                assert!(
                    (got - exact).abs() <= 1e-8 * amplitude,
                    "{amplitude}: {name} = {got}, not {exact}"
                );
            }
        }
    }
}

/// The same crossings at every scale.
#[test]
fn small_oscillators_cross_surfaces_when_large_ones_do() {
    for amplitude in [1e-30, 1e-12, 1.0, 1e12, 1e100] {
        let text = format!(
            "time t in [0, 10]\nstate x start {amplitude:e}\nstate v start 0\nstate y start \
             0\nsurface s = x\n\
             dynamics {{\n x' = v\n v' = -x\n y' in Sgn(s)\n}}\n"
        );
        let (_, simulation) = run(&text, &[], &Controls::Guess, &Options::default());
        let times: Vec<f64> = simulation.events.iter().map(|event| event.time).collect();
        let exact = [0.5, 1.5, 2.5].map(|turns| turns * std::f64::consts::PI);
        assert!(
            times.len() == 3 && times.iter().zip(exact).all(|(a, b)| near(*a, b)),
            "{amplitude}: {times:?}"
        );
    }
}

/// `x = A e^-t` moves `y' = 2 x/A - Sgn(y)`: `y` leaves 0 upwards, turns at `ln 2`, and is held
/// from the root of `2 (1 - e^-t) = t` on, whatever `A` is. A force that begins late is followed.
#[test]
fn states_of_very_different_sizes_do_not_blur_each_other() {
    for amplitude in [1e-200, 1e-100, 1e-40, 1.0, 1e40, 1e100, 1e200] {
        let text = format!(
            "time t in [0, 10]\nstate x start {amplitude:e}\nstate y start 0\nstate w start 0\n\
             state late start 0\nsurface s = y\ndynamics {{\n x' = -x\n \
             y' in 2*x/{amplitude:e} - Sgn(s)\n w' = selected(Sgn(s))\n \
             late' = exp(-((t - 5)/0.1)^2)\n}}\n"
        );
        let (system, simulation) = run(&text, &[], &Controls::Guess, &Options::default());
        let times: Vec<f64> = simulation.events.iter().map(|event| event.time).collect();
        // SciPy's brentq of 2 (1 - exp(-t)) - t in [1, 2].
        let rest = 1.593_624_260_040_04;
        assert!(times.len() == 1 && near(times[0], rest), "{amplitude}: {times:?}");
        let held = 2.0 * ((-rest).exp() - (-10.0_f64).exp());
        let late = 0.1 * std::f64::consts::PI.sqrt();
        for (name, exact) in [("w", rest + held), ("late", late)] {
            let got = end(&system, &simulation, name);
            assert!((got - exact).abs() <= 1e-8, "{amplitude}: {name} = {got}, not {exact}");
        }
    }
}

/// What is 0 but for rounding, and what is 0 but for the errors of other states, asks for less than
/// ten times the steps of the oscillator alone, which takes 340.
#[test]
fn states_that_stay_at_zero_cost_little() {
    let text = "time t in [0, 10]\nstate x start 1\nstate v start 0\nstate noise start 0\nstate \
                energy start 0\n\
                dynamics {\n x' = v\n v' = -x\n noise' = sin(t)^2 + cos(t)^2 - 1\n energy' = x^2 + \
                v^2 - 1\n}\n";
    let (_, simulation) = run(text, &[], &Controls::Guess, &Options::default());
    assert!(matches!(simulation.status, Status::Completed), "{:?}", simulation.status);
    assert!(simulation.counts.steps < 3000, "{:?}", simulation.counts);
}

#[test]
fn events_have_the_states_on_both_sides() {
    let (system, simulation) = run(&text("bouncing"), &[], &Controls::Guess, &Options::default());
    let (event, v) = (&simulation.events[0], position(&system, "v"));
    assert!(
        near(event.before[v], -20.0_f64.sqrt()) && near(event.after[v], 0.5 * 20.0_f64.sqrt()),
        "{event:?}"
    );
    let rows: Vec<usize> =
        (0..simulation.time.len()).filter(|&k| simulation.time[k] == event.time).collect();
    assert_eq!(rows.len(), 2, "the trajectory has both sides of a jump");
}
