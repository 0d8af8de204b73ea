//! How far a condition can be met where nothing feasible was found, as data and in words.

use super::units::Units;
use serde::Serialize;

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
