//! Where a solve begins whose jumps differ by one from those of an answer: at that answer, cut at
//! the times of the jumps. One more happens in the middle of a piece, or at the end of a phase next
//! to which it happened.

use super::alternatives::Alternative;
use super::found::FoundChain;
use super::tuning::sequences::NEAR_LINK;
use fdcc_compiler::Combination;
use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::Problem;
use fdcc_runtime::solution::Trajectory;
use fdcc_runtime::solve::warm_start::{Earlier, from_earlier};

/// The start; nothing where more than one jump differs in a phase. `between` is any phase, with the
/// unknowns of all.
pub(super) fn start(
    (events, found): (&Combination, &FoundChain),
    of: &Alternative,
    between: &Problem,
) -> Option<Start> {
    let mut pieces = found.outcome.phases.iter().map(|it| &it.trajectory);
    let (mut cuts, mut phases) = (Vec::new(), Vec::new());
    for (own, new) in events.iter().zip(&of.events) {
        let own_pieces: Vec<&Trajectory> = pieces.by_ref().take(own.len() + 1).collect();
        let phase = Phase { pieces: own_pieces };
        let is_moved = events.iter().map(Vec::len).sum::<usize>()
            == of.events.iter().map(Vec::len).sum::<usize>();
        let times = phase.times(own, new, is_moved)?;
        cuts.extend(times[1..times.len() - 1].iter().copied());
        phases.push((phase, times));
    }
    let values = &found.outcome.phases[0].trajectory.parameters;
    let unknown = |parameter: usize| {
        let at = of.chain.unknowns.iter().position(|it| it.parameter == parameter)?;
        match at.checked_sub(between.unknowns.len()) {
            Some(cut) => cuts.get(cut).copied(),
            None => values.get(parameter).copied(),
        }
    };
    let mut problems = of.chain.phases.iter();
    let mut all = Vec::new();
    for (phase, times) in &phases {
        for (pair, problem) in times.windows(2).zip(problems.by_ref()) {
            let unknowns = problem.unknowns.iter().map(|it| unknown(it.parameter)).collect();
            all.push(Earlier { unknowns, ..phase.earlier([pair[0], pair[1]], problem) });
        }
    }
    Some(from_earlier(&of.chain, &all))
}

/// The pieces of a phase of the model.
struct Phase<'s> {
    pieces: Vec<&'s Trajectory>,
}

impl Phase<'_> {
    /// When it begins, when the new jumps happen, and when it ends.
    fn times(&self, own: &[usize], new: &[usize], is_moved: bool) -> Option<Vec<f64>> {
        let first = |it: &&Trajectory| it.time[0];
        let last = self.pieces.last()?.time.last()?;
        let mut times: Vec<f64> = self.pieces.iter().map(first).chain([*last]).collect();
        let same = own.iter().zip(new).take_while(|it| it.0 == it.1).count();
        match new.len().checked_sub(own.len()) {
            Some(0) if own == new => {}
            Some(1) if own[same..] == new[same + 1..] => {
                let part = match (is_moved, same) {
                    (true, 0) => NEAR_LINK,
                    (true, _) => 1.0 - NEAR_LINK,
                    (false, _) => 0.5,
                };
                let [from, to] = [times[same], times[same + 1]];
                times.insert(same + 1, from + part * (to - from));
            }
            None if own[same + 1..] == new[same..] => _ = times.remove(same + 1),
            _ => return None,
        }
        Some(times)
    }

    /// What happens between two times; without unknowns.
    fn earlier(&self, [first, last]: [f64; 2], problem: &Problem) -> Earlier {
        let inside = |it: &&f64| first < **it && **it < last;
        let all = self.pieces.iter().flat_map(|it| it.time.iter().filter(inside).copied());
        let mut times: Vec<f64> = [first].into_iter().chain(all).chain([last]).collect();
        times.dedup();
        if times.len() < 2 {
            times = vec![first, last];
        }
        let shown = problem.states.iter().filter(|it| !it.hidden).count();
        let state = |at: usize| {
            let value = |k: usize| self.state(at, times[k], k + 1 < times.len());
            Some((0..times.len()).map(value).collect())
        };
        let mut states: Vec<Option<Vec<f64>>> = (0..shown).map(state).collect();
        states.resize(problem.states.len(), None);
        let control = |at: usize| {
            let middles = times.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
            Some(middles.map(|time| self.control(at, time)).collect())
        };
        let controls = (0..problem.controls.len()).map(control).collect();
        let duration = last - first;
        let part = |time: f64| if duration > 0.0 { (time - first) / duration } else { 0.0 };
        let mut normalised: Vec<f64> = times.iter().map(|it| part(*it)).collect();
        normalised.last_mut().into_iter().for_each(|it| *it = 1.0);
        Earlier { times: normalised, states, controls, ..Earlier::default() }
    }

    /// The piece at a time, and the interval; behind a jump at that time, or before it.
    fn place(&self, time: f64, is_behind: bool) -> (&Trajectory, usize) {
        let begun =
            |it: &&&Trajectory| if is_behind { it.time[0] <= time } else { it.time[0] < time };
        let count = self.pieces.iter().take_while(begun).count();
        let piece = self.pieces[count.max(1) - 1];
        let interval = piece.time.partition_point(|it| *it <= time);
        (piece, interval.clamp(1, piece.time.len() - 1) - 1)
    }

    fn state(&self, state: usize, time: f64, is_behind: bool) -> f64 {
        let (piece, k) = self.place(time, is_behind);
        let [from, to] = [piece.time[k], piece.time[k + 1]];
        let column = &piece.states[state];
        let part = if to > from { ((time - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        column[k] + part * (column[k + 1] - column[k])
    }

    fn control(&self, control: usize, time: f64) -> f64 {
        let (piece, k) = self.place(time, true);
        piece.controls[control][k]
    }
}
