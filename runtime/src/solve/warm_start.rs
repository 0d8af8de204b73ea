//! Warm starts: where an earlier solution ended, with multipliers and as much room as the change of
//! the problem asks for.

mod pieces;

pub use pieces::Piece;

use super::tuning::warm_start::{FACTOR, LEAST};
use crate::linalg::Stages;
use crate::nlp::{Solution, Start, Warm, constraint_violation, multiplier_estimate};
use crate::problem::{Chain, Problem};
use crate::transcribe::chain::ChainNlp;
use crate::transcribe::interval::Signal;
use crate::transcribe::{TranscribedNlp, chain_of};
use pieces::Curves;

/// Signals of an earlier solution over normalised time; `None` where it has none of that name.
#[derive(Clone, Default)]
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
    /// The same with what it is between grid points, where that is known, in the order of time;
    /// what they lack is taken from the columns.
    pub pieces: Vec<Piece>,
}

/// The earlier solutions of all phases on the grids of the chain; what they lack comes from the
/// guess.
fn resample(chain: &Chain, earlier: &[Earlier]) -> Vec<f64> {
    let mut nlp = ChainNlp::new(chain);
    let whole = Start { v: nlp.guess(), warm: None };
    let mut own = nlp.shape().split(&whole);
    for ((phase, start), earlier) in nlp.each().zip(&mut own).zip(earlier) {
        resample_phase(phase, earlier, &mut start.v);
    }
    let mut v = nlp.shape().joined(&own, &whole).v;
    for (unknown, place) in chain.unknowns.iter().zip(nlp.shape().unknowns[0]..) {
        let known = |phase: &Problem| {
            phase.unknowns.iter().position(|it| it.parameter == unknown.parameter)
        };
        let mut values =
            chain.phases.iter().zip(earlier).filter_map(|(phase, earlier)| {
                earlier.unknowns.get(known(phase)?).copied().flatten()
            });
        v[place] = values.next_back().unwrap_or(v[place]);
    }
    v
}

fn resample_phase(nlp: &TranscribedNlp, earlier: &Earlier, v: &mut [f64]) {
    let stages = nlp.chain();
    let slots = nlp.interval().slots.clone();
    let curves = Curves::new(nlp.problem(), &earlier.pieces);
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
            let curve = curves.at(slot.signal, nlp.mesh().at(k, slot.time));
            let variable = &mut v[place + k * stages.variable_step()];
            *variable = curve.or(value).unwrap_or(*variable);
        }
    }
}

/// How often a variable of an interval is there: what is carried once more, at the last grid point.
pub(super) fn values_of(place: usize, stages: Stages) -> usize {
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

/// The same without multipliers: a trajectory that is no solution.
pub fn from_trajectories(chain: &Chain, earlier: &[Earlier]) -> Start {
    Start { v: resample(chain, earlier), warm: None }
}

/// The earlier solutions of all phases as a warm start on the grids of the chain. Its multipliers
/// are estimated, with the widths of its layers where the problem names none.
pub fn from_earlier(chain: &Chain, earlier: &[Earlier]) -> Start {
    let v = resample(chain, earlier);
    let widths = earlier.iter().flat_map(|it| it.widths.iter().copied());
    let widths: Vec<f64> = widths.collect::<Option<_>>().unwrap_or_default();
    let warm = first_widths(chain, &widths).and_then(|(first, widths)| {
        let mut nlp = ChainNlp::new(chain);
        nlp.set_widths(&first);
        let multipliers = multiplier_estimate::multipliers(&mut nlp, &v)?;
        Some(Warm { multipliers, mu: Some(room(&mut nlp, &v)), widths })
    });
    Start { v, warm }
}

/// A solution on the same grids, found with these widths, of a chain with other parameters or
/// another width.
pub fn again(chain: &Chain, solution: &Solution, widths: &[f64]) -> Start {
    with_widths(chain, Start::near(solution), widths)
}

/// The same one interval later: each interval begins where the next one was, the last one stays as
/// it is. For a chain of one phase on a uniform grid.
pub fn one_interval_later(chain: &Chain, solution: &Solution, widths: &[f64]) -> Start {
    let mut start = Start::near(solution);
    let stages = chain_of(&chain.phases[0]);
    let Some(Warm { multipliers, .. }) = &mut start.warm else { return start };
    let (step, end) = (stages.variable_step(), stages.intervals * stages.variable_step());
    for variables in [&mut start.v, &mut multipliers.lower, &mut multipliers.upper] {
        variables.copy_within(step..end + stages.states, 0);
    }
    let step = stages.row_step();
    multipliers.constraints.copy_within(step..stages.intervals * step, 0);
    with_widths(chain, start, widths)
}

fn with_widths(chain: &Chain, mut start: Start, widths: &[f64]) -> Start {
    if let (Some(warm), Some((_, widths))) = (&mut start.warm, first_widths(chain, widths)) {
        (warm.mu, warm.widths) = (None, widths);
    }
    start
}

/// Gives a start without a barrier parameter the one that leaves the room that it needs with the
/// widths that are solved first.
pub(super) fn make_room(nlp: &mut ChainNlp, chain: &Chain, start: &mut Start) {
    let Some(warm) = start.warm.as_mut().filter(|warm| warm.mu.is_none()) else { return };
    let first = first_widths(chain, &warm.widths);
    first.into_iter().for_each(|(widths, _)| nlp.set_widths(&widths));
    warm.mu = Some(room(nlp, &start.v));
}

/// The widths that are solved first, and with them the earlier ones where these are taken, because
/// the model names none; `None` if there are none either.
fn first_widths(chain: &Chain, earlier: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
    let method = chain.method();
    let named = method.continuation.first().copied().or(method.sigma);
    let taken = if named.is_none() { earlier } else { &[] };
    let count = chain.surfaces().count();
    if named.is_none() && taken.len() != count {
        return None;
    }
    let widths = (0..count).map(|at| named.unwrap_or_else(|| taken[at]));
    Some((widths.collect(), taken.to_vec()))
}

/// The barrier parameter for a start that violates rows by `r`. Distances from bounds and their
/// multipliers will change in proportion to `r`, and their products by its square.
fn room(nlp: &mut ChainNlp, v: &[f64]) -> f64 {
    let violation = constraint_violation(nlp, v);
    (FACTOR * violation * violation).clamp(LEAST, Warm::ROOM)
}
