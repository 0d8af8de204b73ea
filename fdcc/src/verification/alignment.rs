//! Times of a solution with jumps, moved to where the same happens in its replay.
//!
//! A jump that comes a little earlier or later makes all the difference to the state between the
//! two times, and next to none to the trajectory. So the pieces between the jumps are compared,
//! each stretched to the length of the other, and the times of the jumps by themselves.

use super::tuning::alignment::AFTER;
use crate::record::JumpRecord;
use fdcc_runtime::simulate::{EventKind, Simulation, System};

/// The times of the jumps in a solution and in its replay.
pub(super) struct Alignment {
    pub own: Vec<f64>,
    pub replayed: Vec<f64>,
}

impl Alignment {
    /// Nothing if the replay has other jumps than the solution.
    pub fn new(jumps: &[JumpRecord], system: &System, simulation: &Simulation) -> Option<Self> {
        let happened = simulation.events.iter().filter_map(|event| match event.kind {
            EventKind::Jump(at) => Some((system.jumps[at].name.as_str(), event.time)),
            _ => None,
        });
        let happened: Vec<(&str, f64)> = happened.collect();
        let own: Vec<f64> = jumps.iter().map(|jump| jump.time).collect();
        let is_same = happened.iter().map(|it| it.0).eq(jumps.iter().map(|it| it.jump))
            && own.iter().all(|time| time.is_finite());
        let replayed = happened.iter().map(|it| it.1).collect();
        is_same.then_some(Alignment { own, replayed })
    }

    /// What stands in the replay for each of some ascending times of the solution, which begin and
    /// end with it.
    pub fn moved(&self, times: &[f64]) -> Vec<f64> {
        let [first, last] = [times[0], times[times.len() - 1]];
        let ends = |jumps: &[f64]| [&[first], jumps, &[last]].concat();
        let (own, replayed) = (ends(&self.own), ends(&self.replayed));
        let after = AFTER * (last - first);
        let moved = times.iter().map(|time| {
            let piece = self.own.partition_point(|jump| jump <= time);
            let part = (time - own[piece]) / (own[piece + 1] - own[piece]);
            let to = replayed[piece] + part * (replayed[piece + 1] - replayed[piece]);
            // At the time of a jump a solution has the state after it.
            if piece > 0 { to.max(replayed[piece] + after) } else { to }
        });
        let mut moved: Vec<f64> = moved.collect();
        moved[times.len() - 1] = last;
        moved
    }
}

#[cfg(test)]
mod tests {
    use super::Alignment;

    #[test]
    fn pieces_are_stretched_and_jumps_fall_on_jumps() {
        let alignment = Alignment { own: vec![1.0, 2.0], replayed: vec![1.5, 2.5] };
        let moved = alignment.moved(&[0.0, 0.5, 1.0, 1.5, 2.0, 3.0]);
        let expected = [0.0, 0.75, 1.5, 2.0, 2.5, 3.0];
        assert!(moved.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-8), "{moved:?}");
        assert!(moved[2] > 1.5 && moved[4] > 2.5, "after the jumps: {moved:?}");
    }
}
