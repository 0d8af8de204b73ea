//! Which jumps happen on the true system with everything as it is guessed, and where that motion
//! leads: a start that is a trajectory, with every jump at its time.

use super::tuning::sequences::{FEW, LONGEST, SHORTEST, STEPS};
use fdcc_compiler::{Model, Sequences, compile_simulation};
use fdcc_runtime::nlp::Start;
use fdcc_runtime::problem::{Chain, Problem};
use fdcc_runtime::simulate::{
    Controls, Event, EventKind, Options as Accuracy, Simulation, Status, System, simulate,
};
use fdcc_runtime::solve::warm_start::{Earlier, from_earlier};

/// A simulation of the guess that reaches its end.
pub(super) struct Guessed {
    /// The jumps and crossings that happen, of numbers as in [`Sequences`].
    pub events: Vec<usize>,
    /// When they do, with the states on both sides.
    happened: Vec<Event>,
    system: System,
    simulation: Simulation,
}

impl Guessed {
    pub fn of(model: &Model, possible: &Sequences) -> Option<Self> {
        let system = compile_simulation(model).ok()?;
        let accuracy = Accuracy { max_steps: STEPS, ..Accuracy::default() };
        let simulation = simulate(&system, &Controls::Guess, &accuracy);
        Self::of_motion(system, simulation, possible)
    }

    /// What a motion is, if it reaches its end.
    pub fn of_motion(system: System, simulation: Simulation, possible: &Sequences) -> Option<Self> {
        let (mut events, mut happened) = (Vec::new(), Vec::new());
        for event in &simulation.events {
            if let Some(number) = happening(&system, possible, &events, event) {
                events.push(number);
                happened.push(event.clone());
            }
        }
        let is_whole = matches!(simulation.status, Status::Completed);
        let is_finite = !piles_up(&simulation.events);
        let is_meant = is_whole && is_finite && events.len() <= LONGEST;
        is_meant.then_some(Guessed { events, happened, system, simulation })
    }

    /// Whether it says where the motion with these events is: it has them, or nothing but unknowns
    /// can be chosen, and one more happens in the end, or one less.
    pub fn is_near(&self, events: &[usize], is_driven: bool) -> bool {
        let count = events.len().min(self.events.len());
        let is_beside = events[..count] == self.events[..count]
            && events.len().abs_diff(self.events.len()) == 1;
        events == self.events || !is_driven && is_beside
    }

    /// Its phases, of which there are as many as problems; without unknowns.
    fn phases(&self, problems: &[Problem]) -> Vec<Earlier> {
        let [first, last] = self.system.interval;
        let ends = self.times(problems.len());
        let times: Vec<f64> = [first].into_iter().chain(ends).chain([last]).collect();
        let phases = times.windows(2).zip(problems).enumerate();
        phases.map(|(j, (pair, problem))| self.phase(j, [pair[0], pair[1]], problem)).collect()
    }

    /// When its phases end, if there are so many, but for the last one.
    fn times(&self, phases: usize) -> impl Iterator<Item = f64> {
        (0..phases - 1).map(|it| self.time_of(it))
    }

    /// When an event happens; the last time if it does not.
    fn time_of(&self, event: usize) -> f64 {
        self.happened.get(event).map_or(self.system.interval[1], |it| it.time)
    }

    /// The states of a phase over normalised time.
    fn phase(&self, j: usize, [begin, end]: [f64; 2], problem: &Problem) -> Earlier {
        let own = &self.simulation;
        let inside: Vec<usize> =
            (0..own.time.len()).filter(|k| own.time[*k] > begin && own.time[*k] < end).collect();
        let behind = match j.checked_sub(1) {
            Some(event) => self.happened.get(event).map_or(&own.end, |it| &it.after),
            None => &self.system.start,
        };
        let is_last = end == self.system.interval[1];
        let before = self.happened.get(j).filter(|_| !is_last).map_or(&own.end, |it| &it.before);
        let column = |name: &str| {
            let at = self.system.states.iter().position(|it| it.name == name)?;
            let middle = inside.iter().map(|k| own.states[at][*k]);
            Some([behind[at]].into_iter().chain(middle).chain([before[at]]).collect())
        };
        let times = [begin].into_iter().chain(inside.iter().map(|k| own.time[*k])).chain([end]);
        let duration = end - begin;
        // Two jumps at one time have a phase without a duration between them.
        let part = |time: f64| if duration > 0.0 { (time - begin) / duration } else { 0.0 };
        let mut times: Vec<f64> = times.map(part).collect();
        if let Some(last) = times.last_mut() {
            *last = 1.0;
        }
        let states = problem.states.iter().map(|it| column(&it.name)).collect();
        Earlier { times, states, ..Earlier::default() }
    }

    fn value_of(&self, unknown: &str) -> Option<f64> {
        let at = self.system.parameters.iter().position(|it| it.name == unknown)?;
        Some(self.system.parameters[at].value)
    }
}

/// Motions on the grids of a chain, which may have other events at their ends: one for each phase
/// of a model, with how many phases of the chain it has.
pub(super) fn start(motions: &[(&Guessed, usize)], between: &Problem, chain: &Chain) -> Start {
    let times = motions.iter().flat_map(|(it, phases)| it.times(*phases));
    let times: Vec<f64> = times.collect();
    let (mut all, mut problems) = (Vec::new(), &chain.phases[..]);
    for (motion, phases) in motions {
        let (own, others) = problems.split_at(*phases);
        // The unknowns of the model, then the times of what happens.
        let unknown = |parameter: usize| {
            let at = chain.unknowns.iter().position(|it| it.parameter == parameter)?;
            match at.checked_sub(between.unknowns.len()) {
                Some(event) => times.get(event).copied(),
                None => motion.value_of(&between.parameters[parameter].name),
            }
        };
        for (phase, problem) in motion.phases(own).into_iter().zip(own) {
            let unknowns = problem.unknowns.iter().map(|it| unknown(it.parameter)).collect();
            all.push(Earlier { unknowns, ..phase });
        }
        problems = others;
    }
    from_earlier(chain, &all)
}

/// Whether events follow each other ever faster: no finite number of phases is all of them.
fn piles_up(events: &[Event]) -> bool {
    let between = |pair: &[Event]| pair[1].time - pair[0].time;
    let longest = events.windows(2).map(between).fold(0.0, f64::max);
    let is_short = |pair: &[Event]| between(pair) < SHORTEST * longest;
    events.len() > FEW && events.windows(2).any(is_short)
}

/// The jump or the crossing that an event is, if it is one.
fn happening(
    system: &System,
    possible: &Sequences,
    earlier: &[usize],
    event: &Event,
) -> Option<usize> {
    let is_falling = match event.kind {
        EventKind::Jump(at) => return Some(at),
        // Against the direction of a jump.
        EventKind::CrossesUp => true,
        EventKind::CrossesDown => false,
        _ => return None,
    };
    let crossed = |at: &usize| {
        let jump = &system.jumps[*at];
        let is_first = !earlier.contains(at) && !earlier.contains(&(at + system.jumps.len()));
        possible.may_cross[*at]
            && is_first
            && (jump.surface, jump.is_falling) == (event.surface, is_falling)
    };
    (0..system.jumps.len()).find(crossed).map(|at| at + system.jumps.len())
}
