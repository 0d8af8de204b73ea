//! Whether the controls minimise the Hamiltonian: its slope by a control points away from the bound that is active, and is zero where none is.
//!
//! ```text
//!     dH/du > 0  only at the lower bound,      dH/du < 0  only at the upper bound
//! ```
//!
//! The slope is that of the Lagrangian without the multipliers of bounds, over the length of the interval: costates, path constraints and running cost are in it,
//! what the solver says about bounds is not. What is left to gain,
//!
//! ```text
//!     dH/du (u - lower)   where dH/du > 0,        -dH/du (upper - u)   where dH/du < 0
//! ```
//!
//! is an amount of `H`, and is compared with the size of its terms.

use crate::nlp::{Derivatives, Nlp, Solution};
use crate::problem::Bounds;
use crate::transcribe::TranscribedNlp;
use crate::transcribe::interval::Signal;

/// A smaller part of the size of the Hamiltonian is no gain.
const GAIN: f64 = 1e-3;

/// For each of so many controls, the part of the time on which the rule of signs is violated, over this time and with terms of this size.
pub(crate) fn violations(
    controls: usize,
    nlp: &mut TranscribedNlp,
    solution: &Solution,
    (duration, size): (f64, f64),
) -> Vec<f64> {
    let slopes = slopes(nlp, solution);
    let gains = (0..controls).map(|control| gains(nlp, &solution.v, &slopes, control));
    let part = |k: usize| nlp.mesh().relative(k) / nlp.chain().intervals as f64;
    let is_large = |k: usize, gain: f64| gain > GAIN * size * duration.abs() * part(k);
    let violated = |gains: Vec<f64>| {
        let large = gains.iter().enumerate().filter(|(k, gain)| is_large(*k, **gain));
        large.map(|(k, _)| part(k)).fold(0.0, |sum: f64, part| (sum + part).min(1.0))
    };
    gains.map(violated).collect()
}

/// The gradient of the Lagrangian without the multipliers of bounds.
pub(crate) fn slopes(nlp: &mut TranscribedNlp, solution: &Solution) -> Vec<f64> {
    let rows = &solution.multipliers.rows;
    let mut derivatives = Derivatives::new(nlp);
    nlp.derivatives(&solution.v, 1.0, rows, &mut derivatives);
    let Derivatives { mut gradient, jacobian, .. } = derivatives;
    nlp.jacobian_structure().transposed_multiply_add(&jacobian, rows, &mut gradient);
    gradient
}

/// What could be gained on each interval, times its length; a value that two intervals share counts for the later one.
fn gains(nlp: &TranscribedNlp, v: &[f64], slopes: &[f64], control: usize) -> Vec<f64> {
    let chain = nlp.chain();
    let mut gains = vec![0.0; chain.intervals];
    let slots = nlp.interval().slots.iter().enumerate();
    for (place, _) in slots.filter(|(_, slot)| slot.signal == Signal::Control(control)) {
        for (k, gain) in gains.iter_mut().enumerate() {
            let variable = chain.state(k).start + place;
            *gain += self::gain(&nlp.variable_bounds()[variable], v[variable], slopes[variable]);
        }
    }
    gains
}

/// Without a bound there is always something to gain.
fn gain(bounds: &Bounds, value: f64, slope: f64) -> f64 {
    let room = if slope > 0.0 { value - bounds.lower } else { bounds.upper - value };
    let room = if room.is_finite() { room.max(0.0) } else { value.abs().max(1.0) };
    slope.abs() * room
}

#[cfg(test)]
mod tests {
    use super::gain;
    use crate::problem::Bounds;

    #[test]
    fn a_slope_is_a_gain_unless_it_points_away_from_the_active_bound() {
        let bounds = Bounds { lower: -1.0, upper: 2.0 };
        assert_eq!([gain(&bounds, -1.0, 3.0), gain(&bounds, 2.0, -3.0), gain(&bounds, 0.5, 0.0)], [0.0; 3]);
        assert_eq!(
            [gain(&bounds, -1.0, -3.0), gain(&bounds, 2.0, 3.0), gain(&bounds, 0.0, 0.5)],
            [9.0, 9.0, 0.5]
        );
        assert_eq!(gain(&Bounds::FREE, 0.1, -0.25), 0.25);
    }
}
