//! Time for a simulation of the true system, from the compiled system to its end.
//!
//! `cargo bench -p fdcc-tests --bench simulation`; `tests/peers/solve_ivp.py` does the first two
//! with SciPy.

use divan::Bencher;
use fdcc_compiler::compile_simulation;
use fdcc_runtime::simulate::{Controls, Options, Status, System, simulate};
use fdcc_tests::models::{load, meaning, solve, text_of};

/// A mass between a spring and a belt, whose friction falls with the velocity: R. I. Leine, D. H.
/// van Campen, A. de Kraker, L. van den Steen: Stick-slip vibrations induced by alternate friction
/// models, Nonlinear Dynamics 16 (1998) 41-54.
const BELT: &str = "
time t in [0, 100]
state x start 0
state v start 0
surface slip = 0.2 - v
dynamics {
  x' = v
  v' in -x + Sgn(slip)/(1 + 3*abs(slip))
}
";

/// Three blocks on each other; a force that swings moves the lowest.
const THREE_BLOCKS: &str = "
time t in [0, 50]
state v1 start 0
state v2 start 0
state v3 start 0
surface floor = v1
surface middle = v2 - v1
surface top = v3 - v2
dynamics {
  v1' in 8*cos(t) - 3*Sgn(floor) + 2*Sgn(middle)
  v2' in -2*Sgn(middle) + 1/2*Sgn(top)
  v3' in -1/2*Sgn(top)
}
";

fn main() {
    divan::main();
}

fn compiled(text: &str) -> System {
    compile_simulation(&meaning(text)).expect("the model can be simulated")
}

/// The end is that of `tests/peers/solve_ivp.py`, to 1e-9.
fn bench(bencher: Bencher, system: &System, controls: &Controls, end: &[f64]) {
    let options = Options::default();
    let simulation = simulate(system, controls, &options);
    assert!(matches!(simulation.status, Status::Completed));
    assert!(
        end.iter().zip(&simulation.end).all(|(a, b)| (a - b).abs() < 1e-9),
        "{:?}",
        simulation.end
    );
    bencher.bench_local(|| simulate(system, controls, &options));
}

#[divan::bench]
fn belt(bencher: Bencher) {
    bench(bencher, &compiled(BELT), &Controls::Guess, &[0.770205160072, 0.2]);
}

#[divan::bench]
fn three_blocks(bencher: Bencher) {
    let end = [0.995087486661, 0.148262802897, -0.481028802150];
    bench(bencher, &compiled(THREE_BLOCKS), &Controls::Guess, &end);
}

/// The controls of the solution of `models/racecar.fdc`, 1000 intervals, on the true system.
#[divan::bench]
fn race_car_replay(bencher: Bencher) {
    let mut model = meaning(&text_of("racecar"));
    let trajectory = solve(&load("racecar", &[], &[])).trajectory;
    let mut times = trajectory.time;
    model.set_free("T", times[times.len() - 1]);
    times.pop();
    let rows =
        (0..times.len()).map(|k| trajectory.controls.iter().map(|column| column[k]).collect());
    let controls = Controls::Held { rows: rows.collect(), times, is_stretched: true };
    bench(bencher, &compile_simulation(&model).expect("it can be simulated"), &controls, &[]);
}
