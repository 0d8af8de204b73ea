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
            stretch(&mut controls, system.interval, moved.interval);
            (moved, controls)
        }
        Quantity::Start(at) => {
            let mut moved = system.clone();
            moved.start[at] += amount;
            (moved, controls)
        }
        Quantity::Control { row, control } => {
            if let Controls::Held { rows, .. } = &mut controls {
                rows[row][control] += amount;
            }
            (system.clone(), controls)
        }
    }
}

fn stretch(controls: &mut Controls, [old_first, old_last]: [f64; 2], [first, last]: [f64; 2]) {
    let Controls::Held { times, is_stretched: true, .. } = controls else { return };
    if (old_first, old_last) != (first, last) && old_last > old_first {
        let factor = (last - first) / (old_last - old_first);
        times.iter_mut().for_each(|time| *time = first + factor * (*time - old_first));
    }
}
