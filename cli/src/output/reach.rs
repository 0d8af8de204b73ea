//! How far a condition can be met where nothing feasible was found, as data and in words.

use super::units::Units;
use fdcc_runtime::solve::Limiting;
use serde::Serialize;

/// Where what was found without being feasible is off most.
#[derive(Clone, Debug, Serialize)]
pub struct LargestViolation {
    /// The equation or the condition that is violated.
    pub of: String,
    /// The condition that stands against the equations most, if `of` is an equation.
    pub condition: Option<String>,
    /// In SI; of an equation in one step.
    pub violation: f64,
    /// Of an equation the sum over all steps.
    pub in_all: f64,
    /// Nothing where it is at no single time.
    pub time: Option<f64>,
}

impl From<&Limiting> for LargestViolation {
    fn from(it: &Limiting) -> Self {
        LargestViolation {
            of: it.origin.label.to_string(),
            condition: it.condition.as_ref().map(|it| it.label.to_string()),
            violation: it.violation,
            in_all: it.in_all,
            time: it.time,
        }
    }
}

/// The condition that stands in the way, and its best value with all others met.
#[derive(Clone, Debug, Serialize)]
pub struct Reach {
    pub condition: String,
    /// What the condition bounds, at its best.
    pub value: f64,
    /// The bound that it is to have.
    pub bound: f64,
    /// Whether nothing better is possible on this grid.
    pub proved: bool,
}

impl From<fdcc::Reach> for Reach {
    fn from(it: fdcc::Reach) -> Self {
        let fdcc::Reach { condition, value, bound, is_proved } = it;
        Reach { condition, value, bound, proved: is_proved }
    }
}

impl Reach {
    /// `with all else met, `x == 1` comes to 0.25 m instead of 1 m`, and how sure that is.
    pub fn words(&self, units: &Units) -> String {
        let [value, bound] =
            [self.value, self.bound].map(|it| units.violation(&self.condition, it, 4));
        let value = if self.value == 0.0 { "0, to rounding,".into() } else { value };
        let sure = match self.proved {
            true => "proved: no more is possible on this grid",
            false => "the best near the guess",
        };
        format!(
            "with all else met, `{}` comes to {value} instead of {bound} ({sure})",
            self.condition
        )
    }
}
