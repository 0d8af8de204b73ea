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
//! bounds how far a pulse inside could move the state. If the sum over all parts is a small part of
//! the state for every state, the step is as it seems. Else the part that may hide most is halved,
//! and the rate in its middle compared with that of the curve:
//!
//! ```text
//! d = f(t, p(t)) - p'(t)
//! ```
//!
//! Where it shows a pulse, the step is too long. Intervals of a right side in which an input occurs
//! often may be wide however smooth it is, but so they are everywhere: after a few parts only
//! what stands out is halved any more.

use crate::simulate::bernstein::{slopes, value};
use crate::simulate::field::Field;
use crate::simulate::field::tube::Tube;
use crate::simulate::result::Method;
use crate::simulate::steps::Step;
use crate::simulate::tuning::hidden::{
    EVEN_PARTS, LEAST_OF_WHOLE, MOST_PARTS, PART, ROUNDINGS, STANDS_OUT, TOLERANCES,
};

/// A part of the step, with the rates at its ends.
struct Part {
    ends: [f64; 2],
    /// The rates of the rows at both ends.
    rates: [Vec<f64>; 2],
    /// What intervals leave of each row between: a rate.
    hidden: Vec<f64>,
}

impl Part {
    fn length(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }
}

/// A state whose rate is looked at.
struct Row {
    state: usize,
    /// How far it may be moved unseen.
    allowed: f64,
    /// How fast it forgets: its own slope, as far as the method knows it.
    fades: f64,
}

impl Row {
    /// How far a rate moves the state in a time.
    fn moved(&self, rate: f64, time: f64) -> f64 {
        if rate == 0.0 { 0.0 } else { rate * time.min(1.0 / self.fades) }
    }
}

/// The part of a step at which something begins that its stages do not know of; nothing if there is
/// no such thing.
pub(crate) fn first_hidden(field: &mut Field, step: &Step) -> Option<f64> {
    if field.system.enclosures.sudden.is_empty() {
        return None;
    }
    let tube = Tube::new(field);
    let mut search = Search { step, rows: Vec::new(), tube, field };
    let whole = search.begin()?;
    let selectors = search.field.selectors.clone();
    let found = search.halve(whole);
    search.field.selectors.copy_from_slice(&selectors);
    found
}

struct Search<'s, 'a> {
    field: &'s mut Field<'a>,
    step: &'s Step,
    rows: Vec<Row>,
    tube: Tube,
}

impl Search<'_, '_> {
    /// Looks at the whole step: notes the rows that may hide something.
    fn begin(&mut self) -> Option<Part> {
        let mut hidden = Vec::new();
        let system = self.field.system;
        for &state in &system.enclosures.sudden {
            if self.field.held.contains(&state) {
                continue;
            }
            let width = self.width(state, [0.0, 1.0]);
            let (rate, h) = ((width - self.step.spread(state)).max(0.0), self.step.h);
            let mut row = self.row(state, width);
            if row.moved(rate, h) <= row.allowed {
                continue;
            }
            row.allowed = row.allowed.max(ROUNDINGS * self.rounding(state) * h);
            if row.moved(rate, h) > row.allowed {
                self.rows.push(row);
                hidden.push(rate);
            }
        }
        if self.rows.is_empty() {
            return None;
        }
        let ends = [0.0, 1.0];
        Some(Part { ends, rates: [self.rates(0.0), self.rates(1.0)], hidden })
    }

    /// A state whose rate has bounds of some width along the step.
    fn row(&self, state: usize, width: f64) -> Row {
        let Step { h, start, end, method, newton, .. } = self.step;
        let tolerance = &self.field.tolerance;
        let size = start[state].abs().max(end[state].abs()).max(tolerance.sizes[state]);
        let part = PART.max(TOLERANCES * tolerance.rtol);
        let whole = if width.is_finite() { LEAST_OF_WHOLE * width * h } else { 0.0 };
        let fades = if *method == Method::Stiff { newton.own_slope(state) } else { 0.0 };
        Row { state, allowed: (part * size).max(whole), fades }
    }

    /// What rounding makes of a rate.
    fn rounding(&mut self, state: usize) -> f64 {
        self.width(state, [0.0; 2]).max(self.width(state, [1.0; 2]))
    }

    /// The width of the bounds of a rate during a part of the step; 0 where it has no value.
    fn width(&mut self, state: usize, part: [f64; 2]) -> f64 {
        let rate = &self.field.system.enclosures.flow[state];
        self.tube.go_to(self.field, self.step, part, rate);
        self.tube.evaluate(rate);
        let [low, high] = self.tube.ranges[0];
        (high - low).max(0.0)
    }

    /// The rates of the rows at a part of the step.
    fn rates(&mut self, theta: f64) -> Vec<f64> {
        let at = self.step.at(theta);
        let rate = self.field.rate(self.step.t + theta * self.step.h, &at);
        self.rows.iter().map(|row| rate[row.state]).collect()
    }

    /// Halves the part that may hide most, again and again.
    fn halve(&mut self, whole: Part) -> Option<f64> {
        let mut parts = vec![whole];
        while parts.len() < MOST_PARTS {
            let (worst, share) = self.worst(&parts)?;
            if parts.len() >= EVEN_PARTS && share < STANDS_OUT {
                return None;
            }
            let part = parts.swap_remove(worst);
            let middle = 0.5 * (part.ends[0] + part.ends[1]);
            let rates = self.rates(middle);
            if self.contradicts(&part, middle, &rates) {
                return Some(part.ends[0]);
            }
            let [first, last] = part.rates;
            parts.push(self.part([part.ends[0], middle], [first, rates.clone()]));
            parts.push(self.part([middle, part.ends[1]], [rates, last]));
        }
        None
    }

    fn part(&mut self, ends: [f64; 2], rates: [Vec<f64>; 2]) -> Part {
        let mut hidden = Vec::new();
        for at in 0..self.rows.len() {
            let known = (rates[1][at] - rates[0][at]).abs();
            hidden.push((self.width(self.rows[at].state, ends) - known).max(0.0));
        }
        Part { ends, rates, hidden }
    }

    /// The part that may hide most of the row that may hide most, and its share of that, none if
    /// there are no bounds; nothing if no row may be moved farther than it is allowed to.
    fn worst(&self, parts: &[Part]) -> Option<(usize, f64)> {
        let mut worst = (1.0, 0);
        let hides = |part: &Part, at: usize| part.hidden[at] * part.length() * self.step.h;
        for (at, row) in self.rows.iter().enumerate() {
            let sum: f64 = parts.iter().map(|part| hides(part, at)).sum();
            let most = parts.iter().map(|part| part.hidden[at]).fold(0.0, f64::max);
            let ratio = sum.min(row.moved(most, f64::INFINITY)) / row.allowed;
            if ratio > worst.0 {
                worst = (ratio, at);
            }
        }
        if worst.0 == 1.0 {
            return None;
        }
        let of = |part: &Part| hides(part, worst.1);
        let sum: f64 = parts.iter().map(of).sum();
        let largest = (0..parts.len()).max_by(|a, b| of(&parts[*a]).total_cmp(&of(&parts[*b])))?;
        let share = of(&parts[largest]) / sum;
        Some((largest, if share.is_nan() { 0.0 } else { share }))
    }

    /// Whether the rates in the middle of a part are not those of the curve.
    fn contradicts(&self, part: &Part, middle: f64, rates: &[f64]) -> bool {
        let h = self.step.h;
        self.rows.iter().zip(rates).any(|(row, rate)| {
            let slopes = slopes(&self.step.extension.coefficients(row.state));
            let defect = (rate - value(&slopes, middle) / h).abs();
            row.moved(defect, part.length() * h) > row.allowed
        })
    }
}
