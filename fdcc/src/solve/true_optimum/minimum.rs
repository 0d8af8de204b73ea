//! Whether the controls minimise the Hamiltonian over everything that they may be, and not only
//! near what they are (Pontryagin): where it has several minima, a short time at another one may
//! be worth having though no small change of the controls is.

use super::insertion::{Least, at_point, least};
use super::structure::width;
use super::tuning::minimum::{PARTS, SAMPLES};
use super::{Located, Search};
use fdcc_compiler::Arc;
use fdcc_runtime::problem::Variable;

impl Search<'_> {
    /// By how much another control makes the Hamiltonian less, at some points of each phase, for
    /// its largest size.
    pub(super) fn gain(&self, located: &Located) -> f64 {
        let sizes = located.outcome.phases.iter().map(|it| it.trajectory.hamiltonian.size);
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
            let k = (part * (own.time.len() - 1) as f64) as usize;
            let point = self.point(outcome, &|column: &[f64]| column[k]);
            let Some(chain) = at_point(self.model, &phase, &point) else { return 0.0 };
            let value = |controls: &[f64]| match least(&chain, Some(controls), self.stop) {
                Least::Value(value, _) => Some(value),
                _ => None,
            };
            let controls: Vec<f64> = own.controls.iter().map(|it| it[k]).collect();
            let Some(near) = value(&controls) else { return 0.0 };
            let others = self.samples(located, &controls);
            let others = others.iter().filter_map(|it| value(it));
            others.map(|other| near - other).fold(0.0, f64::max)
        };
        PARTS.iter().map(gain_at).fold(0.0, f64::max)
    }

    /// Each control at several values between its bounds, the others as they are.
    fn samples(&self, located: &Located, controls: &[f64]) -> Vec<Vec<f64>> {
        let with = |at: usize, value: f64| {
            let mut other = controls.to_vec();
            other[at] = value;
            other
        };
        let each = self.problem.controls.iter().enumerate();
        each.flat_map(|(at, control)| {
            let [lower, upper] = reach(located, at, control);
            let step = (upper - lower) / SAMPLES as f64;
            (0..=SAMPLES).map(move |sample| (at, lower + step * sample as f64))
        })
        .map(|(at, value)| with(at, value))
        .collect()
    }
}

/// The bounds of a control; where one is infinite, how far it goes in all, and as far again.
fn reach(located: &Located, at: usize, control: &Variable) -> [f64; 2] {
    let values = located.outcome.phases.iter().flat_map(|it| &it.trajectory.controls[at]);
    let values: Vec<f64> = values.copied().collect();
    let (bounds, width) = (control.bounds, width(control.bounds, &values));
    match (bounds.lower.is_finite(), bounds.upper.is_finite()) {
        (true, true) => [bounds.lower, bounds.upper],
        (true, false) => [bounds.lower, bounds.lower + 2.0 * width],
        (false, true) => [bounds.upper - 2.0 * width, bounds.upper],
        (false, false) => [-2.0 * width, 2.0 * width],
    }
}
