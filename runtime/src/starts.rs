//! Starting points other than the model's guess: an earlier solution on another grid, and random
//! variations.

use crate::linalg::Stages;
use crate::nlp::{Nlp, Solution, Start, Status};
use crate::problem::Problem;
use crate::transcribe::TranscribedNlp;
use crate::transcribe::interval::Signal;

/// Signals of an earlier solution over normalised time; `None` where it has none of that name.
#[derive(Clone, Debug, Default)]
pub struct Earlier {
    /// Grid points, from 0 to 1.
    pub times: Vec<f64>,
    /// One column per state, one value per grid point.
    pub states: Vec<Option<Vec<f64>>>,
    /// One column per control, one value per interval.
    pub controls: Vec<Option<Vec<f64>>>,
    /// One per unknown.
    pub unknowns: Vec<Option<f64>>,
    /// The smoothing width of each surface.
    pub widths: Vec<Option<f64>>,
}

/// The earlier solution on the grid of the problem; what it lacks comes from the guess.
pub(crate) fn resample(problem: &Problem, earlier: &Earlier) -> Vec<f64> {
    let mut nlp = TranscribedNlp::new(problem);
    let stages = nlp.chain();
    let mut v = nlp.guess();
    let slots = nlp.interval().slots.clone();
    for (place, slot) in slots.iter().enumerate() {
        for k in 0..values_of(place, stages) {
            let value = match slot.signal {
                Signal::State(i) => earlier.state(i, nlp.mesh().at(k, slot.time)),
                // A control is held: what it is in the middle of the interval.
                Signal::Control(i) if k < stages.intervals => {
                    earlier.control(i, nlp.mesh().at(k, 0.5))
                }
                Signal::Control(i) => earlier.control(i, 1.0),
            };
            let variable = &mut v[place + k * stages.variable_step()];
            *variable = value.unwrap_or(*variable);
        }
    }
    for (variable, value) in stages.globals().zip(&earlier.unknowns) {
        v[variable] = value.unwrap_or(v[variable]);
    }
    v
}

/// How often a variable of an interval is there: what is carried once more, at the last grid point.
fn values_of(place: usize, stages: Stages) -> usize {
    stages.intervals + usize::from(place < stages.states)
}

impl Earlier {
    /// The interval that a time lies in.
    fn interval(&self, tau: f64) -> Option<usize> {
        let last = self.times.len().checked_sub(2)?;
        Some(self.times.partition_point(|time| *time <= tau).saturating_sub(1).min(last))
    }

    /// Linear between grid points.
    fn state(&self, i: usize, tau: f64) -> Option<f64> {
        let (column, k) = (self.states.get(i)?.as_deref()?, self.interval(tau)?);
        let (before, after) = (*column.get(k)?, *column.get(k + 1)?);
        let fraction = (tau - self.times[k]) / (self.times[k + 1] - self.times[k]);
        Some(before + fraction * (after - before))
    }

    fn control(&self, i: usize, tau: f64) -> Option<f64> {
        self.controls.get(i)?.as_deref()?.get(self.interval(tau)?).copied()
    }
}

/// Relative size of a variation.
const VARIATION: f64 = 0.3;

/// The guess (or `base`) with smooth random variations of every signal; the same for the same seed
/// and index.
pub fn perturbed(problem: &Problem, base: Option<Vec<f64>>, index: u32) -> Start {
    let mut nlp = TranscribedNlp::new(problem);
    let stages = nlp.chain();
    let mut v = base.unwrap_or_else(|| nlp.guess());
    let mut random = Random::new(problem.method.seed, index);
    let signals =
        (0..problem.layout.x).map(Signal::State).chain((0..problem.layout.u).map(Signal::Control));
    for signal in signals {
        let places = places_of(&nlp, signal);
        let values = places.iter().map(|(place, _)| v[*place]);
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        let size = VARIATION * room(&nlp, places[places.len() - 1].0, low, high);
        let (constant, wave, cycles) =
            (random.next(), random.next(), 1.0 + 2.0 * random.next().abs());
        for (place, tau) in places {
            // Fixed ends stay where they are.
            let is_state = matches!(signal, Signal::State(_));
            let envelope = if is_state { (std::f64::consts::PI * tau).sin() } else { 1.0 };
            v[place] +=
                size * envelope * (constant + wave * (std::f64::consts::TAU * cycles * tau).sin());
        }
    }
    for place in stages.globals() {
        let size = room(&nlp, place, v[place], v[place]);
        v[place] += VARIATION * size.min(v[place].abs().max(1.0)) * random.next();
    }
    Start { v, warm: None }
}

/// The variables that are values of a signal, with their normalised times; at grid points last.
fn places_of(nlp: &TranscribedNlp, signal: Signal) -> Vec<(usize, f64)> {
    let stages = nlp.chain();
    let slots = nlp.interval().slots.iter().enumerate().filter(|(_, slot)| slot.signal == signal);
    let places = slots.rev().flat_map(|(place, slot)| {
        let time = |k: usize| nlp.mesh().at(k, slot.time);
        (0..values_of(place, stages)).map(move |k| (place + k * stages.variable_step(), time(k)))
    });
    places.collect()
}

/// How far a signal may reasonably move: the width of its bounds, else its own range or size.
fn room(nlp: &TranscribedNlp, place: usize, low: f64, high: f64) -> f64 {
    let bounds = nlp.variable_bounds()[place];
    let width = bounds.upper - bounds.lower;
    if width.is_finite() { width } else { (high - low).max(low.abs().max(high.abs())).max(1.0) }
}

/// Whether `a` is the better answer: solved before not solved, then the lower objective, then the
/// smaller violation.
pub fn is_better(a: &Solution, b: &Solution) -> bool {
    let solved =
        |solution: &Solution| matches!(solution.status, Status::Solved | Status::Acceptable);
    match (solved(a), solved(b)) {
        (true, true) => a.objective < b.objective,
        (false, false) => a.constraint_violation < b.constraint_violation,
        (solved, _) => solved,
    }
}

/// A linear congruential generator (Knuth, MMIX).
struct Random(u64);

impl Random {
    fn new(seed: u64, index: u32) -> Self {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ u64::from(index));
        (0..4).for_each(|_| {
            random.next();
        });
        random
    }

    /// Uniform in [-1, 1].
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
