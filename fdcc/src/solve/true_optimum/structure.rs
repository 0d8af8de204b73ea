//! Which modes and arcs follow each other, read from a trajectory.

use fdcc_compiler::{Arc, Mode, PhaseOfModes};
use fdcc_runtime::problem::{Bounds, Problem};
use fdcc_runtime::solution::modes::{self, Span};
use fdcc_runtime::solve::Outcome;

/// A shorter phase, for the whole time, is dropped.
const SHORTEST: f64 = 0.004;
/// So is one of fewer intervals of the grid.
const FEWEST_INTERVALS: f64 = 1.6;
/// A phase that is shorter than this, for the whole time, may be a mistake.
const SHORT: f64 = 0.15;
/// A control is at a bound that is nearer than this, for the distance of its bounds.
const AT_BOUND: f64 = 1e-3;

/// Phases of given modes and the times at which they begin; and the last time.
#[derive(Clone, Debug)]
pub(crate) struct Structure {
    pub phases: Vec<PhaseOfModes>,
    pub times: Vec<f64>,
}

/// What one surface or one control does over time.
struct Track<T> {
    /// Each with the time at which it begins.
    pieces: Vec<(f64, T)>,
}

impl Structure {
    /// That of a smoothed solution.
    pub fn of(problem: &Problem, outcome: &Outcome) -> Self {
        let time = &outcome.trajectory.time;
        let last = time[time.len() - 1];
        let duration = last - time[0];
        let step = duration / (time.len() - 1) as f64;
        let shortest = (SHORTEST * duration).max(FEWEST_INTERVALS * step);
        let modes = outcome.modes.iter().map(|spans| track_of_modes(spans, shortest));
        let modes: Vec<Track<Mode>> = modes.collect();
        let controls = problem.controls.iter().zip(&outcome.trajectory.controls);
        let arcs = controls
            .map(|(control, values)| Track::of_arcs(time, values, control.bounds, shortest));
        let arcs: Vec<Track<Arc>> = arcs.collect();
        let mut begins: Vec<f64> = vec![time[0]];
        begins.extend(modes.iter().flat_map(Track::switches));
        begins.extend(arcs.iter().flat_map(Track::switches));
        begins.sort_by(f64::total_cmp);
        let mut times: Vec<f64> = Vec::new();
        for begin in begins {
            if times.last().is_none_or(|it| begin - it > 0.5 * shortest) {
                times.push(begin);
            }
        }
        times.push(last);
        let phase = |pair: &[f64]| {
            let middle = 0.5 * (pair[0] + pair[1]);
            PhaseOfModes {
                modes: modes.iter().map(|it| it.at(middle)).collect(),
                arcs: arcs.iter().map(|it| it.at(middle)).collect(),
            }
        };
        let phases = times.windows(2).map(phase).collect();
        Structure { phases, times }.merged()
    }

    /// First and last time.
    pub fn ends(&self) -> [f64; 2] {
        [self.times[0], self.times[self.times.len() - 1]]
    }

    /// With new arcs of controls at bounds, as a trajectory that was found for it has them.
    pub fn with_arcs(&self, between: &Problem, located: &[Outcome]) -> Self {
        let mut other = Structure { phases: Vec::new(), times: vec![self.times[0]] };
        for (phase, outcome) in self.phases.iter().zip(located) {
            let time = &outcome.trajectory.time;
            let last = time[time.len() - 1];
            let step = (last - time[0]) / (time.len() - 1) as f64;
            let tracks: Vec<Track<Arc>> =
                (between.controls.iter().zip(&outcome.trajectory.controls))
                    .map(|(it, values)| Track::of_arcs(time, values, it.bounds, 1.5 * step))
                    .collect();
            let mut begins: Vec<f64> = tracks.iter().flat_map(Track::switches).collect();
            begins.sort_by(f64::total_cmp);
            begins.dedup_by(|b, a| *b - *a < 0.5 * step);
            let ends = begins.iter().copied().chain([last]);
            for (begin, end) in [time[0]].into_iter().chain(begins.iter().copied()).zip(ends) {
                let middle = 0.5 * (begin + end);
                let own = |(arc, track): (&Arc, &Track<Arc>)| match arc {
                    Arc::Free => track.at(middle),
                    arc => *arc,
                };
                let arcs = phase.arcs.iter().zip(&tracks).map(own).collect();
                other.phases.push(PhaseOfModes { arcs, ..phase.clone() });
                other.times.push(end);
            }
        }
        other.merged()
    }

    /// Neighbours that are alike are one phase.
    pub fn merged(mut self) -> Self {
        let mut j = 1;
        while j < self.phases.len() {
            if self.phases[j] == self.phases[j - 1] {
                self.phases.remove(j);
                self.times.remove(j);
            } else {
                j += 1;
            }
        }
        self
    }

    /// With free controls on holds; if they are free already, without the shortest phase as long as
    /// that is short.
    pub fn simpler(&self) -> Option<Self> {
        let mut other = self.clone();
        for phase in other.phases.iter_mut().filter(|it| it.modes.contains(&Mode::Held)) {
            phase.arcs.fill(Arc::Free);
        }
        if other.phases != self.phases {
            return Some(other.merged());
        }
        let durations = self.times.windows(2).map(|pair| pair[1] - pair[0]).enumerate();
        let shortest = durations.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let [first, last] = self.ends();
        let is_short = shortest.1 < SHORT * (last - first);
        (self.phases.len() > 1 && is_short).then(|| self.without(shortest.0))
    }

    /// Without a phase, whose time its neighbours share.
    pub fn without(&self, j: usize) -> Self {
        self.clone().without_phase(j).merged()
    }

    /// The same; neighbours that are alike stay two.
    pub fn without_phase(self, j: usize) -> Self {
        let mut other = self.clone();
        other.phases.remove(j);
        let middle = 0.5 * (other.times[j] + other.times[j + 1]);
        other.times.remove(j);
        if j > 0 && j < other.phases.len() {
            other.times[j] = middle;
        } else if j == 0 {
            other.times[0] = self.times[0];
        } else {
            let last = other.times.len() - 1;
            other.times[last] = self.times[self.times.len() - 1];
        }
        other
    }
}

/// The distance of the bounds of a control, or their size where one is infinite.
pub(crate) fn width(bounds: Bounds) -> f64 {
    match bounds.upper - bounds.lower {
        width if width.is_finite() => width,
        _ => [bounds.lower, bounds.upper]
            .into_iter()
            .filter(|it| it.is_finite())
            .fold(1.0, |a: f64, it| a.max(it.abs())),
    }
}

fn track_of_modes(spans: &[Span], shortest: f64) -> Track<Mode> {
    let mode = |span: &Span| match span.mode {
        modes::Mode::Below => Mode::Below,
        modes::Mode::Held => Mode::Held,
        modes::Mode::Above => Mode::Above,
    };
    let pieces = spans.iter().map(|span| (span.from, mode(span))).collect();
    let last = spans.last().map_or(0.0, |span| span.to);
    Track { pieces }.without_short(last, shortest)
}

impl Track<Arc> {
    /// Of a control by its values on the intervals.
    fn of_arcs(time: &[f64], values: &[f64], bounds: Bounds, shortest: f64) -> Self {
        let width = width(bounds);
        let arc = |value: &f64| match () {
            () if value - bounds.lower < AT_BOUND * width => Arc::Lower,
            () if bounds.upper - value < AT_BOUND * width => Arc::Upper,
            () => Arc::Free,
        };
        let mut pieces: Vec<(f64, Arc)> = Vec::new();
        for (time, value) in time.iter().zip(values) {
            let arc = arc(value);
            if pieces.last().is_none_or(|it| it.1 != arc) {
                pieces.push((*time, arc));
            }
        }
        let last = time[time.len() - 1];
        Track { pieces }.with_switches(shortest).without_short(last, shortest)
    }

    /// A short free piece between opposite bounds is one switch, in its middle.
    fn with_switches(mut self, shortest: f64) -> Self {
        let mut j = 1;
        while j + 1 < self.pieces.len() {
            let [before, own, after] = [self.pieces[j - 1], self.pieces[j], self.pieces[j + 1]];
            let is_short = after.0 - own.0 <= 1.5 * shortest;
            let are_opposite = before.1 != after.1 && before.1 != Arc::Free && after.1 != Arc::Free;
            if own.1 == Arc::Free && is_short && are_opposite {
                self.pieces[j + 1].0 = 0.5 * (own.0 + after.0);
                self.pieces.remove(j);
            } else {
                j += 1;
            }
        }
        self
    }
}

impl<T: Copy + PartialEq> Track<T> {
    fn switches(&self) -> impl Iterator<Item = f64> {
        self.pieces.iter().skip(1).map(|it| it.0)
    }

    fn at(&self, time: f64) -> T {
        let at = self.pieces.partition_point(|it| it.0 <= time).saturating_sub(1);
        self.pieces[at].1
    }

    /// Short pieces go to the one before, the first to the one behind.
    fn without_short(mut self, last: f64, shortest: f64) -> Self {
        let mut j = 0;
        while j < self.pieces.len() && self.pieces.len() > 1 {
            let end = self.pieces.get(j + 1).map_or(last, |it| it.0);
            if end - self.pieces[j].0 < shortest {
                let begin = self.pieces.remove(j).0;
                if j < self.pieces.len() {
                    self.pieces[j].0 = begin;
                }
                j = j.saturating_sub(1);
            } else {
                j += 1;
            }
        }
        self.pieces.dedup_by(|b, a| a.1 == b.1);
        self
    }
}
