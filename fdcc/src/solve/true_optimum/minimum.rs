//! Whether the controls minimise the Hamiltonian over everything that they may be, and not only
//! near what they are (Pontryagin): where it has several minima, a short time at another one may
//! be worth having though no small change of the controls is.

use super::insertion::{Least, at_point, hamiltonian_at, least};
use super::polynomials::polynomials;
use super::range::{Range, ranges};
use super::tuning::certificate::GAIN;
use super::tuning::minimum::{BESIDE, FAR, MOST_TOGETHER, PARTS, POINTS};
use super::{Located, Search};
use fdcc_compiler::Arc;
use fdcc_runtime::lagrange;
use fdcc_runtime::problem::Chain;
use fdcc_runtime::solution::Trajectory;

/// By how much the Hamiltonian is less than it is.
#[derive(Default)]
struct Gain {
    /// At another minimum than the one that is near, at most.
    of_minimum: f64,
    /// At the one that is near; times a part of the time.
    loss: f64,
}

impl Search<'_> {
    /// Compares the controls with others, at some points of each phase; what the objective loses
    /// in each, for its size.
    pub(super) fn compared(&self, located: &mut Located) -> Vec<f64> {
        let size = located.hamiltonian_size();
        let phases = 0..located.structure.phases.len();
        let all: Vec<Gain> = phases.map(|j| self.gain_in_phase(located, j)).collect();
        let losses: Vec<f64> = all.iter().map(|it| it.loss / size).collect();
        located.gain = all.iter().map(|it| it.of_minimum).fold(0.0, f64::max) / size;
        located.loss = losses.iter().sum();
        losses
    }

    /// What is lost is looked for on the first and the last interval: a control may be steep there,
    /// and on a singular arc what the Hamiltonian gains by a large step says nothing.
    fn gain_in_phase(&self, located: &Located, j: usize) -> Gain {
        let time = &located.outcome.phases[j].trajectory.time;
        let [begin, end] = located.structure.ends();
        let last = time.len() - 2;
        let along = PARTS.iter().map(|part| ((part * last as f64) as usize, *part));
        let ends = [(0, BESIDE), (last, BESIDE.map(|it| 1.0 - it))].into_iter();
        let beside = ends.flat_map(|(k, parts)| parts.map(|part| (k, part)));
        let is_noise = located.outcome.phases[j].trajectory.hamiltonian.is_noise;
        let is_free = !is_noise && located.structure.phases[j].arcs.contains(&Arc::Free);
        let mut most = Gain::default();
        for (k, part) in along.chain(beside) {
            let gain = self.gain_at(located, j, (k, part));
            let is_at_end = is_free && (k == 0 || k == last);
            let duration = if is_at_end { time[k + 1] - time[k] } else { 0.0 };
            most.of_minimum = most.of_minimum.max(gain.of_minimum);
            most.loss = most.loss.max(gain.loss * duration / (end - begin));
        }
        most
    }

    /// On interval `k` of a phase, a part of which has passed; the loss is per time.
    fn gain_at(&self, located: &Located, j: usize, (k, part): (usize, f64)) -> Gain {
        let outcome = &located.outcome.phases[j];
        let mut phase = located.structure.phases[j].clone();
        phase.arcs.fill(Arc::Free);
        let point = self.point(outcome, &interpolation(&outcome.trajectory.time, (k, part)));
        let Some(chain) = at_point(self.model, &phase, &point) else { return Gain::default() };
        let value = |controls: &[f64]| match least(&chain, Some(controls), self.stop) {
            Least::Value(value, controls) => Some((value, controls)),
            _ => None,
        };
        let controls = controls_at(&outcome.trajectory, k, point.time);
        let Some((near, controls_near)) = value(&controls) else { return Gain::default() };
        let ranges = ranges(&self.problem.controls, &located.outcome.phases);
        let others = samples(&ranges, &controls);
        let others = others.iter().filter_map(|it| value(it));
        let of_minimum = others.map(|(other, _)| near - other).fold(0.0, f64::max);
        let loss = loss(&chain, &controls, (near, &controls_near));
        // A point of which the way down leads far away is no minimum.
        let is_far = is_far(&ranges, [&controls, &controls_near]);
        Gain { of_minimum: of_minimum.max(if is_far { loss } else { 0.0 }), loss }
    }
}

impl Located {
    /// That of the Hamiltonian, over all phases. Of a motion that rests throughout at no cost all
    /// its terms are rounding: there what is no more than the noise of the solver passes.
    fn hamiltonian_size(&self) -> f64 {
        let all = self.outcome.phases.iter().map(|it| &it.trajectory.hamiltonian);
        let noise = all.clone().map(|it| it.noise).fold(f64::MIN_POSITIVE, f64::max);
        let least = if all.clone().all(|it| it.is_noise) { noise / GAIN } else { 0.0 };
        all.map(|it| it.scale).fold(least.max(f64::MIN_POSITIVE), f64::max)
    }
}

/// Whether a control is another one by a part of its range.
pub(super) fn is_far(ranges: &[Range], [one, other]: [&[f64]; 2]) -> bool {
    let mut each = ranges.iter().zip(one.iter().zip(other));
    each.any(|(range, (a, b))| (a - b).abs() > FAR * range.width)
}

/// By how much the Hamiltonian is less at the minimum that is near, as far as that is curved: on a
/// singular arc it is a straight line, and small slopes of either sign say nothing.
fn loss(chain: &Chain, own: &[f64], (near, controls_near): (f64, &[f64])) -> f64 {
    let middle: Vec<f64> = own.iter().zip(controls_near).map(|(a, b)| 0.5 * (a + b)).collect();
    let [here, between] = [own, &middle].map(|it| hamiltonian_at(chain, it));
    let curved = 2.0 * (here + near - 2.0 * between).abs();
    (here - near).min(curved).max(0.0)
}

/// What a signal is on interval `k` of a grid, a part of which has passed: the polynomial through
/// its values at the points around it.
pub(super) fn interpolation(time: &[f64], (k, part): (usize, f64)) -> impl Fn(&[f64]) -> f64 {
    let first = k.saturating_sub(1).min(time.len().saturating_sub(POINTS));
    let points = first..(first + POINTS).min(time.len());
    let at = time[k] + part * (time[k + 1] - time[k]);
    let weights = lagrange::values(&time[points.clone()], at);
    move |column| lagrange::combined(&weights, column[points.clone()].iter().copied())
}

/// Controls and selectors at a time on interval `k`.
pub(super) fn controls_at(own: &Trajectory, k: usize, time: f64) -> Vec<f64> {
    let value = |at: usize| match polynomials(own, at).get(k) {
        Some(piece) => piece.at(time),
        None => own.controls[at][k],
    };
    (0..own.controls.len()).map(value).collect()
}

/// Each control at several values between its bounds, the others as they are; and all of a few at
/// ends of their ranges, as what one gains may depend on another.
pub(super) fn samples(ranges: &[Range], controls: &[f64]) -> Vec<Vec<f64>> {
    let with = |at: usize, value: f64| {
        let mut other = controls.to_vec();
        other[at] = value;
        other
    };
    let each = ranges.iter().enumerate();
    let alone =
        each.flat_map(|(at, range)| range.tried().into_iter().map(move |value| (at, value)));
    alone.map(|(at, value)| with(at, value)).chain(corners(ranges)).collect()
}

/// All combinations of the ends of a few ranges.
fn corners(ranges: &[Range]) -> Vec<Vec<f64>> {
    if !(2..=MOST_TOGETHER).contains(&ranges.len()) {
        return Vec::new();
    }
    ranges.iter().fold(vec![Vec::new()], |all, range| {
        let with = |corner: &Vec<f64>| range.ends().map(|end| [&corner[..], &[end]].concat());
        all.iter().flat_map(with).collect()
    })
}
