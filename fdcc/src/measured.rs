//! What a simulation says of an objective of measured data.

use fdcc_compiler::{Along, Model};
use fdcc_runtime::simulate::{Controls, Options, Simulation, Status, System, simulate};

/// Gives a simulation its objective, where that reads states at the times of rows: it is simulated
/// once more, to stop there.
pub(crate) fn add_objective(
    model: &Model,
    system: &System,
    controls: &Controls,
    options: &Options,
    simulation: &mut Simulation,
) {
    if !model.objective_reads_sums() || !matches!(simulation.status, Status::Completed) {
        return;
    }
    let times = model.times_of_rows();
    let options = Options { times, tape: false, extremes: false, ..options.clone() };
    let stopped = simulate(system, controls, &options);
    let state = |k: usize| -> Vec<f64> { stopped.states.iter().map(|it| it[k]).collect() };
    let states: Vec<Vec<f64>> = (0..stopped.time.len()).map(state).collect();
    let at = |time: f64| {
        let k = stopped.time.iter().position(|it| *it == time)?;
        Some(&states[k][..])
    };
    simulation.objective =
        model.objective_along(&Along { ends: [&system.start, &stopped.end], at: &at });
}
