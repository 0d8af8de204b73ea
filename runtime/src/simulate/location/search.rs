//! Where along a step a condition `g >= 0` first fails, so that no failure is missed, however
//! short.
//!
//! Over a part of the step `g` is known at both ends, and intervals bound it and its rate `g'`
//! between. The part is done where
//!
//! ```text
//! g is enclosed above 0                                  nothing fails
//! g' has one sign                                        the ends tell
//! g(a) + m u = g(b) - M (b - a - u) >= 0, m <= g' <= M   nothing fails: two lines bound g
//! the part is no longer than rounding                    the ends tell; to touch 0 is not to fail
//! ```
//!
//! The second and the third need a `g` without jumps: its change has to agree with its rate.
//!
//! Any other part is halved, the earlier half first.

use super::sliding;
use super::{Condition, noise, value};
use crate::simulate::field::Field;
use crate::simulate::field::tube::Tube;
use crate::simulate::interval::{ALL, scaled};
use crate::simulate::steps::Step;
use crate::simulate::system::Interval;
use crate::simulate::tuning::search::{
    FAR, FLAT, GOLDEN, MOST_PARTS, ROUNDING, SAMPLES, SECTIONS, SLACK,
};

/// A condition along a step.
pub(crate) struct Signal<'f, 'a> {
    pub field: &'f mut Field<'a>,
    pub step: &'f Step,
    pub condition: Condition,
    pub tube: Tube,
}

/// How a search ends.
pub(crate) enum Search {
    /// The condition holds.
    Holds,
    /// It fails first in this part, at the end of which it is known to fail; what rounding may make
    /// of 0 there.
    Fails([f64; 2], f64),
    /// It holds so far; what comes then takes too long to find out.
    HoldsUntil(f64),
}

/// A part of a step, with the values at its ends.
#[derive(Clone, Copy)]
struct Part {
    ends: [f64; 2],
    values: [f64; 2],
}

impl Part {
    /// The later, then the earlier piece on the two sides of a point with this value.
    fn cut(self, theta: f64, value: f64) -> [Part; 2] {
        let [from, to] = self.ends;
        [
            Part { ends: [theta, to], values: [value, self.values[1]] },
            Part { ends: [from, theta], values: [self.values[0], value] },
        ]
    }
}

enum Verdict {
    Holds,
    /// It fails at this part of the step, where it has this value.
    FailsAt(f64, f64),
    /// By more than this, which rounding may make of 0.
    Fails(f64),
    Open,
}

impl Signal<'_, '_> {
    /// The value at a part of the step.
    pub fn value(&mut self, theta: f64) -> f64 {
        value(self.field, self.condition, self.step.t + theta * self.step.h, &self.step.at(theta))
    }

    /// Value and rate over a part of the step.
    pub(super) fn bounds(&mut self, part: [f64; 2]) -> [Interval; 2] {
        let (enclosure, side) = match self.condition {
            Condition::Reaches(i) => {
                (&self.field.system.enclosures.switching[i], self.field.modes[i].side())
            }
            Condition::CrossesKink(k) => {
                (&self.field.system.enclosures.kinks[k], self.field.side_of(k))
            }
            Condition::Leaves(i) => return sliding::bounds(self, part, i),
            Condition::Parts(i) => return self.reserve_of_rest(part, i),
        };
        let [value, rate] = self.tube.bounds(self.field, self.step, part, enclosure);
        let has_no_value = value[0] > value[1];
        if has_no_value {
            [[f64::INFINITY; 2], ALL]
        } else {
            [scaled(side, value), scaled(side, rate)]
        }
    }

    /// `slack - |psi|` and its rate.
    fn reserve_of_rest(&mut self, part: [f64; 2], surface: usize) -> [Interval; 2] {
        let enclosure = &self.field.system.enclosures.switching[surface];
        let [value, rate] = self.tube.bounds(self.field, self.step, part, enclosure);
        let largest = |[low, high]: Interval| high.max(-low);
        let fastest = largest(rate);
        let slack = self.field.slack[surface];
        let least = slack - largest(value);
        [[if least.is_nan() { f64::NEG_INFINITY } else { least }, slack], [-fastest, fastest]]
    }

    /// Whether the condition holds from the beginning until a part of the step, as one look at the
    /// whole tells.
    pub fn clearly_holds(&mut self, until: f64) -> bool {
        self.bounds([0.0, until])[0][0] >= 0.0
    }

    /// Whether the value changes its sign so often that times cannot be told apart: all values are
    /// what rounding may make of 0, and yet it moves far, as nothing smooth does that stays there.
    pub fn is_unresolved(&mut self, until: f64, noise: f64) -> bool {
        let [least, most] = self.bounds([0.0, until])[0];
        if !(-noise..0.0).contains(&least) || most > noise {
            return false;
        }
        self.moves_farther_than(noise, until)
    }

    /// Whether it moves so fast that it cannot stay within a value without turning often.
    fn moves_farther_than(&mut self, value: f64, until: f64) -> bool {
        let rates = SAMPLES.map(|part| self.bounds([part * until; 2])[1]);
        // Where rounding alone leaves a rate open, it is as fast as that.
        let fastest = rates.iter().map(|[low, high]| high.max(-low)).filter(|it| it.is_finite());
        until * fastest.fold(0.0, f64::max) > FAR * value
    }

    /// Where before a part of the step the condition first fails by more than rounding.
    pub fn first_failure(&mut self, until: f64, noise: f64) -> Search {
        let values = [self.value(0.0), self.value(until)];
        let mut largest = values[0].abs().max(values[1].abs());
        let mut parts = vec![Part { ends: [0.0, until], values }];
        for _ in 0..MOST_PARTS {
            let Some(part) = parts.pop() else { return Search::Holds };
            match self.judge(part, noise) {
                Verdict::Holds => {}
                Verdict::Fails(noise) => return Search::Fails(part.ends, noise),
                Verdict::FailsAt(theta, value) => parts.extend(part.cut(theta, value)),
                Verdict::Open => {
                    let middle = 0.5 * (part.ends[0] + part.ends[1]);
                    let value = self.value(middle);
                    largest = largest.max(value.abs());
                    parts.extend(part.cut(middle, value));
                }
            }
        }
        let is_flat = largest <= FLAT * noise && !self.moves_farther_than(largest, until);
        parts
            .last()
            .filter(|_| !is_flat)
            .map_or(Search::Holds, |part| Search::HoldsUntil(part.ends[0]))
    }

    /// What rounding may make of 0 at a part of the step.
    pub fn noise(&mut self, theta: f64) -> f64 {
        noise(self.field, self.condition, self.step.t + theta * self.step.h, &self.step.at(theta))
    }

    /// `noise` is what rounding may make of 0 at the beginning of the step.
    fn judge(&mut self, part: Part, noise: f64) -> Verdict {
        let [[least, _], [falls, grows]] = self.bounds(part.ends);
        if least >= 0.0 {
            return Verdict::Holds;
        }
        let [from, to] = part.ends;
        // What is rounding at the beginning may be much here, where terms are smaller.
        let is_shallow = least >= -noise;
        let noise = if part.values[1] < 0.0 { self.noise(to).min(noise) } else { noise };
        if is_shallow && part.values[1] >= -noise {
            let [theta, value] = self.lowest(part);
            let fails = theta > from && theta < to && value < -self.noise(theta);
            return if fails { Verdict::FailsAt(theta, value) } else { Verdict::Holds };
        }
        let is_monotonic = falls >= 0.0 || grows <= 0.0;
        let is_short = to - from <= self.shortest();
        if !is_short && !self.is_smooth(part, [falls, grows], noise) {
            return Verdict::Open;
        }
        if is_monotonic || is_short {
            return if part.values[1] < -noise { Verdict::Fails(noise) } else { Verdict::Holds };
        }
        let [at_from, at_to] = part.values;
        let until_lowest = (at_from - at_to + grows * (to - from)) / (grows - falls);
        if at_from + falls * until_lowest >= -noise { Verdict::Holds } else { Verdict::Open }
    }

    /// Whether the values at the ends agree with the rates between them, as the mean value theorem
    /// has it: where they do not, a switching function jumps.
    fn is_smooth(&self, part: Part, [falls, grows]: Interval, noise: f64) -> bool {
        if matches!(self.condition, Condition::Leaves(_)) {
            return true;
        }
        let ([from, to], [at_from, at_to]) = (part.ends, part.values);
        let slack = noise + SLACK * (at_from.abs() + at_to.abs());
        let change = at_to - at_from;
        change >= falls * (to - from) - slack && change <= grows * (to - from) + slack
    }

    /// A part of the step where the value is lowest, and the value, by golden sections (J. Kiefer:
    /// Sequential minimax search for a maximum, Proc. AMS 4 (1953) 502-506).
    fn lowest(&mut self, part: Part) -> [f64; 2] {
        let [mut low, mut high] = part.ends;
        let inner =
            |low: f64, high: f64| [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        let mut at = inner(low, high);
        let mut values = at.map(|theta| self.value(theta));
        for _ in 0..SECTIONS {
            if values[0] <= values[1] {
                high = at[1];
                at = inner(low, high);
                values = [self.value(at[0]), values[0]];
            } else {
                low = at[0];
                at = inner(low, high);
                values = [values[1], self.value(at[1])];
            }
        }
        if values[0] <= values[1] { [at[0], values[0]] } else { [at[1], values[1]] }
    }

    /// A part of the step that rounding hides.
    pub fn shortest(&self) -> f64 {
        let last = (self.step.t + self.step.h).abs().max(self.step.t.abs());
        ROUNDING * (1.0 + last / self.step.h)
    }
}
