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
    /// How large other values may be: its width, or its unit where that is more, as what is 0
    /// throughout need not be small elsewhere.
    near: f64,
    /// Whether it is 0 throughout.
    is_zero: bool,
}

/// Those of all controls, by what they do in all of these phases.
pub(crate) fn ranges(controls: &[Variable], phases: &[Outcome]) -> Vec<Range> {
    let of = |(at, control): (usize, &Variable)| {
        let values = phases.iter().flat_map(|it| &it.trajectory.controls[at]);
        let least = LEAST_OF_UNIT * control.unit;
        let largest = values.fold(least, |most, it| most.max(it.abs()));
        let bounds = control.bounds;
        let width = (bounds.upper - bounds.lower).min(2.0 * largest);
        Range { bounds, width, near: width.max(control.unit), is_zero: largest == least }
    };
    controls.iter().enumerate().map(of).collect()
}

impl Range {
    /// What a slope is worth over the range: over its width; of a control that is 0 throughout,
    /// which says nothing of its size, over as much of it as would matter, and its bounds allow.
    pub fn worth(&self, slope: f64, that_matters: f64) -> f64 {
        let Bounds { lower, upper, .. } = self.bounds;
        let allowed = (upper - lower).min(that_matters);
        slope * if self.is_zero { self.width.max(allowed) } else { self.width }
    }

    /// The ends of what is nearer to 0 than this, or near to it.
    fn within(&self, far: f64) -> [f64; 2] {
        [self.bounds.lower.max(-far), self.bounds.upper.min(far)]
    }

    /// The ends of the range in which other values are looked for first.
    pub fn ends(&self) -> [f64; 2] {
        self.within(self.near)
    }

    /// Other values that are worth a try: up to its size from 0, and up to many times that where
    /// its bounds are so far away.
    pub fn tried(&self) -> Vec<f64> {
        let (near, far) = (self.within(self.near), self.within(FAR * self.near));
        let between = |[lower, upper]: [f64; 2]| {
            let step = (upper - lower) / SAMPLES as f64;
            (0..=SAMPLES).map(move |sample| lower + step * sample as f64)
        };
        between(near).chain(between(far).filter(|_| far != near)).collect()
    }
}
