//! The signs of multipliers of states and path conditions that are kept at their bounds or touch
//! them.
//!
//! Where a limit is on an arc, `nu` is the multiplier of `c^(q) = 0`, and that of the bound itself
//! is
//!
//! ```text
//! mu = (-1)^q d^q nu / dt^q
//! ```
//!
//! (by parts, `q` times); its sign is that of the bound, or the motion would rather leave it. The
//! multiplier of `c = 0` at a touch point has that sign, too. So have what is left at the ends of
//! an arc, where no free motion leads to it or away from it,
//!
//! ```text
//! kappa - F where it begins,   F where it ends,   F = (-1)^(q-1) d^(q-1) nu / dt^(q-1)
//! ```
//!
//! with the `kappa` of `c = 0` where the arc begins: a phase that begins at a bound may be better
//! off it.

use super::Located;
use super::contacts::Contacts;
use super::tuning::signs::POINTS;
use fdcc_compiler::graph::ExprId;
use fdcc_compiler::model::Symbol;
use fdcc_compiler::{Arc, Model};
use fdcc_runtime::lagrange;
use fdcc_runtime::solution::Trajectory;

/// An arc or a touch point, at the beginning of a phase, whose multiplier has the wrong sign.
pub(crate) struct Wrong {
    pub phase: usize,
    pub limit: usize,
    /// By how much, for its largest value.
    pub part: f64,
    /// Whether it is the multiplier where the phase begins, between two arcs.
    pub is_at_corner: bool,
}

impl Contacts<'_> {
    /// What contradicts that a limit is at its bound, most of all.
    pub fn wrong_sign(&self) -> Option<Wrong> {
        let mut all = Vec::new();
        for (j, phase) in self.located.structure.phases.iter().enumerate() {
            for limit in 0..self.limits.len() {
                let arc = (phase.contacts[limit] != Arc::Free)
                    .then(|| self.wrong_of_arc(j, limit, phase.contacts[limit]));
                let touch = (j > 0 && phase.touches[limit] != Arc::Free)
                    .then(|| self.wrong_of_touch(j, limit, phase.touches[limit]));
                let ends = self.wrong_at_ends(j, limit, phase.contacts[limit]);
                let parts = arc.into_iter().chain(touch).chain(ends);
                let wrong = |part| Wrong { phase: j, limit, part, is_at_corner: false };
                all.extend(parts.map(wrong));
            }
        }
        all.extend(self.wrong_at_corners());
        all.into_iter().max_by(|a, b| a.part.total_cmp(&b.part))
    }

    /// Gives path conditions on arcs the multipliers of their bounds, in a trajectory of all
    /// phases.
    pub fn put_multipliers(&self, whole: &mut Trajectory) {
        let mut first = 0;
        for (j, phase) in self.located.structure.phases.iter().enumerate() {
            let time = &self.located.outcome.phases[j].trajectory.time;
            let states = self.limits.iter().filter(|it| it.state.is_some()).count();
            for limit in (states..self.limits.len()).filter(|at| phase.contacts[*at] != Arc::Free) {
                let order = self.limits[limit].order.unwrap_or(0);
                let nu = self.located.outcome.phases[j].trajectory.path_multipliers
                    [self.row(j, limit)]
                .clone();
                let mu = (0..order).fold(nu, |own, _| falls(time, &own));
                whole.path_multipliers[limit - states][first..first + mu.len()]
                    .copy_from_slice(&mu);
            }
            first += time.len() - 1;
        }
    }

    fn wrong_of_arc(&self, j: usize, limit: usize, arc: Arc) -> f64 {
        let own = self.multipliers(j, limit);
        let largest = own.iter().fold(f64::MIN_POSITIVE, |a: f64, it| a.max(it.abs()));
        let order = self.limits[limit].order.unwrap_or(0);
        let mu = (0..order).fold(own, |own, _| own.windows(2).map(|it| it[0] - it[1]).collect());
        mu.iter().map(|it| -side(arc) * it / largest).fold(f64::NEG_INFINITY, f64::max)
    }

    fn wrong_of_touch(&self, j: usize, limit: usize, arc: Arc) -> f64 {
        let kappa = self.kappa_of_entry(j, limit).unwrap_or(0.0);
        self.part_at_once(j, limit, -side(arc) * kappa)
    }

    /// What is wrong at the first time of an arc and at its last, where these are the ends of all
    /// phases or a jump leads there. Where the state is given there is nothing that could be wrong.
    fn wrong_at_ends(&self, j: usize, limit: usize, arc: Arc) -> Vec<f64> {
        let (located, order) = (self.located, self.limits[limit].order.unwrap_or(0));
        if arc == Arc::Free || order == 0 {
            return Vec::new();
        }
        let phases = &located.structure.phases;
        let density = At::new(located, j, self.multipliers(j, limit), order);
        let begins = (j == 0 || phases[j].jump.is_some())
            .then(|| Some(density.less_than(self.kappa_of_entry(j, limit)?, side(arc))));
        let is_last = j + 1 == phases.len() && !self.is_given_in_the_end(limit);
        let ends = is_last.then(|| density.at_the_end(side(arc)));
        let all = begins.flatten().into_iter().chain(ends);
        all.map(|wrong| self.part_at_once(j, limit, wrong)).collect()
    }

    /// The multiplier of `c = 0` at the first time of a phase; nothing where it is no condition.
    pub(super) fn kappa_of_entry(&self, j: usize, limit: usize) -> Option<f64> {
        let (located, name) = (self.located, self.name(j, limit));
        if j > 0 {
            return located.link_multiplier(j, &format!("{name} reached"));
        }
        let problem = &located.chain.phases[0];
        let label = format!("{name} at the start");
        let mut rows = 0..located.starts.len();
        let row = rows.find(|row| *problem.boundary.origin(row + 1).label == *label)?;
        Some(problem.sense * located.starts[row])
    }

    /// Whether an equation at the last time reads a state that the limit reads.
    pub(super) fn is_given_in_the_end(&self, limit: usize) -> bool {
        let model = self.model;
        let states = self.limits.iter().filter(|it| it.state.is_some()).count();
        let read: Vec<usize> = match self.limits[limit].state {
            Some(state) => vec![state],
            None => states_of(model, model.path[limit - states].value),
        };
        let equations = model.boundary.iter().filter(|it| it.range.lower == it.range.upper);
        let mut given = equations.flat_map(|it| states_of(model, it.value));
        given.any(|state| read.contains(&state))
    }

    pub(super) fn name(&self, j: usize, limit: usize) -> String {
        self.located.chain.phases[j].path.origin(self.row(j, limit)).label.to_string()
    }

    /// A multiplier that acts at one time, by what it is worth over the range of its limit.
    pub(super) fn part_at_once(&self, j: usize, limit: usize, multiplier: f64) -> f64 {
        let duration = self.located.structure.ends()[1] - self.located.structure.ends()[0];
        multiplier * self.ranges[limit] / (self.size(j) * duration)
    }
}

/// The `F` of an arc at its two ends, from what it is on the first and on the last intervals; and
/// how uncertain that is.
pub(super) struct At {
    pub begin: [f64; 2],
    pub end: [f64; 2],
}

impl At {
    pub fn new(located: &Located, j: usize, nu: Vec<f64>, order: usize) -> Self {
        let time = &located.outcome.phases[j].trajectory.time;
        let values = (1..order).fold(nu, |own, _| falls(time, &own));
        let last = time.len() - 1;
        let middles: Vec<f64> = time.windows(2).map(|it| 0.5 * (it[0] + it[1])).collect();
        let through = |points: usize, from_end: bool| {
            let points = points.min(last);
            let range = if from_end { last - points..last } else { 0..points };
            let at = if from_end { time[last] } else { time[0] };
            let weights = lagrange::values(&middles[range.clone()], at);
            lagrange::combined(&weights, values[range].iter().copied())
        };
        let of = |from_end| {
            let value = through(POINTS, from_end);
            [value, (value - through(POINTS - 1, from_end)).abs()]
        };
        At { begin: of(false), end: of(true) }
    }

    /// By how much `kappa - F` has the other sign, for certain.
    fn less_than(&self, kappa: f64, side: f64) -> f64 {
        -side * (kappa - self.begin[0]) - self.begin[1]
    }

    /// The same of `F` where the arc ends.
    pub fn at_the_end(&self, side: f64) -> f64 {
        -side * self.end[0] - self.end[1]
    }
}

/// The states that a value reads, at any time.
pub(super) fn states_of(model: &Model, value: ExprId) -> Vec<usize> {
    let state = |at: u32| match &model.symbols[at as usize] {
        Symbol::State(state) | Symbol::AtEnd(state) => Some(*state),
        _ => None,
    };
    model.graph.inputs_of(&[value]).into_iter().filter_map(state).collect()
}

/// Minus the derivative by time of what is known on intervals.
pub(super) fn falls(time: &[f64], values: &[f64]) -> Vec<f64> {
    let middle = |k: usize| 0.5 * (time[k] + time[k + 1]);
    let last = values.len() - 1;
    let slope = |k: usize| {
        let (a, b) = (k.saturating_sub(1), (k + 1).min(last));
        if a == b { 0.0 } else { (values[a] - values[b]) / (middle(b) - middle(a)) }
    };
    (0..values.len()).map(slope).collect()
}

/// 1 where a bound is a lower one.
pub(super) fn side(arc: Arc) -> f64 {
    match arc {
        Arc::Lower => 1.0,
        Arc::Free => 0.0,
        Arc::Upper => -1.0,
    }
}
