//! The builtins on intervals. `pow` needs a positive base, `sqrt` and `log` see only their domain.

use super::{Interval, NOT_NEGATIVE};
use crate::expressions::graph::builtins::Builtin;
use std::f64::consts::{FRAC_PI_2, PI};

/// All values of a builtin for operands in intervals.
pub(crate) fn apply(builtin: Builtin, operands: &[Interval]) -> Interval {
    if operands.iter().any(|it| it.is_empty()) {
        return Interval::EMPTY;
    }
    let a = operands[0];
    match builtin {
        Builtin::Add => a + operands[1],
        Builtin::Sub => a + -operands[1],
        Builtin::Mul => a * operands[1],
        Builtin::Div => a / operands[1],
        Builtin::Neg => -a,
        Builtin::Pow => power(a, operands[1]),
        Builtin::Sqrt => a.square_root(),
        Builtin::Exp => at_least(0.0, a.grow(f64::exp)),
        Builtin::Log => a.logarithm(),
        Builtin::Sin => a.sine(),
        Builtin::Cos => a.cosine(),
        Builtin::Tan => tangent(a),
        Builtin::Asin => a.intersect(UNIT).grow(f64::asin),
        Builtin::Acos => (-a.intersect(UNIT)).grow(|x| (-x).acos()),
        Builtin::Atan => a.grow(f64::atan),
        Builtin::Atan2 => angle(a, operands[1]),
        Builtin::Sinh => a.grow(f64::sinh),
        Builtin::Cosh => at_least(1.0, a.abs().grow(f64::cosh)),
        Builtin::Tanh => a.grow(f64::tanh).intersect(UNIT),
        Builtin::LogCosh => at_least(0.0, a.abs().grow(|x| (Builtin::LogCosh.row().value)(&[x]))),
        Builtin::Abs => a.abs(),
        Builtin::Min => Interval {
            lower: a.lower.min(operands[1].lower),
            upper: a.upper.min(operands[1].upper),
        },
        Builtin::Max => Interval {
            lower: a.lower.max(operands[1].lower),
            upper: a.upper.max(operands[1].upper),
        },
        Builtin::SelectLe => select(operands),
    }
}

/// `pi/2` is between two numbers.
const RIGHT_ANGLE: Interval = Interval { lower: FRAC_PI_2, upper: FRAC_PI_2.next_up() };
/// More than a half turn.
const ABOVE_PI: f64 = PI + 1e-9;
const UNIT: Interval = Interval { lower: -1.0, upper: 1.0 };

fn at_least(bound: f64, value: Interval) -> Interval {
    Interval { lower: value.lower.max(bound), ..value }
}

/// `exp(b log(a))`; where the base may be 0, the power of it may, too.
fn power(base: Interval, exponent: Interval) -> Interval {
    let base = base.intersect(NOT_NEGATIVE);
    if base.is_empty() {
        return base;
    }
    let logarithm = base.grow(f64::ln);
    at_least(0.0, (logarithm * exponent).grow(f64::exp))
}

/// Grows between its poles.
fn tangent(a: Interval) -> Interval {
    let turn = |end: f64| ((end + FRAC_PI_2) / PI).floor();
    let near_a_pole = |end: f64| {
        let within = (end + FRAC_PI_2) / PI;
        (within - within.round()).abs() < 1e-6
    };
    let far = a.lower.abs().max(a.upper.abs()) > 1e9;
    if far || turn(a.lower) != turn(a.upper) || near_a_pole(a.lower) || near_a_pole(a.upper) {
        return Interval::ALL;
    }
    a.grow(f64::tan)
}

/// `atan2(y, x)`: `pi/2 - atan(x/y)` above the axis, `-pi/2 - atan(x/y)` below it; everything where
/// the half line `x <= 0, y = 0` is met.
fn angle(y: Interval, x: Interval) -> Interval {
    if x.is_positive() {
        return (y / x).grow(f64::atan);
    }
    match () {
        _ if y.is_positive() => RIGHT_ANGLE + -(x / y).grow(f64::atan),
        _ if y.is_negative() => -RIGHT_ANGLE + -(x / y).grow(f64::atan),
        _ => Interval { lower: -ABOVE_PI, upper: ABOVE_PI },
    }
}

/// `select(p <= q, x, y)`: one branch where the comparison is decided, both where it is not.
fn select(operands: &[Interval]) -> Interval {
    let &[p, q, x, y] = operands else { unreachable!("a selection has four operands") };
    match () {
        _ if p.upper <= q.lower => x,
        _ if p.lower > q.upper => y,
        _ => x.hull(y),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expressions::graph::builtins::ALL;

    /// A number that walks through everything between -6 and 6 without repeating itself soon.
    fn walk(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((*state >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 12.0
    }

    #[test]
    fn every_builtin_maps_points_into_the_image_of_their_interval() {
        let mut state = 7;
        for builtin in ALL {
            for _ in 0..2000 {
                let arity = builtin.row().arity;
                let boxes: Vec<Interval> = (0..arity)
                    .map(|_| {
                        let (a, b) = (walk(&mut state), walk(&mut state));
                        Interval::new(a.min(b), a.max(b))
                    })
                    .collect();
                let point: Vec<f64> = boxes
                    .iter()
                    .map(|it| it.lower + (walk(&mut state) / 12.0 + 0.5) * (it.upper - it.lower))
                    .collect();
                let value = (builtin.row().value)(&point);
                let image = apply(*builtin, &boxes);
                let fine = !builtin.row().domain.contains(&point)
                    || !value.is_finite()
                    || image.contains(value);
                assert!(fine, "{} at {point:?} is {value}, not in {image:?}", builtin.row().name);
            }
        }
    }

    #[test]
    fn the_ends_of_turning_functions_are_found() {
        let image = |builtin, lower, upper| apply(builtin, &[Interval::new(lower, upper)]);
        assert_eq!(image(Builtin::Cos, -1.0, 1.0).upper, 1.0);
        assert_eq!(image(Builtin::Sin, 1.0, 2.0).upper, 1.0);
        assert_eq!(image(Builtin::Cos, 3.0, 4.0).lower, -1.0);
        assert!(
            image(Builtin::Tan, 1.0, 2.0) == Interval::ALL
                && image(Builtin::Tan, -1.0, 1.0).is_bounded()
        );
    }

    #[test]
    fn missing_ends_and_zeros_give_what_they_must() {
        let half = Interval::new(0.0, f64::INFINITY);
        assert_eq!(half * Interval::point(0.0), Interval::point(0.0));
        assert_eq!((Interval::point(1.0) / half).lower, 0.0);
        assert_eq!(Interval::point(1.0) / Interval::new(-1.0, 1.0), Interval::ALL);
        assert!(Interval::ALL.square().lower == 0.0);
    }
}
