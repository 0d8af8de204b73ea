//! How far quantities move: what differences between a solution and the true system are compared
//! with.
//!
//! A difference counts for how far its state moves over the whole time, in solution and replay
//! together: a block that moves by half a micrometre and misses by that misses by all of it, and a
//! pressure of 100 bar that moves by 1 Pa is not right because it is off by as little. A declared
//! unit says only what rounding is.

use super::tuning::motion::{ROUNDING, ROUNDING_OF_UNIT};
use fdcc_runtime::problem::Variable;

/// How far a quantity moves.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Motion {
    /// From its least to its largest value; of a vector that of the part that moves most.
    pub range: f64,
    /// Less is no difference.
    pub rounding: f64,
}

impl Motion {
    /// Of all values that a quantity takes, the declared unit of which is `unit` in SI.
    fn new(values: &[f64], unit: f64) -> Self {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let [least, most] = if least <= most { [least, most] } else { [0.0; 2] };
        let rounding = (ROUNDING * least.abs().max(most.abs())).max(ROUNDING_OF_UNIT * unit);
        Motion { range: most - least, rounding }
    }

    /// Of what is as large as it is, wherever it goes.
    pub fn still(unit: f64) -> Self {
        Motion { range: 0.0, rounding: ROUNDING_OF_UNIT * unit }
    }

    /// Of states, each with all of its values.
    pub fn of_states(states: &[&Variable], values: impl Fn(usize) -> Vec<f64>) -> Vec<Motion> {
        let own = states.iter().enumerate().map(|(at, it)| Motion::new(&values(at), it.unit));
        let own: Vec<Motion> = own.collect();
        let vector = |at: usize| states[at].name.rsplit_once('.').map(|(vector, _)| vector);
        let range = |at: usize| {
            let beside = (0..own.len()).filter(|other| {
                *other == at || vector(at).is_some_and(|it| vector(*other) == Some(it))
            });
            beside.fold(0.0, |most: f64, other| most.max(own[other].range))
        };
        (0..own.len()).map(|at| Motion { range: range(at), ..own[at] }).collect()
    }

    /// A difference as a part of the motion; 0 where it is rounding.
    pub fn part(&self, difference: f64) -> f64 {
        if difference <= self.rounding { 0.0 } else { difference / self.range.max(self.rounding) }
    }
}
