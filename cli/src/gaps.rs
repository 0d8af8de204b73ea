//! How far a solution is from its replay: each state over the grid, for how far it moves.

use crate::alignment::Alignment;
use crate::output::saved::{Saved, SavedJump};
use crate::pieces::pieces_of_one;
use fdcc::motion::Motion;
use fdcc_runtime::problem::Variable;
use fdcc_runtime::simulate::{Simulation, System};

/// How the time of a jump is called among the states.
pub const TIME_OF: &str = "time of ";

/// The largest difference of a state over the grid.
pub struct Gap {
    pub name: String,
    /// In SI.
    pub difference: f64,
    /// The same as a part of how far the state moves.
    pub part: f64,
    pub time: f64,
}

/// For each state that is shown, as far as the replay came.
pub fn gaps(saved: &Saved, system: &System, replay: &Simulation) -> Vec<Gap> {
    let states = system.states.iter().zip(&replay.states).filter(|(state, _)| !state.hidden);
    let (states, columns): (Vec<&Variable>, Vec<&Vec<f64>>) = states.unzip();
    let motions = Motion::of_states(&states, |at| {
        own(saved, &states[at].name).iter().flatten().chain(columns[at]).copied().collect()
    });
    let gap = |at: usize| gap(saved, &states[at].name, (replay, columns[at]), motions[at]);
    (0..states.len()).map(gap).collect()
}

/// Of the times of jumps, for the length of all time.
pub fn gaps_of_jumps(alignment: &Alignment, saved: &Saved, [first, last]: [f64; 2]) -> Vec<Gap> {
    let times = alignment.own.iter().zip(&alignment.replayed).zip(&saved.jumps);
    let gap = |((own, replayed), jump): ((&f64, &f64), &SavedJump)| Gap {
        name: format!("{TIME_OF}{}", jump.jump),
        difference: (own - replayed).abs(),
        part: (own - replayed).abs() / (last - first),
        time: *replayed,
    };
    times.map(gap).collect()
}

fn own<'s>(saved: &'s Saved, name: &str) -> &'s [Option<f64>] {
    saved.states.get(name).map(Vec::as_slice).unwrap_or_default()
}

fn gap(
    saved: &Saved,
    name: &str,
    (replay, replayed): (&Simulation, &[f64]),
    motion: Motion,
) -> Gap {
    let own = own(saved, name);
    let points =
        replay.time.iter().zip(replayed).step_by(pieces_of_one(own.len().saturating_sub(1)));
    let start = replay.time.first().copied().unwrap_or(replay.end_time);
    let mut largest = (0.0, start);
    for ((&time, &replayed), own) in points.zip(own) {
        let difference = (own.unwrap_or(f64::INFINITY) - replayed).abs();
        // What is not a number differs more than everything.
        if difference > largest.0 || difference.is_nan() {
            largest = (if difference.is_nan() { f64::INFINITY } else { difference }, time);
        }
    }
    let (difference, time) = largest;
    Gap { name: name.into(), difference, part: motion.part(difference), time }
}
