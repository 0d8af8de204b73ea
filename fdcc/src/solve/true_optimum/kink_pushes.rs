//! Kinks onto which a motion is pushed.
//!
//! That `e = 0` on a kink of `|e|` is no condition of the model: what it costs to leave it is
//! bounded, by 1 for each unit of `e`, so that costates are continuous where the motion comes to
//! it. A chain of phases has it as a condition, whose multiplier may be an impulse: then many short
//! turns on the way there are better (A. T. Fuller, *Relay control systems optimized for various
//! performance criteria*, 1960).

use super::contacts::Contacts;
use super::tuning::kink_pushes::CONTINUOUS;
use fdcc_compiler::{Arc, is_kink};

impl Contacts<'_> {
    /// Whether a costate jumps where nothing begins but motions along kinks.
    pub fn is_pushed_onto_a_kink(&self) -> bool {
        (1..self.located.structure.phases.len())
            .any(|j| self.begins_on_kinks_alone(j) && self.jump_of_costates(j) > CONTINUOUS)
    }

    fn begins_on_kinks_alone(&self, j: usize) -> bool {
        let [before, after] = [j - 1, j].map(|it| &self.located.structure.phases[it]);
        let states = self.limits.iter().filter(|it| it.state.is_some()).count();
        // Where controls act on a kink at once nothing is pushed.
        let is_kink_row = |limit: usize| {
            let row = limit.checked_sub(states).map(|at| &self.model.path[at].place.name);
            row.is_some_and(|it| is_kink(it)) && self.limits[limit].order > Some(0)
        };
        let pairs = before.contacts.iter().zip(&after.contacts).enumerate();
        let changed: Vec<usize> = pairs.filter(|it| it.1.0 != it.1.1).map(|it| it.0).collect();
        let switches = self.model.switches();
        let modes = before.modes.iter().zip(&after.modes).zip(&switches);
        let switched: Vec<bool> =
            modes.filter(|it| it.0.0 != it.0.1).map(|it| is_kink(&it.1.place.name)).collect();
        let is_anything = !changed.is_empty() || !switched.is_empty();
        let is_touched = after.touches.iter().any(|it| *it != Arc::Free);
        is_anything
            && after.jump.is_none()
            && !is_touched
            && changed.into_iter().all(is_kink_row)
            && switched.into_iter().all(|it| it)
    }

    /// The largest jump of a costate at the beginning of a phase, for its largest value.
    fn jump_of_costates(&self, j: usize) -> f64 {
        let phases = &self.located.outcome.phases;
        let jump = |state: usize| {
            let column = |j: usize| &phases[j].trajectory.costates[state];
            let all = (0..phases.len()).flat_map(|j| column(j).iter());
            let largest = all.fold(f64::MIN_POSITIVE, |most, it| most.max(it.abs()));
            let [before, after] = [column(j - 1).last(), column(j).first()];
            let gap = before.zip(after).map_or(0.0, |(before, after)| (after - before).abs());
            gap / largest
        };
        (0..self.model.states.len()).map(jump).fold(0.0, f64::max)
    }
}
