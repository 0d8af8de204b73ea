//! Which modes and arcs follow each other, read from a trajectory.

use super::Whole;
use super::contacts::{Contacts, InPhase};
use super::polynomials::{Rough, beyond_bounds, polynomials, roughness};
use super::range::{Range, ranges};
use super::tracks::Track;
use super::tuning::repair::NOTHING;
use super::tuning::structure::{
    AT_END, BEYOND, FEWEST_INTERVALS, HALVINGS, INACCURATE, LOSS, MOST_HALVINGS, PART_OF_LARGEST,
    SAME_SWITCH, SHORTEST, SHORTEST_ARC, TRIED, TRIED_BESIDE,
};
use fdcc_compiler::{Arc, Mode, PhaseOfModes};
use fdcc_runtime::problem::{ControlShape, Problem};
use fdcc_runtime::solve::Outcome;
use std::slice;

/// Which of the arcs that controls have in a phase are taken over.
#[derive(Clone, Copy)]
pub(crate) enum NewArcs {
    All,
    /// The longest of each control: short ones may be noise.
    Longest,
}

/// Phases of given modes and the times at which they begin; and the last time.
#[derive(Clone, Debug)]
pub(crate) struct Structure {
    pub phases: Vec<PhaseOfModes>,
    pub times: Vec<f64>,
}

impl Structure {
    /// That of a trajectory.
    pub fn of(problem: &Problem, whole: &Whole, limits: usize) -> Self {
        let outcome = &whole.outcome;
        let jumps: Vec<(f64, usize)> = whole.jumps.iter().map(|it| (it.1.time, it.0)).collect();
        let time = &outcome.trajectory.time;
        let last = time[time.len() - 1];
        let duration = last - time[0];
        let step = duration / (time.len() - 1) as f64;
        let shortest = (SHORTEST * duration).max(FEWEST_INTERVALS * step);
        let least = if whole.is_exact { NOTHING * duration } else { shortest };
        let modes = outcome.modes.iter().map(|spans| Track::of_modes(spans, least));
        let modes: Vec<Track<Mode>> = modes.collect();
        let ranges = ranges(&problem.controls, slice::from_ref(outcome));
        let controls = ranges.iter().zip(&outcome.trajectory.controls);
        let arcs = controls.map(|(range, values)| Track::of_arcs(time, values, range, shortest));
        let arcs: Vec<Track<Arc>> = arcs.collect();
        let mut begins: Vec<f64> = vec![time[0]];
        begins.extend(modes.iter().flat_map(Track::switches));
        begins.extend(arcs.iter().flat_map(Track::switches));
        begins.sort_by(f64::total_cmp);
        let mut times: Vec<f64> = jumps.iter().map(|it| it.0).collect();
        for begin in begins {
            if times.iter().all(|it| (begin - it).abs() > 0.5 * least) {
                times.push(begin);
            }
        }
        times.push(last);
        times.sort_by(f64::total_cmp);
        // Of measured data the Hamiltonian does not tell how accurate a trajectory is.
        let is_told = problem.has_objective && problem.measurements.is_empty();
        let is_coarse = is_told && !whole.is_exact;
        let phase = |pair: &[f64]| {
            let middle = 0.5 * (pair[0] + pair[1]);
            PhaseOfModes {
                jump: jumps.iter().find(|it| it.0 == pair[0]).map(|it| it.1),
                modes: modes.iter().map(|it| it.at(middle)).collect(),
                arcs: arcs.iter().map(|it| it.at(middle)).collect(),
                contacts: vec![Arc::Free; limits],
                touches: vec![Arc::Free; limits],
                shape: ControlShape::Polynomial,
                halvings: if is_coarse { 0 } else { HALVINGS },
                is_graded: false,
                steep: Vec::new(),
                is_cut: false,
                is_joined: false,
            }
        };
        let phases = times.windows(2).map(phase).collect();
        Structure { phases, times }.merged()
    }

    /// How many limits are reached, surfaces held and controls joined.
    pub fn conditions(&self) -> usize {
        let of = |phase: &PhaseOfModes| {
            let limits = phase.contacts.iter().chain(&phase.touches);
            let held = phase.modes.iter().filter(|it| **it == Mode::Held);
            let reached = limits.filter(|it| **it != Arc::Free).count();
            reached + held.count() + usize::from(phase.is_joined)
        };
        self.phases.iter().map(of).sum()
    }

    /// How much finer than at first its intervals are.
    pub fn fineness(&self) -> u32 {
        let of = |it: &PhaseOfModes| it.halvings + u32::from(it.is_graded) + it.steep.len() as u32;
        self.phases.iter().map(of).sum()
    }

    /// Whether a phase is a hold between two phases on the same side: where it shrinks to nothing
    /// the surface is touched.
    pub fn is_touch(&self, j: usize) -> bool {
        let beside = j.checked_sub(1).map(|it| &self.phases[it]).zip(self.phases.get(j + 1));
        beside.is_some_and(|(before, after)| {
            let modes = self.phases[j].modes.iter().zip(&before.modes).zip(&after.modes);
            modes.into_iter().any(|((own, a), b)| *own == Mode::Held && a == b && *a != Mode::Held)
        })
    }

    /// Whether the modes of another structure follow each other as its own do.
    pub fn has_modes_of(&self, other: &Structure) -> bool {
        self.phases.iter().map(|it| &it.modes).eq(other.phases.iter().map(|it| &it.modes))
    }

    /// First and last time.
    pub fn ends(&self) -> [f64; 2] {
        [self.times[0], self.times[self.times.len() - 1]]
    }

    /// With new touch points and arcs of limits, and arcs of the controls of a problem, as a
    /// trajectory that was found for it has them.
    pub fn with_arcs(
        &self,
        between: Option<(&Problem, NewArcs)>,
        contacts: &Contacts,
        located: &[Outcome],
    ) -> Self {
        let mut other = Structure { phases: Vec::new(), times: vec![self.times[0]] };
        let mut touched_before = Vec::new();
        let between = between.map(|it| (ranges(&it.0.controls, located), it.1));
        for ((j, phase), outcome) in self.phases.iter().enumerate().zip(located) {
            let mut arcs = between.as_ref().map_or(Vec::new(), |it| arcs_of(&it.0, outcome, it.1));
            let mut phase = phase.clone();
            let roughness = between.as_ref().and_then(|it| roughness(&it.0, outcome));
            if let Some(roughness) = roughness.filter(|_| !phase.needs_polynomials()) {
                // What noise does at bounds are no arcs.
                arcs.clear();
                smooth(&mut phase, roughness);
            }
            if phase.are_controls_given() {
                arcs.clear();
            }
            let found = contacts.of_phase(j, &phase);
            for touch in found.at_ends[0].iter().chain(&touched_before) {
                if phase.contacts[touch.limit] == Arc::Free {
                    phase.touches[touch.limit] = touch.arc;
                }
            }
            other.append(&phase, &outcome.trajectory.time, &arcs, &found);
            [_, touched_before] = found.at_ends;
        }
        other.merged()
    }

    /// Appends a phase, divided where its controls and limits change what they do.
    fn append(
        &mut self,
        phase: &PhaseOfModes,
        time: &[f64],
        arcs: &[Track<Arc>],
        contacts: &InPhase,
    ) {
        let last = time[time.len() - 1];
        let step = least_step(time);
        let touched = contacts.touches.iter().map(|it| it.time);
        let tracks = arcs.iter().chain(&contacts.arcs).flat_map(Track::switches);
        let held = contacts.modes.iter().flat_map(Track::switches);
        let mut begins: Vec<f64> = tracks.chain(held).chain(touched).collect();
        begins.sort_by(f64::total_cmp);
        begins.dedup_by(|b, a| *b - *a < SAME_SWITCH * step);
        let ends = begins.iter().copied().chain([last]);
        for (begin, end) in [time[0]].into_iter().chain(begins.iter().copied()).zip(ends) {
            let middle = 0.5 * (begin + end);
            let mut own = phase.clone();
            for (arc, track) in own.arcs.iter_mut().zip(arcs).filter(|it| *it.0 == Arc::Free) {
                *arc = track.at(middle);
            }
            own.contacts = contacts.arcs.iter().map(|it| it.at(middle)).collect();
            if own.contacts != phase.contacts {
                own.arcs.fill(Arc::Free);
            }
            own.modes = contacts.modes.iter().map(|it| it.at(middle)).collect();
            if own.modes != phase.modes {
                own.release();
            }
            if own.needs_polynomials() {
                own.shape = ControlShape::Polynomial;
            }
            if !begins.is_empty() {
                // What was steep at an end has a phase of its own now.
                own.is_graded = false;
                own.steep.clear();
            }
            if begin > time[0] {
                own.touches.fill(Arc::Free);
                (own.jump, own.is_cut, own.is_joined) = (None, false, false);
            }
            for touch in contacts.touches.iter().filter(|it| (it.time - begin).abs() < 0.5 * step) {
                own.touches[touch.limit] = touch.arc;
            }
            self.phases.push(own);
            self.times.push(end);
        }
    }

    /// With shorter intervals where a trajectory is not accurate.
    pub fn finer(&self, between: &Problem, located: &[Outcome]) -> Self {
        let mut other = self.clone();
        let roughness = self.roughness(between, located);
        for (phase, roughness) in other.phases.iter_mut().zip(roughness) {
            let is_rough = phase.shape == ControlShape::Polynomial && roughness > 1.0;
            phase.halvings += u32::from(is_rough && phase.halvings < MOST_HALVINGS);
        }
        other
    }

    /// By how much the Hamiltonian of each phase varies though time itself does not matter, or a
    /// control is beyond its bounds between nodes, for what is allowed.
    pub fn roughness(&self, between: &Problem, located: &[Outcome]) -> Vec<f64> {
        let [first, last] = self.ends();
        let ranges = ranges(&between.controls, located);
        let beyond = between.method.accuracy.map_or(BEYOND, |it| 0.5 * it);
        let of = |(outcome, varies): (&Outcome, f64)| {
            let varies = varies / (INACCURATE * (last - first));
            varies.max(beyond_bounds(&ranges, &outcome.trajectory) / beyond)
        };
        located.iter().zip(variations(located)).map(of).collect()
    }

    /// With graded intervals, and then with shorter ones, where the objective loses these parts of
    /// its size by controls that are not the best ones: they are steep where a phase begins or
    /// ends.
    pub fn graded(&self, losses: &[f64]) -> Self {
        let mut other = self.clone();
        for (phase, _) in other.phases.iter_mut().zip(losses).filter(|it| *it.1 > LOSS) {
            phase.halvings += u32::from(phase.is_graded && phase.halvings < MOST_HALVINGS);
            phase.is_graded = true;
        }
        other
    }

    /// With all intervals halved; nothing where some were halved so often.
    pub fn halved(&self, most: u32) -> Option<Self> {
        let mut other = self.clone();
        other.phases.iter_mut().for_each(|it| it.halvings += 1);
        let is_too_fine = other.phases.iter().any(|it| it.halvings > most);
        (!is_too_fine).then_some(other)
    }

    /// Neighbours that are alike are one phase.
    pub fn merged(mut self) -> Self {
        let mut j = 1;
        while j < self.phases.len() {
            if self.phases[j].goes_on(&self.phases[j - 1]) {
                self.phases.remove(j);
                self.times.remove(j);
            } else {
                j += 1;
            }
        }
        self
    }

    /// How often controls jump though nothing else changes.
    pub fn cuts(&self) -> usize {
        self.phases.iter().filter(|it| it.is_cut).count()
    }

    /// With a time inside of a phase at which controls may jump.
    pub fn with_cut(&self, j: usize, time: f64) -> Self {
        let mut other = self.clone();
        let mut own =
            PhaseOfModes { jump: None, is_cut: true, is_joined: false, ..self.phases[j].clone() };
        own.touches.fill(Arc::Free);
        // They were parts of the whole of it.
        own.steep.clear();
        other.phases[j].steep.clear();
        other.phases.insert(j + 1, own);
        other.times.insert(j + 1, time);
        other
    }

    /// With a short phase before another, or behind the last.
    pub fn with_phase(&self, before: usize, phase: PhaseOfModes) -> Self {
        let [first, last] = self.ends();
        let length = (TRIED * (last - first)).min(TRIED_BESIDE * self.shortest_beside(before));
        self.with_phase_of_length(before, phase, length)
    }

    /// The same with one that is as long as half of the shortest phase beside it.
    pub fn with_longer_phase(&self, before: usize, phase: PhaseOfModes) -> Self {
        self.with_phase_of_length(before, phase, 0.5 * self.shortest_beside(before))
    }

    fn shortest_beside(&self, before: usize) -> f64 {
        let beside = [before.checked_sub(1), Some(before).filter(|it| *it < self.phases.len())];
        let lengths = beside.into_iter().flatten().map(|j| self.times[j + 1] - self.times[j]);
        lengths.fold(f64::INFINITY, f64::min)
    }

    fn with_phase_of_length(&self, before: usize, phase: PhaseOfModes, length: f64) -> Self {
        let mut other = self.clone();
        let at = self.times[before];
        let ends = match before {
            0 => [at, at + length],
            _ if before == self.phases.len() => [at - length, at],
            _ => [at - 0.5 * length, at + 0.5 * length],
        };
        other.phases.insert(before, phase);
        other.times.splice(before..=before, ends);
        other
    }
}

/// By how much of its size the Hamiltonian changes inside of each phase, times its duration; 0
/// where time matters by itself. While something rests all of its terms are rounding: beside those
/// of the other phases they count as a small part of them.
pub(crate) fn variations(phases: &[Outcome]) -> impl Iterator<Item = f64> {
    let scales = phases.iter().map(|it| it.trajectory.hamiltonian.scale);
    let least = PART_OF_LARGEST * scales.fold(0.0, f64::max);
    phases.iter().map(move |it| variation(it, least))
}

fn variation(phase: &Outcome, least: f64) -> f64 {
    let (own, time) = (&phase.trajectory.hamiltonian, &phase.trajectory.time);
    let lowest = own.values.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = own.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let is_meant = own.is_constant && !own.is_noise;
    let duration = time[time.len() - 1] - time[0];
    if is_meant { (largest - lowest) / own.scale.max(least) * duration } else { 0.0 }
}

/// What is steep at an end is smooth on graded grids, and on shorter intervals; a singular arc is
/// rough on all as long as its control is a polynomial.
fn smooth(phase: &mut PhaseOfModes, rough: Rough) {
    match (rough, phase.is_graded, phase.halvings) {
        (Rough::AtEnds, true, 0) => phase.halvings = 1,
        (Rough::AtEnds, true, _) | (Rough::Throughout, ..) => phase.shape = ControlShape::Linear,
        _ => {}
    }
    phase.is_graded = true;
}

/// The length of the shortest interval.
fn least_step(time: &[f64]) -> f64 {
    time.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min)
}

/// What each control does in a phase, by its values at the nodes.
fn arcs_of(ranges: &[Range], outcome: &Outcome, which: NewArcs) -> Vec<Track<Arc>> {
    let own = &outcome.trajectory;
    let [first, last] = [own.time[0], own.time[own.time.len() - 1]];
    let step = least_step(&own.time);
    let of = |(at, range): (usize, &Range)| match &own.nodes {
        Some(nodes) => {
            // A value holds until half way to the next node.
            let halves = nodes.time.windows(2).map(|it| 0.5 * (it[0] + it[1]));
            let time: Vec<f64> = [first].into_iter().chain(halves).chain([last]).collect();
            let track = Track::of_arcs(&time, &nodes.values[at], range, 0.5 * step);
            let pieces = polynomials(own, at);
            let ends = [(&pieces[0], 0), (&pieces[pieces.len() - 1], 1)];
            let bounds = ends.map(|(piece, end)| piece.bound_at(end, range));
            track.with_ends(
                bounds,
                [first, last],
                [0, own.time.len() - 2].map(|k| AT_END * (own.time[k + 1] - own.time[k])),
            )
        }
        None => Track::of_arcs(&own.time, &own.controls[at], range, SHORTEST_ARC * step),
    };
    let tracks = ranges.iter().enumerate().map(of);
    match which {
        NewArcs::All => tracks.collect(),
        NewArcs::Longest => tracks.map(|it| it.with_longest(last)).collect(),
    }
}
