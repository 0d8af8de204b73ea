//! Derivatives from both sides, where there is no derivative: each from trajectories with the modes
//! of its side.
//!
//! The gradients at `q + d`, `q + d/4`, `q + d/16` approach the one-sided derivative like `d` where
//! events move smoothly and like `sqrt d` at a grazing; Aitken's extrapolation takes out either.

use super::Objective;
use super::perturbed::perturbed;
use super::quantity::{Gradient, Quantity};
use crate::sensitivity::linearised::linearisation::Lineariser;
use crate::sensitivity::linearised::variational_equation::LinearTape;
use crate::simulate::{Controls, Options, Status, System, simulate};

/// The largest of the three distances, relative to `max(1, |q|)`.
const DISTANCE: f64 = 1e-7;

/// Below and above each quantity; nothing where a side has no trajectory to the end.
pub fn one_sided(
    system: &System,
    controls: &Controls,
    options: &Options,
    quantities: &[Quantity],
) -> Vec<[Option<f64>; 2]> {
    let side = |quantity: &Quantity, sign: f64| {
        let distance = sign * DISTANCE * value(system, controls, quantity).abs().max(1.0);
        let near = |part: f64| {
            let (system, controls) = perturbed(system, controls, quantity, part * distance);
            derivative(&system, &controls, options, quantity)
        };
        Some(extrapolated([near(1.0)?, near(0.25)?, near(0.0625)?]))
    };
    quantities.iter().map(|quantity| [side(quantity, -1.0), side(quantity, 1.0)]).collect()
}

/// What a quantity is.
pub(crate) fn value(system: &System, controls: &Controls, quantity: &Quantity) -> f64 {
    match *quantity {
        Quantity::Parameter(at) => system.parameters[at].value,
        Quantity::Start(at) => system.start[at],
        Quantity::Control { row, control } => controls.rows()[row][control],
    }
}

/// By the adjoint alone.
fn derivative(
    system: &System,
    controls: &Controls,
    options: &Options,
    quantity: &Quantity,
) -> Option<f64> {
    let simulation = simulate(system, controls, &Options { tape: true, ..options.clone() });
    let lineariser = Lineariser::new(system, controls);
    let objective = Objective::new(&lineariser, &simulation)?;
    let tape =
        simulation.tape.as_ref().filter(|_| matches!(simulation.status, Status::Completed))?;
    let zero = Gradient::zero(system, controls);
    let gradient =
        super::adjoint(&LinearTape::new(&lineariser, tape), &objective, zero, &mut |_, _| ());
    Some(gradient.by(quantity)).filter(|value| value.is_finite())
}

fn extrapolated([first, second, third]: [f64; 3]) -> f64 {
    let (before, after) = (second - first, third - second);
    let is_settled = after.abs() <= 1e-9 * third.abs().max(1.0) || after.abs() >= before.abs();
    if is_settled { third } else { third - after * after / (after - before) }
}
