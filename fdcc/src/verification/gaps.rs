//! How far a solution is from its replay: each state over the grid, for how far it moves.

use super::alignment::Alignment;
use super::motion::Motion;
use super::points::points_of_one;
use crate::record::{JumpRecord, Record, find};
use fdcc_runtime::problem::Variable;
use fdcc_runtime::simulate::{Simulation, System};

/// How the time of a jump is called among the states.
pub const TIME_OF: &str = "time of ";

/// The largest difference of a state over the grid.
///
/// ```
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// let solution = fdcc::Model::from_text("hop", text)?.solve(&fdcc::Options::default())?;
/// let replay = solution.verify()?;
/// let gap = replay.largest_gap().expect("there is a state");
/// assert!(gap.name == "x" && gap.part < 1e-6);
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Gap {
    /// Of the state, or `time of ` and a jump.
    pub name: String,
    /// In SI.
    pub difference: f64,
    /// The same as a part of how far the state moves.
    pub part: f64,
    /// When.
    pub time: f64,
}

/// For each state that is shown, as far as the replay came.
pub(super) fn gaps(record: &Record, system: &System, replay: &Simulation) -> Vec<Gap> {
    let states = system.states.iter().zip(&replay.states).filter(|(state, _)| !state.hidden);
    let (states, columns): (Vec<&Variable>, Vec<&Vec<f64>>) = states.unzip();
    let motions = Motion::of_states(&states, |at| {
        let own = own(record, &states[at].name).iter().filter(|value| value.is_finite());
        own.chain(columns[at]).copied().collect()
    });
    let gap = |at: usize| gap(record, &states[at].name, (replay, columns[at]), motions[at]);
    (0..states.len()).map(gap).collect()
}

/// Of the times of jumps, for the length of all time.
pub(super) fn gaps_of_jumps(
    alignment: &Alignment,
    record: &Record,
    [first, last]: [f64; 2],
) -> Vec<Gap> {
    let times = alignment.own.iter().zip(&alignment.replayed).zip(&record.jumps);
    let gap = |((own, replayed), jump): ((&f64, &f64), &JumpRecord)| Gap {
        name: format!("{TIME_OF}{}", jump.jump),
        difference: (own - replayed).abs(),
        part: (own - replayed).abs() / (last - first),
        time: *replayed,
    };
    times.map(gap).collect()
}

fn own<'s>(record: &Record<'s>, name: &str) -> &'s [f64] {
    find(&record.states, name).unwrap_or_default()
}

fn gap(
    record: &Record,
    name: &str,
    (replay, replayed): (&Simulation, &[f64]),
    motion: Motion,
) -> Gap {
    let own = own(record, name);
    let points =
        replay.time.iter().zip(replayed).step_by(points_of_one(own.len().saturating_sub(1)));
    let start = replay.time.first().copied().unwrap_or(replay.end_time);
    let mut largest = (0.0, start);
    for ((&time, &replayed), &own) in points.zip(own) {
        let own = if own.is_finite() { own } else { f64::INFINITY };
        let difference = (own - replayed).abs();
        // What is not a number differs more than everything.
        if difference > largest.0 || difference.is_nan() {
            largest = (if difference.is_nan() { f64::INFINITY } else { difference }, time);
        }
    }
    let (difference, time) = largest;
    Gap { name: name.into(), difference, part: motion.part(difference), time }
}
