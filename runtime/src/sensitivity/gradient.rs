//! The entry: a simulation, its gradient in both ways, and what they say of each other.

use super::first_order::{self, Objective};
use super::linearization::Linearizer;
use super::quantity::{Directions, Gradient, Quantity};
use crate::simulate::{Controls, Options, Simulation, Status, System, simulate};

/// The gradient of the objective of a system.
#[derive(Clone, Debug)]
pub struct Sensitivity {
    /// The simulation, with its tape.
    pub simulation: Simulation,
    /// The objective.
    pub value: f64,
    /// By each quantity, from forward sensitivities.
    pub forward: Vec<f64>,
    /// By each quantity, from the adjoint.
    pub adjoint: Vec<f64>,
    /// The largest difference between the two, relative to the largest sum of the sizes that a derivative is made of.
    pub agreement: f64,
    /// The derivative of each state at the end by each quantity.
    pub end: Vec<Vec<f64>>,
}

/// Differentiates; nothing but the simulation where it does not reach the end or there is no objective.
pub fn gradient(
    system: &System,
    controls: &Controls,
    options: &Options,
    quantities: &[Quantity],
) -> Result<Sensitivity, Box<Simulation>> {
    let simulation = simulate(system, controls, &Options { tape: true, ..options.clone() });
    let linearizer = Linearizer::new(system, controls);
    let objective = Objective::new(&linearizer, &simulation);
    let (Some(tape), Some(objective), Status::Completed) = (&simulation.tape, objective, &simulation.status)
    else {
        return Err(Box::new(simulation));
    };
    let directions = Directions::new(system, quantities);
    let end = first_order::forward(&linearizer, tape, &directions, &mut |_, _| ());
    let forward = first_order::along(&linearizer, &objective, &directions, &end);
    let zero = Gradient::zero(system, controls);
    let whole = first_order::adjoint(&linearizer, tape, &objective, zero, &mut |_, _| ());
    let adjoint: Vec<f64> = quantities.iter().map(|quantity| whole.by(quantity)).collect();
    Ok(Sensitivity {
        value: objective.value,
        agreement: agreement(
            &forward,
            &adjoint,
            first_order::size(&linearizer, &objective, &directions, &end),
        ),
        end: end.row_iter().map(|row| row.iter().copied().collect()).collect(),
        forward,
        adjoint,
        simulation,
    })
}

fn agreement(forward: &[f64], adjoint: &[f64], size: f64) -> f64 {
    let differences = forward.iter().zip(adjoint).map(|(a, b)| (a - b).abs());
    let largest =
        differences.fold(0.0, |sum: f64, value| if value.is_nan() { f64::NAN } else { sum.max(value) });
    if size > 0.0 { largest / size } else { largest }
}
