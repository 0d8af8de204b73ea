//! What the controls of a solution do on the true system, simulated from event to event, against what the solution says.

use crate::alignment::Alignment;
use crate::conditions::{Condition, Conditions};
use crate::output::saved::Saved;
use crate::pieces::pieces_of_one;
use crate::replay::Replay;
use crate::solver::Failure;
use crate::stays::{Stay, stays};
use fdcc_compiler::Model;
use fdcc_runtime::problem::Problem;
use fdcc_runtime::simulate::{Controls, Options, Simulation, Status, System, simulate};

/// A replay that needs more steps, of a very stiff system, is given up: nobody waits for it.
const FEWEST_STEPS: usize = 200_000;
const STEPS_PER_INTERVAL: usize = 50;

/// A replay and how it compares with its solution.
pub struct Verified {
    pub system: System,
    pub simulation: Simulation,
    /// Whether the replay reached the last time.
    pub is_whole: bool,
    /// For each state, as far as the replay came.
    pub gaps: Vec<Gap>,
    /// Bounds of states that are violated; all path and end conditions.
    pub conditions: Vec<Condition>,
    /// For each surface.
    pub stays: Vec<Vec<Stay>>,
}

/// The largest difference of a state over the grid, in units of max(1, |x|).
pub struct Gap {
    pub name: String,
    pub gap: f64,
    pub time: f64,
}

impl Verified {
    /// The state that differs most.
    pub fn largest_gap(&self) -> f64 {
        self.gaps.iter().fold(0.0, |most, gap| most.max(gap.gap))
    }

    /// The condition that is violated most, if any is.
    pub fn worst(&self) -> Option<&Condition> {
        let violated = self.conditions.iter().filter(|it| it.violation > 0.0);
        violated.max_by(|a, b| a.violation.total_cmp(&b.violation))
    }
}

/// Replays a solution of a problem that was compiled from the model, whatever its parameters are now.
pub fn verify(model: &Model, problem: &Problem, saved: &Saved) -> Result<Verified, Failure> {
    let replay = Replay::new(saved, model).and_then(|replay| replay.check().map(|()| replay));
    let replay = replay.map_err(Failure::File)?;
    let mut model = model.clone();
    replay.adapt(&mut model);
    let system = fdcc_compiler::compile_simulation(&model).map_err(Failure::Model)?;
    fits(saved, &system).map_err(Failure::File)?;
    let intervals = saved.time.len().saturating_sub(1);
    let points = Points::new(saved, replay, system.interval);
    let controls = Controls::Held { times: points.starts(), rows: points.rows.clone(), is_stretched: true };
    let max_steps = FEWEST_STEPS.max(STEPS_PER_INTERVAL * intervals);
    let options =
        Options { times: points.times.clone(), max_steps, tape: true, extremes: true, ..Options::default() };
    let simulation = simulate(&system, &controls, &options);
    let is_whole = matches!(simulation.status, Status::Completed)
        && simulation.states.iter().all(|column| column.len() == points.times.len());
    let tape = simulation.tape.as_ref().expect("it was asked for");
    let stays = (0..system.surfaces.len()).map(|surface| stays(tape, surface)).collect();
    let conditions =
        Conditions::new(problem, saved, &system, &simulation, &points).map(|it| it.all(is_whole));
    let gaps = match Alignment::new(&saved.jumps, &system, &simulation) {
        Some(alignment) if is_whole && !saved.jumps.is_empty() => {
            let times = alignment.moved(&points.times);
            let compared =
                simulate(&system, &controls, &Options { times, tape: false, extremes: false, ..options });
            alignment.gaps(saved).chain(gaps(saved, &system, &compared)).collect()
        }
        _ => gaps(saved, &system, &simulation),
    };
    Ok(Verified { gaps, conditions: conditions.unwrap_or_default(), stays, is_whole, system, simulation })
}

/// Whether a solution has the time and the states of a system.
fn fits(saved: &Saved, system: &System) -> Result<(), String> {
    let [first, last] = system.interval;
    let own = [saved.time.first(), saved.time.last()].map(|end| end.copied().flatten().unwrap_or(f64::NAN));
    let differs =
        |own: f64, end: f64| own.is_nan() || (own - end).abs() > 1e-6 * (1.0 + (last - first).abs());
    if differs(own[0], first) || differs(own[1], last) {
        return Err(format!(
            "its time runs from {} to {}, that of the model from {first} to {last}",
            own[0], own[1]
        ));
    }
    let shown = system.states.iter().filter(|state| !state.hidden);
    let missing = shown
        .map(|it| &it.name)
        .find(|name| saved.states.get(name).is_none_or(|column| column.len() != saved.time.len()));
    missing.map_or(Ok(()), |name| Err(format!("it does not have the state `{name}` at each of its times")))
}

/// The times at which the replay is looked at: the grid, and between its points.
pub struct Points {
    pub times: Vec<f64>,
    rows: Vec<Vec<f64>>,
    /// How many points are in the time of a row.
    in_row: usize,
}

impl Points {
    fn new(saved: &Saved, replay: Replay, [first, last]: [f64; 2]) -> Self {
        let mut grid: Vec<f64> = saved.time.iter().flatten().copied().collect();
        let end = grid.len() - 1;
        // The grid has been rounded at its ends.
        (grid[0], grid[end]) = (first, last);
        let count = pieces_of_one(end);
        let inside = |pair: &[f64]| {
            let (from, length) = (pair[0], pair[1] - pair[0]);
            (0..count).map(move |j| from + length * j as f64 / count as f64)
        };
        let times = grid.windows(2).flat_map(inside).chain([last]).collect();
        let in_row = count * end / replay.rows.len();
        Points { times, rows: replay.rows, in_row }
    }

    fn starts(&self) -> Vec<f64> {
        self.times.iter().copied().step_by(self.in_row).take(self.rows.len()).collect()
    }

    /// The controls at a point; at a grid point those of the row that ends there, as a transcription has it.
    pub fn row(&self, point: usize) -> &[f64] {
        &self.rows[point.saturating_sub(1) / self.in_row]
    }
}

impl Alignment {
    /// Of the times of the jumps, in the same units as those of states.
    fn gaps(&self, saved: &Saved) -> impl Iterator<Item = Gap> {
        let times = self.own.iter().zip(&self.replayed).zip(&saved.jumps);
        times.map(|((own, replayed), jump)| Gap {
            name: format!("time of {}", jump.jump),
            gap: (own - replayed).abs() / own.abs().max(1.0),
            time: *replayed,
        })
    }
}

fn gaps(saved: &Saved, system: &System, simulation: &Simulation) -> Vec<Gap> {
    let shown = system.states.iter().zip(&simulation.states).filter(|(state, _)| !state.hidden);
    shown.map(|(state, column)| gap(saved, &state.name, simulation, column)).collect()
}

fn gap(saved: &Saved, name: &str, simulation: &Simulation, replayed: &[f64]) -> Gap {
    let own = saved.states.get(name).map(Vec::as_slice).unwrap_or_default();
    let points =
        simulation.time.iter().zip(replayed).step_by(pieces_of_one(saved.time.len().saturating_sub(1)));
    let start = simulation.time.first().copied().unwrap_or(simulation.end_time);
    let mut largest = Gap { name: name.into(), gap: 0.0, time: start };
    for ((&time, &replayed), own) in points.zip(own) {
        let own = own.unwrap_or(f64::INFINITY);
        let gap = (own - replayed).abs() / own.abs().max(1.0);
        // What is not a number differs more than everything.
        if gap > largest.gap || gap.is_nan() {
            largest = Gap { gap: if gap.is_nan() { f64::INFINITY } else { gap }, time, ..largest };
        }
    }
    largest
}
