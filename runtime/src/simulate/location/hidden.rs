//! What the right side does between the points where a step looks at it: a pulse that no stage
//! meets leaves no trace in the error of the step.
//!
//! Over a part of a step intervals bound each rate. What is left of their width when the change
//! between the points that are known is taken off,
//!
//! ```text
//! (width of f_i over the part - |f_i(b) - f_i(a)|) (b - a) h,
//! ```
//!
//! bounds how far a pulse inside could move the state. If the sum over all parts is small beside
//! the way of the state so far, the step is as it seems. Else the part that may hide most is
//! halved, and the rate in its middle compared with that of the curve:
//!
//! ```text
//! d = f(t, p(t)) - p'(t)
//! ```
//!
//! Where it shows a pulse, the step is too long. Intervals of a right side in which an input occurs
//! often may be wide however smooth it is, but so they are everywhere: after a few parts only
//! what stands out is halved any more.
//!
//! Selectors that follow the state answer to a pulse at once. Bounds, and what is known between
//! them, are those of the right side with the selectors of one point; the defect is the true one,
//! and counts for every state, as selectors pass pulses on.

use crate::simulate::bernstein::value;
use crate::simulate::field::Field;
use crate::simulate::field::tube::Tube;
use crate::simulate::mode::Mode;
use crate::simulate::result::Method;
use crate::simulate::steps::Step;
use crate::simulate::tuning::hidden::{
    EVEN_PARTS, LEAST_OF_WHOLE, MOST_PARTS, PART, ROUNDINGS, STANDS_OUT, TOLERANCES,
};

/// A part of the step, with the rates of all states at its ends.
struct Part {
    ends: [f64; 2],
    rates: [Vec<f64>; 2],
    /// What intervals leave of each row between: a rate.
    hidden: Vec<f64>,
}

/// The part of a step at which something begins that its stages do not know of; nothing if there is
/// no such thing.
pub(crate) fn first_hidden(field: &mut Field, step: &Step) -> Option<f64> {
    if field.system.enclosures.sudden.is_empty() {
        return None;
    }
    let (tube, selectors) = (field.lend_tube(), field.selectors.clone());
    let is_fixed = !field.modes.iter().any(|mode| matches!(mode, Mode::Sliding | Mode::Moving));
    let mut search = Search { step, rows: Vec::new(), tube, selectors, is_fixed, field };
    let found = search.begin().and_then(|whole| search.halve(whole));
    let Search { field, selectors, tube, .. } = search;
    field.selectors.copy_from_slice(&selectors);
    field.tube = Some(tube);
    found
}

struct Search<'s, 'a> {
    field: &'s mut Field<'a>,
    step: &'s Step,
    /// The states that something may move unseen, and how far it may.
    rows: Vec<(usize, f64)>,
    tube: Tube,
    /// Those of the end of the step, and whether they are the same all along.
    selectors: Vec<f64>,
    is_fixed: bool,
}

impl Search<'_, '_> {
    /// Looks at the whole step, and notes the rows that may hide something.
    fn begin(&mut self) -> Option<Part> {
        let (mut hidden, mut ends) = (Vec::new(), None);
        let system = self.field.system;
        for &state in &system.enclosures.sudden {
            let width = self.width(state, [0.0, 1.0]);
            let most = self.moved(state, width);
            if self.field.held.contains(&state) || most <= self.allowed(state) {
                continue;
            }
            let rate = (width - self.known(state, &mut ends)).max(0.0);
            let limit = self.limit(state, most);
            if self.moved(state, rate) > limit {
                self.rows.push((state, limit));
                hidden.push(rate);
            }
        }
        if self.rows.is_empty() {
            return None;
        }
        let rates = ends.unwrap_or_else(|| [0.0, 1.0].map(|end| self.rates(end)));
        Some(Part { ends: [0.0, 1.0], rates, hidden })
    }

    /// By how much a rate is known to change along the step.
    fn known(&mut self, state: usize, ends: &mut Option<[Vec<f64>; 2]>) -> f64 {
        if self.is_fixed {
            let [low, high] = self.step.rates(state);
            return high - low;
        }
        let [first, last] = ends.get_or_insert_with(|| [0.0, 1.0].map(|end| self.rates(end)));
        (last[state] - first[state]).abs()
    }

    /// How far a state may be moved unseen, as its way and its tolerance tell.
    fn allowed(&self, state: usize) -> f64 {
        let Step { h, start, end, .. } = self.step;
        let (tolerance, [low, high]) = (&self.field.tolerance, self.step.rates(state));
        let ends = [start[state], end[state]];
        let way = (h * low.abs().max(high.abs())).max((ends[1] - ends[0]).abs());
        let exact = TOLERANCES * tolerance.of(state, ends, 0.0);
        exact.max(PART * way.max(tolerance.ways[state]))
    }

    /// The same, as bounds that would move it so far over the whole step tell, and rounding, too.
    fn limit(&mut self, state: usize, most: f64) -> f64 {
        let rounding = [0.0, 1.0].map(|end| self.width(state, [end; 2]));
        let rounding = ROUNDINGS * self.step.h * rounding[0].max(rounding[1]);
        let whole = if most.is_finite() { LEAST_OF_WHOLE * most } else { 0.0 };
        self.allowed(state).max(rounding).max(whole)
    }

    /// How far a rate moves a state along the step. One that is fast forgets it soon.
    fn moved(&self, state: usize, rate: f64) -> f64 {
        self.moved_in(state, rate, self.step.h)
    }

    fn moved_in(&self, state: usize, rate: f64, time: f64) -> f64 {
        let fades = match self.step.method {
            Method::Stiff => self.step.newton.own_slope(state),
            Method::Explicit => 0.0,
        };
        if rate == 0.0 { 0.0 } else { rate * time.min(1.0 / fades) }
    }

    /// The width of the bounds of a rate during a part of the step; 0 where it has no value.
    fn width(&mut self, state: usize, part: [f64; 2]) -> f64 {
        let rate = &self.field.system.enclosures.flow[state];
        self.tube.go_to(self.field, self.step, part, rate);
        self.tube.evaluate(rate);
        let [low, high] = self.tube.ranges[0];
        (high - low).max(0.0)
    }

    /// All rates at a part of the step, with the selectors of its end.
    fn rates(&mut self, theta: f64) -> Vec<f64> {
        let (t, at) = (self.step.t + theta * self.step.h, self.step.at(theta));
        if self.is_fixed {
            self.field.rate(t, &at)
        } else {
            self.field.with_selectors(t, &at, &self.selectors).0
        }
    }

    /// Halves the part that may hide most, again and again.
    fn halve(&mut self, whole: Part) -> Option<f64> {
        let mut parts = vec![whole];
        while parts.len() < MOST_PARTS {
            let (worst, share) = self.worst(&parts)?;
            if parts.len() >= EVEN_PARTS && share < STANDS_OUT {
                return None;
            }
            let Part { ends: [from, to], rates: [first, last], .. } = parts.swap_remove(worst);
            let middle = 0.5 * (from + to);
            let rates = self.rates(middle);
            if self.contradicts([from, to], &rates) {
                return Some(from);
            }
            parts.push(self.part([from, middle], [first, rates.clone()]));
            parts.push(self.part([middle, to], [rates, last]));
        }
        None
    }

    fn part(&mut self, ends: [f64; 2], rates: [Vec<f64>; 2]) -> Part {
        let mut hidden = Vec::new();
        for at in 0..self.rows.len() {
            let state = self.rows[at].0;
            let known = (rates[1][state] - rates[0][state]).abs();
            hidden.push((self.width(state, ends) - known).max(0.0));
        }
        Part { ends, rates, hidden }
    }

    /// The part that may hide most of the row that may hide most, and its share of that, none if
    /// there are no bounds; nothing if no row may be moved farther than it is allowed to.
    fn worst(&self, parts: &[Part]) -> Option<(usize, f64)> {
        let hides =
            |part: &Part, at: usize| part.hidden[at] * (part.ends[1] - part.ends[0]) * self.step.h;
        let ratio = |at: usize| {
            let (state, limit) = self.rows[at];
            let sum: f64 = parts.iter().map(|part| hides(part, at)).sum();
            let most = parts.iter().map(|part| part.hidden[at]).fold(0.0, f64::max);
            sum.min(self.moved_in(state, most, f64::INFINITY)) / limit
        };
        let ratios = (0..self.rows.len()).map(|at| (at, ratio(at)));
        let (row, _) = ratios.filter(|it| it.1 > 1.0).max_by(|a, b| a.1.total_cmp(&b.1))?;
        let all: Vec<f64> = parts.iter().map(|part| hides(part, row)).collect();
        let at = (0..all.len()).max_by(|a, b| all[*a].total_cmp(&all[*b]))?;
        let share = all[at] / all.iter().sum::<f64>();
        Some((at, if share.is_nan() { 0.0 } else { share }))
    }

    /// Whether the rates in the middle of a part are not those of the curve.
    fn contradicts(&mut self, [from, to]: [f64; 2], rates: &[f64]) -> bool {
        let (middle, time) = (0.5 * (from + to), (to - from) * self.step.h);
        let beside = |search: &Self, state: usize, rate: f64| {
            let slopes = search.step.extension.slopes(state);
            let defect = (rate - value(&slopes, middle) / search.step.h).abs();
            search.moved_in(state, defect, time)
        };
        if self.is_fixed {
            return self.rows.iter().any(|row| beside(self, row.0, rates[row.0]) > row.1);
        }
        let rates = self.field.rate(self.step.t + middle * self.step.h, &self.step.at(middle));
        (0..rates.len()).any(|state| {
            let beside = beside(self, state, rates[state]);
            beside > self.allowed(state) && {
                let width = self.width(state, [0.0, 1.0]);
                beside > self.limit(state, self.moved(state, width))
            }
        })
    }
}
