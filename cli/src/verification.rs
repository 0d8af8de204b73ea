//! What the controls of a solution do on the true system, simulated from event to event, against
//! what the solution says.

use crate::alignment::Alignment;
use crate::conditions::{Condition, Conditions};
use crate::gaps::{Gap, gaps, gaps_of_jumps};
use crate::output::saved::Saved;
use crate::pieces::pieces_of_one;
use crate::replay::Replay;
use crate::solver::Failure;
use fdcc::stays::{Stay, stays};
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

impl Verified {
    /// The state that differs most for how far it moves.
    pub fn largest_gap(&self) -> Option<&Gap> {
        self.gaps.iter().max_by(|a, b| a.part.total_cmp(&b.part))
    }

    /// The condition that is violated most for the size of its terms, if any is.
    pub fn worst(&self) -> Option<&Condition> {
        let violated = self.conditions.iter().filter(|it| it.part > 0.0);
        violated.max_by(|a, b| a.part.total_cmp(&b.part).then(a.violation.total_cmp(&b.violation)))
    }
}

/// Replays a solution of a problem that was compiled from the model, whatever its parameters are
/// now.
pub fn verify(model: &Model, problem: &Problem, saved: &Saved) -> Result<Verified, Failure> {
    let replay = Replay::new(saved, model).and_then(|replay| replay.check().map(|()| replay));
    let replay = replay.map_err(Failure::File)?;
    let mut model = model.clone();
    replay.adapt(&mut model);
    let system = fdcc_compiler::compile_simulation(&model).map_err(Failure::Model)?;
    fits(saved, &system).map_err(Failure::File)?;
    let intervals = saved.time.len().saturating_sub(1);
    let points = Points::new(saved, replay, system.interval);
    let controls =
        Controls::Held { times: points.starts(), rows: points.rows.clone(), is_stretched: true };
    let max_steps = FEWEST_STEPS.max(STEPS_PER_INTERVAL * intervals);
    let options = Options {
        times: points.times.clone(),
        max_steps,
        tape: true,
        extremes: true,
        ..Options::default()
    };
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
            let compared = simulate(
                &system,
                &controls,
                &Options { times, tape: false, extremes: false, ..options },
            );
            let of_jumps = gaps_of_jumps(&alignment, saved, system.interval);
            of_jumps.into_iter().chain(gaps(saved, &system, &compared)).collect()
        }
        _ => gaps(saved, &system, &simulation),
    };
    Ok(Verified {
        gaps,
        conditions: conditions.unwrap_or_default(),
        stays,
        is_whole,
        system,
        simulation,
    })
}

/// Whether a solution has the time and the states of a system.
fn fits(saved: &Saved, system: &System) -> Result<(), String> {
    let [first, last] = system.interval;
    let own = [saved.time.first(), saved.time.last()]
        .map(|end| end.copied().flatten().unwrap_or(f64::NAN));
    let differs = |own: f64, end: f64| {
        own.is_nan() || (own - end).abs() > 1e-6 * (1.0 + (last - first).abs())
    };
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
    missing.map_or(Ok(()), |name| {
        Err(format!("it does not have the state `{name}` at each of its times"))
    })
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

    /// The controls at a point; at a grid point those of the row that ends there, as a
    /// transcription has it.
    pub fn row(&self, point: usize) -> &[f64] {
        &self.rows[point.saturating_sub(1) / self.in_row]
    }
}
