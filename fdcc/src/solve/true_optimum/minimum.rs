//! Whether the controls minimise the Hamiltonian over everything that they may be, and not only
//! near what they are (Pontryagin): where it has several minima, a short time at another one may
//! be worth having though no small change of the controls is.

use super::insertion::{Least, at_point, least};
use super::range::{Range, ranges};
use super::tuning::minimum::{MOST_TOGETHER, PARTS};
use super::{Located, Search};
use fdcc_compiler::Arc;

impl Search<'_> {
    /// By how much another control makes the Hamiltonian less, at some points of each phase, for
    /// its largest size.
    pub(super) fn gain(&self, located: &Located) -> f64 {
        let sizes = located.outcome.phases.iter().map(|it| it.trajectory.hamiltonian.scale);
        let size = sizes.fold(f64::MIN_POSITIVE, f64::max);
        let phases = 0..located.structure.phases.len();
        phases.map(|j| self.gain_in_phase(located, j)).fold(0.0, f64::max) / size
    }

    fn gain_in_phase(&self, located: &Located, j: usize) -> f64 {
        let outcome = &located.outcome.phases[j];
        let own = &outcome.trajectory;
        let mut phase = located.structure.phases[j].clone();
        phase.arcs.fill(Arc::Free);
        let gain_at = |part: &f64| {
            let last = own.time.len() - 1;
            let k = (part * last as f64) as usize;
            let point = self.point(outcome, &|column: &[f64]| column[k]);
            let Some(chain) = at_point(self.model, &phase, &point) else { return 0.0 };
            let value = |controls: &[f64]| match least(&chain, Some(controls), self.stop) {
                Least::Value(value, _) => Some(value),
                _ => None,
            };
            let controls: Vec<f64> = own.controls.iter().map(|it| it[k.min(last - 1)]).collect();
            let Some(near) = value(&controls) else { return 0.0 };
            let others = self.samples(located, &controls);
            let others = others.iter().filter_map(|it| value(it));
            others.map(|other| near - other).fold(0.0, f64::max)
        };
        PARTS.iter().map(gain_at).fold(0.0, f64::max)
    }

    /// Each control at several values between its bounds, the others as they are; and all of a few
    /// at ends of their ranges, as what one gains may depend on another.
    fn samples(&self, located: &Located, controls: &[f64]) -> Vec<Vec<f64>> {
        let with = |at: usize, value: f64| {
            let mut other = controls.to_vec();
            other[at] = value;
            other
        };
        let ranges = ranges(&self.problem.controls, &located.outcome.phases);
        let each = ranges.iter().enumerate();
        let alone =
            each.flat_map(|(at, range)| range.tried().into_iter().map(move |value| (at, value)));
        alone.map(|(at, value)| with(at, value)).chain(corners(&ranges)).collect()
    }
}

/// All combinations of the ends of a few ranges.
fn corners(ranges: &[Range]) -> Vec<Vec<f64>> {
    if !(2..=MOST_TOGETHER).contains(&ranges.len()) {
        return Vec::new();
    }
    ranges.iter().fold(vec![Vec::new()], |all, range| {
        let with = |corner: &Vec<f64>| range.ends().map(|end| [&corner[..], &[end]].concat());
        all.iter().flat_map(with).collect()
    })
}
