//! Whether a trajectory depends on when exactly its controls change: where a surface that repels is
//! crossed at the very time at which a control jumps, a control that jumps a moment before leads
//! somewhere else, and the answer is a limit that nothing near it comes close to.

use super::Solution;
use super::tuning::timing::MOMENT;
use crate::record::{NodesRecord, Record};
use crate::verification::Verification;

/// The largest difference of a state where the controls come a moment before or after what was
/// planned, for how far it moves; infinite where such a replay does not reach the end. Nothing is
/// said where states jump, because they differ for that moment, nor where nothing switches, nor
/// where there are no controls: the replay is then that of the check `replayed`.
pub(super) fn gap_of_a_moment(solution: &Solution) -> f64 {
    let problem = &solution.problem;
    let is_timed = !problem.surfaces.is_empty() && !problem.controls.is_empty();
    if !is_timed || !solution.jumps.is_empty() {
        return 0.0;
    }
    let gap = |part: f64| {
        let gap = shifted(solution, part).as_ref().and_then(Verification::state_gap);
        gap.unwrap_or(f64::INFINITY)
    };
    gap(-MOMENT).max(gap(MOMENT))
}

/// A replay of the same controls on a grid whose inner points are moved by a part of the time.
fn shifted(solution: &Solution, part: f64) -> Option<Verification> {
    let record = solution.record();
    let [first, last] = [record.time[0], record.time[record.time.len() - 1]];
    let by = part * (last - first);
    let moved = |times: &[f64]| -> Vec<f64> {
        // Near the ends by less, so that their order stays.
        let room = |time: f64| (time - first).min(last - time) / (2.0 * by.abs());
        times.iter().map(|time| time + by * room(*time).min(1.0)).collect()
    };
    let time = moved(record.time);
    let nodes = record.nodes.as_ref().map(|nodes| moved(nodes.time));
    let nodes = record.nodes.clone().zip(nodes.as_deref());
    let nodes = nodes.map(|(own, time)| NodesRecord { time, ..own });
    solution.model().verify(&Record { time: &time, nodes, ..record.clone() }).ok()
}
