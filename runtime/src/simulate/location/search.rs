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
//! Any other part is halved, the earlier half first.

use super::interval::{ALL, scaled};
use super::sliding;
use super::{Condition, value};
use crate::simulate::field::Field;
use crate::simulate::field::tube::Tube;
use crate::simulate::steps::Step;
use crate::simulate::system::Interval;
use crate::simulate::tuning::search::{FLAT, MOST_PARTS, ROUNDING};

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
    /// It fails first in this part, at the end of which it is known to fail.
    Fails([f64; 2]),
    /// It holds so far; what comes then takes too long to find out.
    HoldsUntil(f64),
}

/// A part of a step, with the values at its ends.
#[derive(Clone, Copy)]
struct Part {
    ends: [f64; 2],
    values: [f64; 2],
}

enum Verdict {
    Holds,
    Fails,
    Open,
}

impl Signal<'_, '_> {
    /// The value at a part of the step.
    pub fn value(&mut self, theta: f64) -> f64 {
        value(self.field, self.condition, self.step.t + theta * self.step.h, &self.step.at(theta))
    }

    /// Value and rate over a part of the step.
    fn bounds(&mut self, part: [f64; 2]) -> [Interval; 2] {
        let (enclosure, side) = match self.condition {
            Condition::Reaches(i) => {
                (&self.field.system.enclosures.guards[i], self.field.modes[i].side())
            }
            Condition::CrossesKink(k) => {
                (&self.field.system.enclosures.kinks[k], self.field.side_of(k))
            }
            Condition::Leaves(i) => return sliding::bounds(self, part, i),
        };
        let [value, rate] = self.tube.bounds(self.field, self.step, part, enclosure);
        let has_no_value = value[0] > value[1];
        if has_no_value {
            [[f64::INFINITY; 2], ALL]
        } else {
            [scaled(side, value), scaled(side, rate)]
        }
    }

    /// Whether the condition holds from the beginning until a part of the step, as one look at the
    /// whole tells.
    pub fn clearly_holds(&mut self, until: f64) -> bool {
        self.bounds([0.0, until])[0][0] >= 0.0
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
                Verdict::Fails => return Search::Fails(part.ends),
                Verdict::Open => {
                    let middle = 0.5 * (part.ends[0] + part.ends[1]);
                    let value = self.value(middle);
                    largest = largest.max(value.abs());
                    parts.push(Part {
                        ends: [middle, part.ends[1]],
                        values: [value, part.values[1]],
                    });
                    parts.push(Part {
                        ends: [part.ends[0], middle],
                        values: [part.values[0], value],
                    });
                }
            }
        }
        let is_flat = largest <= FLAT * noise;
        parts
            .last()
            .filter(|_| !is_flat)
            .map_or(Search::Holds, |part| Search::HoldsUntil(part.ends[0]))
    }

    fn judge(&mut self, part: Part, noise: f64) -> Verdict {
        let [[least, _], [falls, grows]] = self.bounds(part.ends);
        if least >= -noise {
            return Verdict::Holds;
        }
        let [from, to] = part.ends;
        if falls >= 0.0 || grows <= 0.0 || to - from <= self.shortest() {
            return if part.values[1] < -noise { Verdict::Fails } else { Verdict::Holds };
        }
        let [at_from, at_to] = part.values;
        let until_lowest = (at_from - at_to + grows * (to - from)) / (grows - falls);
        if at_from + falls * until_lowest >= -noise { Verdict::Holds } else { Verdict::Open }
    }

    /// A part of the step that rounding hides.
    fn shortest(&self) -> f64 {
        let last = (self.step.t + self.step.h).abs().max(self.step.t.abs());
        ROUNDING * (1.0 + last / self.step.h)
    }
}
