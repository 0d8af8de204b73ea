//! Arithmetic of intervals, to rounding: what is compared with it allows for more.

use crate::simulate::system::Interval;

/// Everything.
pub(crate) const ALL: Interval = [f64::NEG_INFINITY, f64::INFINITY];

/// Around some numbers; everything if one of them is unknown.
pub(crate) fn around(values: &[f64]) -> Interval {
    let widened = |[low, high]: Interval, value: &f64| [low.min(*value), high.max(*value)];
    let all = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], widened);
    if values.iter().any(|value| value.is_nan()) { ALL } else { all }
}

pub(crate) fn plus(a: Interval, b: Interval) -> Interval {
    around(&[a[0] + b[0], a[1] + b[1]])
}

pub(crate) fn minus(a: Interval, b: Interval) -> Interval {
    around(&[a[0] - b[1], a[1] - b[0]])
}

/// The product; 0 times a missing end is 0.
pub(crate) fn times(a: Interval, b: Interval) -> Interval {
    let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
    around(&[product(a[0], b[0]), product(a[0], b[1]), product(a[1], b[0]), product(a[1], b[1])])
}

/// The product with a number.
pub(crate) fn scaled(factor: f64, a: Interval) -> Interval {
    times([factor, factor], a)
}

/// The quotient; everything where the divisor may be 0.
pub(crate) fn quotient(a: Interval, b: Interval) -> Interval {
    if b[0] > 0.0 || b[1] < 0.0 { times(a, [1.0 / b[1], 1.0 / b[0]]) } else { ALL }
}

/// What is in both; one of them if nothing is, which is rounding.
pub(crate) fn both(a: Interval, b: Interval) -> Interval {
    let [low, high] = [a[0].max(b[0]), a[1].min(b[1])];
    if low <= high { [low, high] } else { b }
}

/// The greatest distance from 0.
pub(crate) fn size(a: Interval) -> f64 {
    a[0].abs().max(a[1].abs())
}

/// The length of a vector.
pub(crate) fn length(vector: impl Iterator<Item = Interval>) -> Interval {
    let least =
        |a: Interval| if a[0] <= 0.0 && a[1] >= 0.0 { 0.0 } else { a[0].abs().min(a[1].abs()) };
    let squares = vector.map(|a| [least(a).powi(2), size(a).powi(2)]);
    squares.fold([0.0; 2], plus).map(f64::sqrt)
}
