//! What the controls of a solution do on the true system, simulated from event to event, against
//! what the solution says.

mod alignment;
mod at_times;
mod conditions;
mod gaps;
mod links;
pub mod modes;
mod motion;
mod phases;
mod points;
mod terms;
mod tuning;

pub use conditions::Condition;
pub use gaps::{Gap, TIME_OF};
pub use links::LinkGap;
pub use modes::Stay;
pub(crate) use phases::{objective_of_links, verify_phases};

use crate::error::Error;
use crate::measured::add_objective;
use crate::record::{Record, find};
use crate::replay::Replay;
use alignment::Alignment;
use conditions::Conditions;
use fdcc_compiler::{Model, is_kink};
use fdcc_runtime::problem::Problem;
use fdcc_runtime::simulate::{Options, Simulation, Status, System, simulate};
use gaps::{gaps, gaps_of_jumps};
use modes::stays;
use points::Points;
use tuning::times::OTHER_TIME;

/// A replay that needs more steps, of a very stiff system, is given up: nobody waits for it.
const FEWEST_STEPS: usize = 200_000;
const STEPS_PER_INTERVAL: usize = 50;

/// A replay of a solution on the true system, and how it compares with the solution.
///
/// ```
/// # let text = "time t in [0, 1]\nstate x start 0\ncontrol u in [-1, 1]
/// # dynamics { x' = u }\nend x == 0.5\nminimize integral(u^2)";
/// let solution = fdcc::Model::from_text("hop", text)?.solve(&fdcc::Options::default())?;
/// let replay = solution.verify()?;
/// assert!(replay.confirms(1e-6));
/// assert!(replay.worst().is_none(), "no condition is violated");
/// # Ok::<(), fdcc::Error>(())
/// ```
pub struct Verification {
    /// The true system.
    pub system: System,
    /// What it does.
    pub simulation: Simulation,
    /// Whether the replay reached the last time.
    pub is_whole: bool,
    /// For each state, as far as the replay came.
    pub gaps: Vec<Gap>,
    /// Bounds of states that are violated; all path and end conditions, and those at times.
    pub conditions: Vec<Condition>,
    /// For each surface.
    pub stays: Vec<Vec<Stay>>,
}

impl Verification {
    /// Whether it reached the last time, and no state differs for how far it moves, and no
    /// condition is violated for the size of its terms, by more than `asked`.
    pub fn confirms(&self, asked: f64) -> bool {
        let gap = self.largest_gap().map_or(0.0, |it| it.part);
        let violation = self.worst().map_or(0.0, |it| it.part);
        self.is_whole && gap <= asked && violation <= asked
    }

    /// The largest difference of a state, for how far it moves; nothing if the replay did not reach
    /// the last time.
    pub fn state_gap(&self) -> Option<f64> {
        let gap = self.largest_gap().filter(|it| it.difference > 0.0).map_or(0.0, |it| it.part);
        self.is_whole.then_some(gap)
    }

    /// The state that differs most for how far it moves.
    pub fn largest_gap(&self) -> Option<&Gap> {
        self.gaps.iter().max_by(|a, b| a.part.total_cmp(&b.part))
    }

    /// The condition that is violated most for the size of its terms, if any is.
    pub fn worst(&self) -> Option<&Condition> {
        // What stands for a kink is compared with the kink itself.
        let violated = self.conditions.iter().filter(|it| it.part > 0.0 && !is_kink(&it.label));
        violated.max_by(|a, b| a.part.total_cmp(&b.part).then(a.violation.total_cmp(&b.violation)))
    }
}

impl crate::model::Model {
    /// What a replay of a recorded solution does on the true system, against what it says.
    ///
    /// # Errors
    ///
    /// A record that does not belong to this model; a model that cannot be simulated.
    pub fn verify(&self, record: &Record) -> Result<Verification, Error> {
        verify(self.meaning(), &self.problem()?, record)
    }
}

/// Replays a solution of a problem that was compiled from the model, whatever its parameters are
/// now.
pub(crate) fn verify(
    model: &Model,
    problem: &Problem,
    record: &Record,
) -> Result<Verification, Error> {
    let replay = Replay::new(record, model).and_then(|replay| replay.check().map(|()| replay));
    let replay = replay.map_err(Error::Record)?;
    let mut model = model.clone();
    replay.adapt(&mut model);
    // The last ones: nobody asks between which values what stands for a kink is.
    model.path.retain(|it| !is_kink(&it.place.name));
    let system = fdcc_compiler::compile_simulation(&model).map_err(Error::Model)?;
    fits(record, &system).map_err(Error::Record)?;
    let intervals = record.time.len().saturating_sub(1);
    let controls = replay.controls;
    let points = Points::new(record, &controls, system.interval);
    let max_steps = FEWEST_STEPS.max(STEPS_PER_INTERVAL * intervals);
    let options = Options {
        times: points.times.clone(),
        max_steps,
        tape: true,
        extremes: true,
        ..Options::default()
    };
    let mut simulation = simulate(&system, &controls, &options);
    add_objective(&model, &system, &controls, &options, &mut simulation);
    let is_whole = matches!(simulation.status, Status::Completed)
        && simulation.states.iter().all(|column| column.len() == points.times.len());
    let tape = simulation.tape.as_ref().expect("it was asked for");
    let stays = (0..system.surfaces.len()).map(|surface| stays(tape, surface)).collect();
    let conditions =
        Conditions::new(problem, record, &system, &simulation, &points).map(|it| it.all(is_whole));
    let mut conditions = conditions.unwrap_or_default();
    if is_whole {
        conditions.extend(at_times::conditions(&model, record, &system, &simulation, &points)?);
    }
    let gaps = match Alignment::new(&record.jumps, &system, &simulation) {
        Some(alignment) if is_whole && !record.jumps.is_empty() => {
            let times = alignment.moved(&points.times);
            let compared = simulate(
                &system,
                &controls,
                &Options { times, tape: false, extremes: false, ..options },
            );
            let of_jumps = gaps_of_jumps(&alignment, record, system.interval);
            of_jumps.into_iter().chain(gaps(record, &system, &compared)).collect()
        }
        _ => gaps(record, &system, &simulation),
    };
    Ok(Verification { gaps, conditions, stays, is_whole, system, simulation })
}

/// Whether a solution has the time and the states of a system.
fn fits(record: &Record, system: &System) -> Result<(), String> {
    let [first, last] = system.interval;
    let own = [record.time.first(), record.time.last()]
        .map(|end| end.copied().filter(|time| time.is_finite()).unwrap_or(f64::NAN));
    let differs = |own: f64, end: f64| {
        own.is_nan() || (own - end).abs() > OTHER_TIME * (1.0 + (last - first).abs())
    };
    if differs(own[0], first) || differs(own[1], last) {
        return Err(format!(
            "its time runs from {} to {}, that of the model from {first} to {last}",
            own[0], own[1]
        ));
    }
    let shown = system.states.iter().filter(|state| !state.hidden);
    let missing = shown.map(|it| &it.name).find(|name| {
        find(&record.states, name).is_none_or(|column| column.len() != record.time.len())
    });
    missing.map_or(Ok(()), |name| {
        Err(format!("it does not have the state `{name}` at each of its times"))
    })
}
