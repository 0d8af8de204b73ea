//! States and path conditions at their bounds, by the multipliers of a located trajectory.
//!
//! Where a limit is bounded by an inequality, its multiplier says on which intervals it is active.

use super::Located;
use super::path_values::{path_at_ends, path_values, slopes};
use super::tracks::Track;
use super::tuning::contacts::{
    FEWEST_OF_ARC, FEWEST_OF_HOLD, NEAR, NEAR_BOUND, NONE, NONE_OF_LARGEST, OF_BOUND, SEEN, TOUCHED,
};
use super::tuning::structure::SHORTEST;
use fdcc_compiler::{Arc, Limit, Mode, Model, PhaseOfModes, Switch, limits, may_hold};

/// The limits of a model along a located trajectory.
pub(crate) struct Contacts<'l> {
    pub(super) model: &'l Model,
    pub(super) located: &'l Located,
    pub(super) limits: Vec<Limit>,
    /// How far each limit goes up and down.
    pub(super) ranges: Vec<f64>,
}

/// What limits and surfaces do in a phase.
#[derive(Default)]
pub(crate) struct InPhase {
    /// One for each of [`Model::switches`].
    pub modes: Vec<Track<Mode>>,
    /// One for each limit.
    pub arcs: Vec<Track<Arc>>,
    /// Inside of the phase.
    pub touches: Vec<Touch>,
    /// Where the phase begins and where it ends.
    pub at_ends: [Vec<Touch>; 2],
}

/// A limit that is reached for a moment.
pub(crate) struct Touch {
    pub time: f64,
    pub limit: usize,
    pub arc: Arc,
}

/// Intervals on which a limit is active.
pub(super) struct Run {
    pub first: usize,
    pub behind: usize,
    pub arc: Arc,
}

impl Run {
    /// How many intervals it has, if all were of the same length.
    fn count(&self, time: &[f64]) -> usize {
        let count = time.len() - 1;
        let part = (time[self.behind] - time[self.first]) / (time[count] - time[0]);
        (part * count as f64).round() as usize
    }
}

impl<'l> Contacts<'l> {
    pub fn new(model: &'l Model, located: &'l Located) -> Self {
        let mut own = Contacts { model, located, limits: limits(model), ranges: Vec::new() };
        own.ranges = (0..own.limits.len()).map(|limit| own.range(limit)).collect();
        own
    }

    /// New arcs and touch points of a phase; and holds, where the motion stays on a surface on one
    /// side of which it is said to be.
    pub fn of_phase(&self, j: usize, phase: &PhaseOfModes) -> InPhase {
        let time = &self.located.outcome.phases[j].trajectory.time;
        let modes = self.modes_of_phase(j, phase);
        let mut found = InPhase { modes, ..InPhase::default() };
        for (at, (limit, contact)) in self.limits.iter().zip(&phase.contacts).enumerate() {
            let mut pieces = vec![(time[0], *contact)];
            let runs = if *contact == Arc::Free { self.runs_of_limit(j, at) } else { Vec::new() };
            for run in runs.into_iter().filter(|it| !self.is_known(j, at, it)) {
                match (limit.order, run.count(time)) {
                    (Some(0), 0 | 1) => {}
                    (None | Some(2..), count) if count < FEWEST_OF_ARC => {
                        let time = self.middle(j, at, &run);
                        let touch = Touch { time, limit: at, arc: run.arc };
                        match self.end_near(j, &run) {
                            Some(end) => found.at_ends[end].push(touch),
                            None => found.touches.push(touch),
                        }
                    }
                    // Without a control nothing keeps it there.
                    (None, _) => {}
                    _ => pieces.extend([(time[run.first], run.arc), (time[run.behind], Arc::Free)]),
                }
            }
            found.arcs.push(Track { pieces }.cleaned(time[time.len() - 1]));
        }
        found
    }

    /// What a limit does in a phase, as its values show, from which parts of the phase on: an arc
    /// may be there that nothing keeps, where others say the same, or where its inequality is
    /// active at the nodes.
    pub fn seen(&self, j: usize, limit: usize) -> Vec<(f64, Arc)> {
        let known = self.located.structure.phases[j].contacts[limit];
        if known != Arc::Free {
            return vec![(0.0, known)];
        }
        let (problem, row) = (&self.located.chain.phases[j], self.row(j, limit));
        let trajectory = &self.located.outcome.phases[j].trajectory;
        let (bounds, time) = (problem.path_bounds[row], &trajectory.time);
        let values = path_at_ends(problem, trajectory);
        let is_at = |bound: f64, k: usize| {
            let off = |k: usize| (values.column(row)[k] - bound).abs();
            let before = k.saturating_sub(1);
            off(k) <= SEEN * self.ranges[limit] && off(before) <= SEEN * self.ranges[limit]
        };
        let mut pieces: Vec<(f64, Arc)> = Vec::new();
        for k in 0..time.len() - 1 {
            let arc = match () {
                () if is_at(bounds.lower, k) => Arc::Lower,
                () if is_at(bounds.upper, k) => Arc::Upper,
                () => Arc::Free,
            };
            if pieces.last().is_none_or(|it| it.1 != arc) {
                let part = (time[k] - time[0]) / (time[time.len() - 1] - time[0]);
                pieces.push((part, arc));
            }
        }
        pieces
    }

    /// Whether a run is what is left of an arc or a touch point at that end of the phase.
    fn is_known(&self, j: usize, limit: usize, run: &Run) -> bool {
        let phases = &self.located.structure.phases;
        let is_at_bound = |arc: Arc| arc == run.arc;
        let count = self.located.outcome.phases[j].trajectory.time.len() - 1;
        let before = j.checked_sub(1).map(|before| &phases[before]);
        let begins = is_at_bound(phases[j].touches[limit])
            || before.is_some_and(|it| is_at_bound(it.contacts[limit]));
        let time = &self.located.outcome.phases[j].trajectory.time;
        let ends = match phases.get(j + 1) {
            Some(it) => is_at_bound(it.touches[limit]) || is_at_bound(it.contacts[limit]),
            // What is reached in the end alone is not left again.
            None => run.count(time) < FEWEST_OF_ARC,
        };
        begins && run.first < NEAR || ends && run.behind + NEAR > count
    }

    /// Whether a limit is active at one end of a phase: 0 or 1.
    pub(super) fn is_active_at(&self, j: usize, limit: usize, arc: Arc, end: usize) -> bool {
        let count = self.located.outcome.phases[j].trajectory.time.len() - 1;
        let mut runs = self.runs_of_limit(j, limit).into_iter().filter(|it| it.arc == arc);
        runs.any(|run| if end == 0 { run.first < NEAR } else { run.behind + NEAR > count })
    }

    /// The end of a phase at which a run is, where a surface changes its mode and nothing jumps: 0
    /// or 1.
    fn end_near(&self, j: usize, run: &Run) -> Option<usize> {
        let phases = &self.located.structure.phases;
        let count = self.located.outcome.phases[j].trajectory.time.len() - 1;
        let is_switch = |before: usize| phases[before].modes != phases[before + 1].modes;
        let goes_on = |at: usize| phases.get(at).is_some_and(|it| it.jump.is_none());
        match () {
            () if j > 0 && goes_on(j) && is_switch(j - 1) && run.first < NEAR => Some(0),
            () if goes_on(j + 1) && is_switch(j) && run.behind + NEAR > count => Some(1),
            () => None,
        }
    }

    fn modes_of_phase(&self, j: usize, phase: &PhaseOfModes) -> Vec<Track<Mode>> {
        let outcome = &self.located.outcome.phases[j];
        let time = &outcome.trajectory.time;
        let mut row = self.model.path.len();
        let [first, last] = self.located.structure.ends();
        let mut tracks = Vec::new();
        let switches = self.model.switches();
        for ((at, switch), may_hold) in switches.iter().enumerate().zip(may_hold(self.model)) {
            let mode = &phase.modes[at];
            let mut pieces = vec![(time[0], *mode)];
            if *mode != Mode::Held && !switch.is_ball && may_hold {
                for run in self.runs(j, row, self.range_of_switch(at)) {
                    let is_long = time[run.behind] - time[run.first] > SHORTEST * (last - first);
                    if is_long && run.count(time) >= FEWEST_OF_HOLD {
                        pieces.extend([(time[run.first], Mode::Held), (time[run.behind], *mode)]);
                    }
                }
            }
            tracks.push(Track { pieces }.cleaned(time[time.len() - 1]));
            row += rows_of_switch(switch, *mode);
        }
        tracks
    }

    /// When a surface of which a phase is on one side is touched inside of it with a multiplier.
    pub(super) fn pressed(&self, j: usize, switch: usize) -> Vec<f64> {
        let time = &self.located.outcome.phases[j].trajectory.time;
        let row = self.row_of_switch(j, switch);
        let runs = self.runs(j, row, self.range_of_switch(switch)).into_iter();
        let inside = runs.filter(|it| it.first >= NEAR && it.behind + NEAR < time.len());
        inside.map(|it| 0.5 * (time[it.first] + time[it.behind])).collect()
    }

    /// When the motion comes to such a surface and turns, without a multiplier.
    pub(super) fn turns(&self, j: usize, switch: usize) -> Vec<f64> {
        let trajectory = &self.located.outcome.phases[j].trajectory;
        let row = self.row_of_switch(j, switch);
        let psi = path_values(&self.located.chain.phases[j], trajectory, row);
        let least = TOUCHED * self.range_of_switch(switch);
        let turns = (NEAR..psi.len().saturating_sub(NEAR)).filter(|k| {
            let [before, own, after] = [psi[k - 1], psi[*k], psi[k + 1]].map(f64::abs);
            own <= before && own < after && nearest(before, own, after) <= least
        });
        turns.map(|k| trajectory.time[k]).collect()
    }

    fn runs_of_limit(&self, j: usize, limit: usize) -> Vec<Run> {
        self.runs(j, self.row(j, limit), self.ranges[limit])
    }

    /// Where the multiplier of an inequality is not 0, and its bound is near.
    pub(super) fn runs(&self, j: usize, row: usize, range: f64) -> Vec<Run> {
        let own = self.multipliers_of_row(j, row);
        let problem = &self.located.chain.phases[j];
        let bounds = problem.path_bounds[row];
        let values = path_values(problem, &self.located.outcome.phases[j].trajectory, row);
        let largest = own.iter().fold(0.0, |a: f64, it| a.max(it.abs()));
        let least = (NONE * self.size(j) / range).max(NONE_OF_LARGEST * largest);
        let is_near = |k: usize, bound: f64| {
            let ends = values[k..].iter().take(2);
            ends.map(|it| (it - bound).abs()).fold(f64::INFINITY, f64::min) < NEAR_BOUND * range
        };
        let arc = |(k, nu): (usize, &f64)| match () {
            () if *nu > least && is_near(k, bounds.lower) => Arc::Lower,
            () if -nu > least && is_near(k, bounds.upper) => Arc::Upper,
            () => Arc::Free,
        };
        let mut runs: Vec<Run> = Vec::new();
        let arcs = own.iter().enumerate().map(arc).enumerate();
        for (k, arc) in arcs.filter(|it| it.1 != Arc::Free) {
            match runs.last_mut().filter(|it| it.arc == arc && k <= it.behind + 1) {
                Some(run) => run.behind = k + 1,
                None => runs.push(Run { first: k, behind: k + 1, arc }),
            }
        }
        runs
    }

    /// Where the multipliers of a run have their centre.
    fn middle(&self, j: usize, limit: usize, run: &Run) -> f64 {
        let (own, time) =
            (self.multipliers(j, limit), &self.located.outcome.phases[j].trajectory.time);
        let (mut sum, mut moment) = (0.0, 0.0);
        for k in run.first..run.behind {
            sum += own[k];
            moment += own[k] * 0.5 * (time[k] + time[k + 1]);
        }
        moment / sum
    }

    /// Of the minimisation problem, per time, on each interval.
    pub(super) fn multipliers(&self, j: usize, limit: usize) -> Vec<f64> {
        self.multipliers_of_row(j, self.row(j, limit))
    }

    pub(super) fn multipliers_of_row(&self, j: usize, row: usize) -> Vec<f64> {
        let problem = &self.located.chain.phases[j];
        let own = &self.located.outcome.phases[j].trajectory.path_multipliers;
        own[row].iter().map(|it| problem.sense * it).collect()
    }

    /// How far the function of a surface goes up and down where it is not held.
    pub(super) fn range_of_switch(&self, switch: usize) -> f64 {
        let mut range = Extent::default();
        for (j, phase) in self.located.structure.phases.iter().enumerate() {
            if phase.modes[switch] != Mode::Held {
                self.extend(&mut range, j, self.row_of_switch(j, switch));
            }
        }
        range.length()
    }

    /// The first path condition of a phase that is of a surface, or behind all of these.
    pub(super) fn row_of_switch(&self, j: usize, switch: usize) -> usize {
        let (switches, phase) = (self.model.switches(), &self.located.structure.phases[j]);
        let before = switches[..switch].iter().zip(&phase.modes);
        let rows: usize = before.map(|(it, mode)| rows_of_switch(it, *mode)).sum();
        self.model.path.len() + rows
    }

    pub(super) fn extend(&self, range: &mut Extent, j: usize, row: usize) {
        let (problem, outcome) = (&self.located.chain.phases[j], &self.located.outcome.phases[j]);
        path_values(problem, &outcome.trajectory, row).into_iter().for_each(|it| range.add(it));
    }

    /// The path condition of a phase that bounds a limit.
    pub(super) fn row(&self, j: usize, limit: usize) -> usize {
        let states = self.limits.iter().filter(|it| it.state.is_some()).count();
        match limit.checked_sub(states) {
            Some(row) => row,
            None => self.located.chain.phases[j].path_bounds.len() - states + limit,
        }
    }

    /// That of the Hamiltonian of a phase; of measured data, which say nothing of phases without
    /// rows behind them, of all.
    pub(super) fn size(&self, j: usize) -> f64 {
        let size = match self.model.sums.is_empty() {
            true => self.located.size_of_phase(j),
            false => self.located.largest_size(),
        };
        size.max(self.located.least_size(self.model))
    }

    /// How far a limit goes up and down; on an arc, its condition is another one. One on which
    /// controls act may be at its bound from the beginning to the end.
    fn range(&self, limit: usize) -> f64 {
        let mut range = Extent::default();
        for (j, phase) in self.located.structure.phases.iter().enumerate() {
            if phase.contacts[limit] == Arc::Free {
                self.extend(&mut range, j, self.row(j, limit));
            }
        }
        if self.limits[limit].order == Some(0) {
            let bounds = self.located.chain.phases[0].path_bounds[self.row(0, limit)];
            let sizes = [bounds.lower, bounds.upper].into_iter().filter(|it| it.is_finite());
            let least = range.length().max(self.by_controls(limit));
            return sizes.fold(least, |most, it| most.max(OF_BOUND * it.abs()));
        }
        range.length()
    }

    /// How far controls move a limit: where it is at its bound in all phases, though they differ.
    fn by_controls(&self, limit: usize) -> f64 {
        let phases = &self.located.outcome.phases;
        let extent = |control: usize| {
            let mut extent = Extent::default();
            let values = phases.iter().flat_map(|it| &it.trajectory.controls[control]);
            values.for_each(|it| extent.add(*it));
            extent.length()
        };
        let (problem, row) = (&self.located.chain.phases[0], self.row(0, limit));
        let by = |control: usize| {
            let slopes = slopes(problem, &phases[0].trajectory, row, control);
            slopes.iter().fold(0.0, |most: f64, it| most.max(it.abs())) * extent(control)
        };
        (0..self.model.controls.len()).map(by).sum()
    }
}

/// The least value of the parabola through three values, the middle of which is the least.
fn nearest(before: f64, own: f64, after: f64) -> f64 {
    let (slope, curvature) = (0.5 * (after - before), after + before - 2.0 * own);
    if curvature > 0.0 { own - 0.5 * slope * slope / curvature } else { own }
}

/// The least and the largest of some values.
pub(super) struct Extent([f64; 2]);

impl Default for Extent {
    fn default() -> Self {
        Extent([f64::INFINITY, f64::NEG_INFINITY])
    }
}

impl Extent {
    fn add(&mut self, value: f64) {
        self.0 = [self.0[0].min(value), self.0[1].max(value)];
    }

    pub fn length(&self) -> f64 {
        (self.0[1] - self.0[0]).max(f64::MIN_POSITIVE)
    }
}

/// How many path conditions a phase has for a surface.
pub(super) fn rows_of_switch(switch: &Switch, mode: Mode) -> usize {
    let count = switch.surfaces.len();
    match (mode, switch.is_ball) {
        (Mode::Held, true) => count + 1,
        (Mode::Held, false) | (_, false) => count,
        (_, true) => 0,
    }
}
