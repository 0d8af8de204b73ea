//! Other starting points, random or better by the Hamiltonian, and which of two solutions is the
//! better one.

use super::tuning::multistart::VARIATION;
use super::warm_start::values_of;
use crate::nlp::{Nlp, Solution, Start};
use crate::problem::{Bounds, Chain};
use crate::random::Random;
use crate::solution::{ChainOutcome, Elsewhere, Outcome};
use crate::transcribe::TranscribedNlp;
use crate::transcribe::chain::ChainNlp;
use crate::transcribe::interval::Signal;

/// The guess (or `base`) with smooth random variations of every signal and unknown; the same for
/// the same seed and index. With an even index unknowns are anywhere within finite bounds, else
/// near their guess.
pub fn perturbed(chain: &Chain, base: Option<Vec<f64>>, index: u32) -> Start {
    let mut nlp = ChainNlp::new(chain);
    let v = base.unwrap_or_else(|| nlp.guess());
    let mut random = random(chain.method().seed, index);
    let whole = Start { v, warm: None };
    let mut own = nlp.shape().split(&whole);
    for (phase, start) in nlp.each().zip(&mut own) {
        vary_signals(phase, &mut random, &mut start.v);
    }
    let mut start = nlp.shape().joined(&own, &whole);
    for place in nlp.shape().unknowns[0]..nlp.shape().unknowns[1] {
        let (value, bounds) = (&mut start.v[place], nlp.variable_bounds()[place]);
        let (room, variation) = (room(bounds, *value, *value), random.next());
        *value = match index.is_multiple_of(2) && (bounds.upper - bounds.lower).is_finite() {
            true => bounds.lower + room * 0.5 * (1.0 + variation),
            false => *value + VARIATION * room.min(value.abs().max(1.0)) * variation,
        };
    }
    start
}

/// Starts at a solution with the controls that make its Hamiltonian less, where others than its own
/// do: with its multipliers, as a large barrier parameter drives controls away from bounds, and
/// without, as the multipliers may lead back.
pub fn elsewhere(chain: &Chain, outcome: &ChainOutcome) -> Vec<Start> {
    let is_violated = |phase: &Outcome| {
        let hamiltonian = &phase.trajectory.hamiltonian;
        hamiltonian.violations.iter().any(|part| *part > 0.0)
    };
    if !outcome.phases.iter().any(is_violated) {
        return Vec::new();
    }
    let mut nlp = ChainNlp::new(chain);
    let whole = Start::near(&outcome.solution);
    let mut own = nlp.shape().split(&whole);
    let mut is_better = false;
    for (at, (phase, problem)) in outcome.phases.iter().zip(&chain.phases).enumerate() {
        let (trajectory, solution) = (&phase.trajectory, &phase.solution);
        let (hamiltonian, time) = (&trajectory.hamiltonian, &trajectory.time);
        if is_violated(phase) && hamiltonian.has_to_be_least(problem, solution) {
            let duration = time[time.len() - 1] - time[0];
            let nlp = nlp.phase_at(at, &whole.v);
            let it = Elsewhere::new(nlp, solution, (duration, hamiltonian));
            is_better |= it.parts.iter().any(|part| *part > 0.0);
            own[at].v = it.v;
        }
    }
    let near = nlp.shape().joined(&own, &whole);
    let cold = Start { v: near.v.clone(), warm: None };
    if is_better { vec![near, cold] } else { Vec::new() }
}

fn vary_signals(nlp: &TranscribedNlp, random: &mut Random, v: &mut [f64]) {
    let problem = nlp.problem();
    let signals =
        (0..problem.layout.x).map(Signal::State).chain((0..problem.layout.u).map(Signal::Control));
    for signal in signals {
        let places = places_of(nlp, signal);
        let values = places.iter().map(|(place, _)| v[*place]);
        let (low, high) =
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        let bounds = nlp.variable_bounds()[places[places.len() - 1].0];
        let size = VARIATION * room(bounds, low, high);
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
fn room(bounds: Bounds, low: f64, high: f64) -> f64 {
    let width = bounds.upper - bounds.lower;
    if width.is_finite() { width } else { (high - low).max(low.abs().max(high.abs())).max(1.0) }
}

/// Whether `a` is the better answer: solved before not solved, then the lower objective, then the
/// smaller violation.
pub fn is_better(a: &Solution, b: &Solution) -> bool {
    match (a.status.is_solved(), b.status.is_solved()) {
        (true, true) => a.objective < b.objective,
        (false, false) => a.constraint_violation < b.constraint_violation,
        (solved, _) => solved,
    }
}

/// A sequence for each seed and index.
fn random(seed: u64, index: u32) -> Random {
    let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ u64::from(index));
    (0..4).for_each(|_| {
        random.next();
    });
    random
}
