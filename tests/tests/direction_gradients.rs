//! Derivatives of systems with isotropic friction: forward, adjoint and central differences of
//! simulations agree, through arrivals, rest, departures and passing through 0.

use fdcc_compiler::compile_sensitivities;
use fdcc_runtime::sensitivity::{Quantity, gradient, perturbed};
use fdcc_runtime::simulate::{Controls, Options, Status, System, simulate};
use fdcc_tests::documents;
use fdcc_tests::models::meaning;

const STEP: f64 = 1e-5;

fn quantities(system: &System, text: &str) -> Vec<Quantity> {
    let named = |name: &str| text.contains(&format!("param {name} "));
    let parameters = (0..system.parameters.len()).filter(|&i| named(&system.parameters[i].name));
    let starts = (0..system.layout.x).filter(|&i| !system.states[i].hidden);
    parameters.map(Quantity::Parameter).chain(starts.map(Quantity::Start)).collect()
}

/// The objective at `+-STEP` in one quantity; nothing where the events are others.
fn difference(
    system: &System,
    quantity: &Quantity,
    options: &Options,
    events: usize,
) -> Option<f64> {
    let value = |amount: f64| {
        let (system, controls) = perturbed(system, &Controls::Guess, quantity, amount);
        let simulation = simulate(&system, &controls, options);
        simulation.objective.filter(|_| simulation.events.len() == events)
    };
    Some((value(STEP)? - value(-STEP)?) / (2.0 * STEP))
}

#[test]
fn derivatives_through_isotropic_friction_are_those_of_differences() {
    let options = Options { rtol: 1e-11, atol: Some(1e-13), ..Options::default() };
    let mut compared = 0;
    for (name, text) in documents("tests/simulations", "fdc") {
        if !text.contains("Dir(") {
            continue;
        }
        let states = compile_sensitivities(&meaning(&text)).expect("it can be simulated").states;
        for state in states.iter().filter(|state| !state.hidden) {
            let text = format!("{text}\nminimize {}(end)\n", state.name);
            let system = compile_sensitivities(&meaning(&text)).expect("it can be simulated");
            let quantities = quantities(&system, &text);
            let found = match gradient(&system, &Controls::Guess, &options, &quantities) {
                Ok(found) => found,
                Err(stopped) if !matches!(stopped.status, Status::Completed) => continue,
                Err(_) => panic!("{name}: no gradient"),
            };
            assert!(found.agreement <= 1e-10, "{name}, {}: {}", state.name, found.agreement);
            for (quantity, exact) in quantities.iter().zip(&found.adjoint) {
                let events = found.simulation.events.len();
                let Some(difference) = difference(&system, quantity, &options, events) else {
                    continue;
                };
                let error = (exact - difference).abs() / exact.abs().max(1.0);
                assert!(
                    error <= 1e-5,
                    "{name}, {} by {quantity:?}: {exact}, not {difference}",
                    state.name
                );
                compared += 1;
            }
        }
    }
    assert!(compared > 200, "{compared} derivatives");
}
