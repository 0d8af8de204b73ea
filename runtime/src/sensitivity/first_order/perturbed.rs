//! A system and its controls with one quantity moved: for derivatives from one side, and for tests
//! by differences.

use super::quantity::Quantity;
use crate::simulate::{Controls, System};

/// The system and the controls where a quantity is larger by `amount`. Rows of controls keep their
/// normalised times.
pub fn perturbed(
    system: &System,
    controls: &Controls,
    quantity: &Quantity,
    amount: f64,
) -> (System, Controls) {
    let mut controls = controls.clone();
    match *quantity {
        Quantity::Parameter(at) => {
            let mut values = system.parameter_values();
            values[at] += amount;
            let moved = system.with_parameters(&values);
            controls.stretch(system.interval, moved.interval);
            (moved, controls)
        }
        Quantity::Start(at) => {
            let mut moved = system.clone();
            moved.start[at] += amount;
            (moved, controls)
        }
        Quantity::Control { row, control } => {
            controls.rows_mut()[row][control] += amount;
            (system.clone(), controls)
        }
    }
}
