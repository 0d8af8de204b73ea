//! Between which values a control goes, and how far that is.

use super::tuning::range::{FAR, LEAST_OF_UNIT, SAMPLES};
use fdcc_runtime::problem::{Bounds, Variable};
use fdcc_runtime::solution::Outcome;

/// The bounds of a control, and what distances from them are compared with.
pub(crate) struct Range {
    pub bounds: Bounds,
    /// The distance of its bounds, or twice its largest value where they are farther away: a bound
    /// is no statement about a size (decision 30).
    pub width: f64,
}

/// Those of all controls, by what they do in all of these phases.
pub(crate) fn ranges(controls: &[Variable], phases: &[Outcome]) -> Vec<Range> {
    let of = |(at, control): (usize, &Variable)| {
        let values = phases.iter().flat_map(|it| &it.trajectory.controls[at]);
        let largest = values.fold(LEAST_OF_UNIT * control.unit, |most, it| most.max(it.abs()));
        let bounds = control.bounds;
        Range { bounds, width: (bounds.upper - bounds.lower).min(2.0 * largest) }
    };
    controls.iter().enumerate().map(of).collect()
}

impl Range {
    /// Other values that are worth a try: up to its width from 0, and up to many times that where
    /// its bounds are so far away.
    pub fn tried(&self) -> Vec<f64> {
        let Bounds { lower, upper } = self.bounds;
        let within = |far: f64| [lower.max(-far), upper.min(far)];
        let (near, far) = (within(self.width), within(FAR * self.width));
        let between = |[lower, upper]: [f64; 2]| {
            let step = (upper - lower) / SAMPLES as f64;
            (0..=SAMPLES).map(move |sample| lower + step * sample as f64)
        };
        between(near).chain(between(far).filter(|_| far != near)).collect()
    }
}
