//! What a problem has of each of its states, controls, parameters and surfaces.

use super::Origin;

/// `lower <= value <= upper`; infinite where there is no bound, equal for an equality.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower bound or `-inf`.
    pub lower: f64,
    /// Upper bound or `+inf`.
    pub upper: f64,
}

impl Bounds {
    /// No bounds.
    pub const FREE: Bounds = Bounds { lower: f64::NEG_INFINITY, upper: f64::INFINITY };
    /// Exactly this value.
    pub fn fixed(value: f64) -> Self {
        Bounds { lower: value, upper: value }
    }
    /// Whether only one value is allowed.
    pub fn is_equality(&self) -> bool {
        self.lower == self.upper
    }
    /// A number inside of them, as far from them as there is room, up to 1.
    pub fn inside(&self) -> f64 {
        match (self.lower.is_finite(), self.upper.is_finite()) {
            (true, true) => 0.5 * (self.lower + self.upper),
            (true, false) => self.lower + 1.0,
            (false, true) => self.upper - 1.0,
            (false, false) => 0.0,
        }
    }
    /// How far `value` is outside; 0 inside, infinite where one of the three is not a number.
    pub fn violation(&self, value: f64) -> f64 {
        if value.is_nan() || self.lower.is_nan() || self.upper.is_nan() {
            f64::INFINITY
        } else {
            (self.lower - value).max(value - self.upper).max(0.0)
        }
    }
}

/// A scalar state or control.
#[derive(Clone, Debug)]
pub struct Variable {
    /// `th`, or `pos.x` for a part.
    pub name: String,
    /// Bounds at all times.
    pub bounds: Bounds,
    /// One of its declared unit in SI, above 0; 1 where the model declares none.
    pub unit: f64,
    /// Where it is declared.
    pub origin: Origin,
    /// A running integral that was made a state; not shown to the user.
    pub hidden: bool,
}

/// One entry of `p`.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name; smoothing widths are called `sigma(SURFACE)`.
    pub name: String,
    /// Its value (for a `free` unknown, its guess).
    pub value: f64,
    /// One of its declared unit in SI, above 0; 1 where the model declares none.
    pub unit: f64,
    /// Where it is declared.
    pub origin: Origin,
}

/// A `free` unknown: an entry of `p` that the optimiser chooses.
#[derive(Clone, Debug)]
pub struct Unknown {
    /// Its place in `p`.
    pub parameter: usize,
    /// Its bounds.
    pub bounds: Bounds,
}

/// A switching surface, the zero set of output `i` of the switching functions; in a
/// [`Problem`](super::Problem) also a whole `Dir`, with `|psi|`.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Its name.
    pub name: String,
    /// Where it is declared.
    pub origin: Origin,
    /// The entry of `p` that holds its smoothing width.
    pub sigma: usize,
}

/// What a guess knows of the start of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartGuess {
    /// It was given, or follows from conditions.
    Known,
    /// Nothing; the guess is constant.
    Unknown,
    /// Nothing, but where the state ends: the guess is to go there straight.
    BeforeEnd,
}
