//! Time for a gradient by 2,000 control values, beside the simulation that it differentiates.
//!
//! `cargo bench -p fdcc-tests --bench gradients`

use divan::Bencher;
use fdcc_compiler::compile_sensitivities;
use fdcc_runtime::sensitivity::{Quantity, gradient};
use fdcc_runtime::simulate::{Controls, Options, System, simulate};
use fdcc_tests::models::{load, meaning, solve, text_of};

fn main() {
    divan::main();
}

/// The race car, with the controls of its solution on 1000 intervals.
fn race_car() -> (System, Controls) {
    let mut model = meaning(&text_of("racecar"));
    let trajectory = solve(&load("racecar", &[], &[])).trajectory;
    let mut times = trajectory.time;
    model.set_free("T", times[times.len() - 1]);
    times.pop();
    let rows =
        (0..times.len()).map(|k| trajectory.controls.iter().map(|column| column[k]).collect());
    let controls = Controls::Held { rows: rows.collect(), times, is_stretched: true };
    (compile_sensitivities(&model).expect("it can be simulated"), controls)
}

fn options(tape: bool) -> Options {
    Options { tape, ..Options::default() }
}

#[divan::bench]
fn simulation(bencher: Bencher) {
    let (system, controls) = race_car();
    bencher.bench_local(|| simulate(&system, &controls, &options(false)));
}

#[divan::bench]
fn simulation_with_tape(bencher: Bencher) {
    let (system, controls) = race_car();
    bencher.bench_local(|| simulate(&system, &controls, &options(true)));
}

/// By the adjoint, with two forward directions to compare: at most 5 simulations.
#[divan::bench]
fn by_2000_controls(bencher: Bencher) {
    let (system, controls) = race_car();
    let by = |row| [0, 1].map(|control| Quantity::Control { row, control });
    let quantities: Vec<Quantity> = (0..1000).flat_map(by).collect();
    bencher.bench_local(|| gradient(&system, &controls, &options(false), &quantities));
}

/// The simulation, its costates and an empty gradient: what does not depend on the quantities.
#[divan::bench]
fn by_nothing(bencher: Bencher) {
    let (system, controls) = race_car();
    bencher.bench_local(|| gradient(&system, &controls, &options(false), &[]));
}
