//! Intervals: sets `[lower, upper]` of real numbers, infinite ends allowed, for proofs about
//! expressions.
//!
//! Every operation rounds outwards, so an interval contains every value that its operands can give;
//! a sign read off it is proved. An operand outside the domain of a function gives no value; an
//! interval with nothing in it is [`Interval::EMPTY`].

mod functions;
mod narrow;
mod prove;
mod range;
mod signs;

pub(crate) use functions::apply;
pub(crate) use prove::{Claim, Prover};
pub(crate) use range::Tape;
pub(crate) use signs::{Signs, signs};

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::{Add, Div, Mul, Neg};

/// All numbers between two ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub lower: f64,
    /// Upper end.
    pub upper: f64,
}

const NOT_NEGATIVE: Interval = Interval { lower: 0.0, upper: f64::INFINITY };

/// How far the functions of the standard library may be off, in units in the last place.
const LIBRARY: u32 = 4;

impl Interval {
    /// Everything.
    pub const ALL: Interval = Interval { lower: f64::NEG_INFINITY, upper: f64::INFINITY };
    /// Nothing.
    pub const EMPTY: Interval = Interval { lower: f64::INFINITY, upper: f64::NEG_INFINITY };

    /// Between two numbers; everything if one of them is unknown.
    pub fn new(lower: f64, upper: f64) -> Self {
        if lower.is_nan() || upper.is_nan() { Interval::ALL } else { Interval { lower, upper } }
    }
    /// A single number.
    pub fn point(value: f64) -> Self {
        Self::new(value, value)
    }
    /// Whether nothing is in it.
    pub fn is_empty(self) -> bool {
        self.lower > self.upper
    }
    /// Whether a number is in it.
    pub fn contains(self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }
    /// Whether both ends are numbers.
    pub fn is_bounded(self) -> bool {
        self.lower.is_finite() && self.upper.is_finite()
    }
    /// Whether all of it lies above 0.
    pub fn is_positive(self) -> bool {
        self.lower > 0.0
    }
    /// Whether all of it lies below 0.
    pub fn is_negative(self) -> bool {
        self.upper < 0.0
    }
    /// What is in both.
    pub fn intersect(self, other: Interval) -> Interval {
        Interval { lower: self.lower.max(other.lower), upper: self.upper.min(other.upper) }
    }
    /// The smallest interval around both.
    pub fn hull(self, other: Interval) -> Interval {
        Interval { lower: self.lower.min(other.lower), upper: self.upper.max(other.upper) }
    }
    /// A number inside it that cuts it in two: the middle, or a power of two where it has no end.
    pub fn middle(self) -> f64 {
        match (self.lower.is_finite(), self.upper.is_finite()) {
            (true, true) => self.lower + 0.5 * (self.upper - self.lower),
            (true, false) => beyond(self.lower),
            (false, true) => -beyond(-self.upper),
            (false, false) => 0.0,
        }
    }

    /// The square, which is never negative.
    pub fn square(self) -> Interval {
        let square = self.abs() * self.abs();
        Interval { lower: square.lower.max(0.0), ..square }
    }
    /// The square root of what is not negative in it.
    pub fn square_root(self) -> Interval {
        let root = self.intersect(NOT_NEGATIVE).grow(f64::sqrt);
        Interval { lower: root.lower.max(0.0), ..root }
    }
    /// The logarithm of what is not negative in it.
    pub fn logarithm(self) -> Interval {
        self.intersect(NOT_NEGATIVE).grow(f64::ln)
    }
    /// The absolute value.
    pub fn abs(self) -> Interval {
        match self {
            _ if self.lower >= 0.0 || self.is_empty() => self,
            _ if self.upper <= 0.0 => -self,
            _ => Interval { lower: 0.0, upper: self.upper.max(-self.lower) },
        }
    }
    /// The image of a function that grows, with rounding of the library.
    pub(crate) fn grow(self, function: fn(f64) -> f64) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        outward(function(self.lower), function(self.upper), LIBRARY)
    }
    /// `cos` of all of it: the ends, and the turning points between them.
    pub(crate) fn cosine(self) -> Interval {
        if self.is_empty() {
            return Interval::EMPTY;
        }
        // Beyond this size the place within a turn is not known well enough.
        let far = self.lower.abs().max(self.upper.abs()) > 1e9;
        if far || self.upper - self.lower >= 2.0 * PI {
            return Interval { lower: -1.0, upper: 1.0 };
        }
        let ends = outward_both(self.lower.cos(), self.upper.cos());
        let turns = |offset: f64| {
            let slack = 1e-6;
            let first = ((self.lower - slack - offset) / (2.0 * PI)).ceil();
            first * 2.0 * PI + offset <= self.upper + slack
        };
        Interval {
            lower: if turns(PI) { -1.0 } else { ends.lower.max(-1.0) },
            upper: if turns(0.0) { 1.0 } else { ends.upper.min(1.0) },
        }
    }
    /// `sin` of all of it.
    pub(crate) fn sine(self) -> Interval {
        (self + outward(-FRAC_PI_2, -FRAC_PI_2, 1)).cosine()
    }
}

/// The sum.
impl Add for Interval {
    type Output = Interval;

    fn add(self, other: Interval) -> Interval {
        outward(self.lower + other.lower, self.upper + other.upper, 1)
    }
}

/// The negative.
impl Neg for Interval {
    type Output = Interval;

    fn neg(self) -> Interval {
        Interval { lower: -self.upper, upper: -self.lower }
    }
}

/// The product; 0 times a missing end is 0.
impl Mul for Interval {
    type Output = Interval;

    fn mul(self, other: Interval) -> Interval {
        if self.is_empty() || other.is_empty() {
            return Interval::EMPTY;
        }
        let ends = [
            product(self.lower, other.lower),
            product(self.lower, other.upper),
            product(self.upper, other.lower),
            product(self.upper, other.upper),
        ];
        around(&ends, 1)
    }
}

/// The quotient; a divisor around 0 gives everything, 0 at one of its ends one infinite end.
impl Div for Interval {
    type Output = Interval;

    fn div(self, other: Interval) -> Interval {
        match other {
            _ if self.is_empty() || other.is_empty() || other == Interval::point(0.0) => {
                Interval::EMPTY
            }
            _ if other.lower < 0.0 && other.upper > 0.0 => Interval::ALL,
            _ => self * reciprocal(other),
        }
    }
}

/// Twice as far, at least 1.
fn beyond(end: f64) -> f64 {
    if end < 0.0 { 0.0 } else { (2.0 * end).max(1.0) }
}

fn reciprocal(divisor: Interval) -> Interval {
    let end = |end: f64, at_zero: f64| if end == 0.0 { at_zero } else { 1.0 / end };
    if divisor.lower >= 0.0 {
        outward(end(divisor.upper, f64::INFINITY), end(divisor.lower, f64::INFINITY), 1)
    } else {
        outward(end(divisor.upper, f64::NEG_INFINITY), end(divisor.lower, f64::NEG_INFINITY), 1)
    }
}

fn product(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

fn outward_both(a: f64, b: f64) -> Interval {
    outward(a.min(b), a.max(b), LIBRARY)
}

/// The smallest interval around some numbers, widened.
fn around(values: &[f64], steps: u32) -> Interval {
    let lower = values.iter().copied().fold(f64::INFINITY, f64::min);
    let upper = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    outward(lower, upper, steps)
}

/// Widened by some units in the last place; 0 is exact wherever it comes out, but for underflow,
/// which is not a proof of anything here.
fn outward(lower: f64, upper: f64, steps: u32) -> Interval {
    if lower.is_nan() || upper.is_nan() {
        return Interval::ALL;
    }
    let down = (0..steps).fold(lower, |end, _| if end == 0.0 { end } else { end.next_down() });
    let up = (0..steps).fold(upper, |end, _| if end == 0.0 { end } else { end.next_up() });
    Interval { lower: down, upper: up }
}
