//! Points between steps: a step of high order is long, and a straight line from its start to its
//! end is not what happens in between.

use super::Run;
use crate::simulate::steps::Step;
use crate::simulate::tuning::between::{ENOUGH, MOST_HALVINGS, SEEN, STRAIGHT};

impl Run<'_> {
    /// Notes points inside of the first `part` of a step, so many that straight lines between all
    /// points follow the states.
    pub fn note_between(&mut self, step: &Step, part: f64) {
        let is_asked = self.options.points_between && self.options.times.is_empty();
        if !is_asked || self.record.size() > ENOUGH {
            return;
        }
        let ends = [0.0, part].map(|theta| step.at(theta));
        self.record.widen(&ends);
        self.divide(step, [0.0, part], ends, MOST_HALVINGS);
    }

    fn divide(&mut self, step: &Step, [from, to]: [f64; 2], ends: [Vec<f64>; 2], halvings: usize) {
        let at = |share: f64| from + share * (to - from);
        let is_off = |share: f64| {
            let seen = step.at(at(share));
            let lines = ends[0].iter().zip(&ends[1]).map(|(a, b)| a + share * (b - a));
            let gaps = seen.iter().zip(lines).map(|(seen, line)| (seen - line).abs());
            gaps.zip(self.record.extents()).any(|(gap, extent)| gap > STRAIGHT * extent)
        };
        if halvings == 0 || !SEEN.into_iter().any(is_off) {
            return;
        }
        let middle = step.exactly_at(&mut self.field, at(0.5) * step.h);
        let [first, last] = ends;
        self.divide(step, [from, at(0.5)], [first, middle.clone()], halvings - 1);
        self.record.point(step.t + at(0.5) * step.h, &middle);
        self.divide(step, [at(0.5), to], [middle, last], halvings - 1);
    }
}
