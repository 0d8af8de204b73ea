//! The signs of multipliers of states and path conditions that are kept at their bounds or touch
//! them.
//!
//! Where a limit is on an arc, `nu` is the multiplier of `c^(q) = 0`, and that of the bound itself
//! is
//!
//! ```text
//! mu = (-1)^q d^q nu / dt^q
//! ```
//!
//! (by parts, `q` times); its sign is that of the bound, or the motion would rather leave it. The
//! multiplier of `c = 0` at a touch point has that sign, too.

use super::contacts::Contacts;
use fdcc_compiler::Arc;
use fdcc_runtime::solution::Trajectory;

/// An arc or a touch point, at the beginning of a phase, whose multiplier has the wrong sign.
pub(crate) struct Wrong {
    pub phase: usize,
    pub limit: usize,
    /// By how much, for its largest value.
    pub part: f64,
}

impl Contacts<'_> {
    /// What contradicts that a limit is at its bound, most of all.
    pub fn wrong_sign(&self) -> Option<Wrong> {
        let mut all = Vec::new();
        for (j, phase) in self.located.structure.phases.iter().enumerate() {
            for limit in 0..self.limits.len() {
                let arc = (phase.contacts[limit] != Arc::Free)
                    .then(|| self.wrong_of_arc(j, limit, phase.contacts[limit]));
                let touch = (j > 0 && phase.touches[limit] != Arc::Free)
                    .then(|| self.wrong_of_touch(j, limit, phase.touches[limit]));
                let both = arc.into_iter().chain(touch);
                all.extend(both.map(|part| Wrong { phase: j, limit, part }));
            }
        }
        all.into_iter().max_by(|a, b| a.part.total_cmp(&b.part))
    }

    /// Gives path conditions on arcs the multipliers of their bounds, in a trajectory of all
    /// phases.
    pub fn put_multipliers(&self, whole: &mut Trajectory) {
        let mut first = 0;
        for (j, phase) in self.located.structure.phases.iter().enumerate() {
            let time = &self.located.outcome.phases[j].trajectory.time;
            let states = self.limits.iter().filter(|it| it.state.is_some()).count();
            for limit in (states..self.limits.len()).filter(|at| phase.contacts[*at] != Arc::Free) {
                let order = self.limits[limit].order.unwrap_or(0);
                let nu = self.located.outcome.phases[j].trajectory.path_multipliers
                    [self.row(j, limit)]
                .clone();
                let mu = (0..order).fold(nu, |own, _| falls(time, &own));
                whole.path_multipliers[limit - states][first..first + mu.len()]
                    .copy_from_slice(&mu);
            }
            first += time.len() - 1;
        }
    }

    fn wrong_of_arc(&self, j: usize, limit: usize, arc: Arc) -> f64 {
        let own = self.multipliers(j, limit);
        let largest = own.iter().fold(f64::MIN_POSITIVE, |a: f64, it| a.max(it.abs()));
        let order = self.limits[limit].order.unwrap_or(0);
        let mu = (0..order).fold(own, |own, _| own.windows(2).map(|it| it[0] - it[1]).collect());
        mu.iter().map(|it| -side(arc) * it / largest).fold(f64::NEG_INFINITY, f64::max)
    }

    fn wrong_of_touch(&self, j: usize, limit: usize, arc: Arc) -> f64 {
        let located = self.located;
        let name = located.chain.phases[j].path.origin(self.row(j, limit)).label;
        let kappa = located.link_multiplier(j, &format!("{name} reached")).unwrap_or(0.0);
        let duration = located.structure.ends()[1] - located.structure.ends()[0];
        -side(arc) * kappa * self.ranges[limit] / (self.size(j) * duration)
    }
}

/// Minus the derivative by time of what is known on intervals.
fn falls(time: &[f64], values: &[f64]) -> Vec<f64> {
    let middle = |k: usize| 0.5 * (time[k] + time[k + 1]);
    let last = values.len() - 1;
    let slope = |k: usize| {
        let (a, b) = (k.saturating_sub(1), (k + 1).min(last));
        if a == b { 0.0 } else { (values[a] - values[b]) / (middle(b) - middle(a)) }
    };
    (0..values.len()).map(slope).collect()
}

/// 1 where a bound is a lower one.
fn side(arc: Arc) -> f64 {
    match arc {
        Arc::Lower => 1.0,
        Arc::Free => 0.0,
        Arc::Upper => -1.0,
    }
}
