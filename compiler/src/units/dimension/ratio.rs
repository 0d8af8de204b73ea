//! Exponents of units: rational numbers, so that `sqrt` of a square metre is a metre.
//!
//! Everything is checked: an exponent that grows beyond all sense is `None`, and nothing is said
//! about it.

/// A fraction in lowest terms with a positive denominator.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(crate) struct Ratio {
    numerator: i32,
    denominator: i32,
}

/// No exponent in a formula has a larger denominator.
const LARGEST_DENOMINATOR: i64 = 1000;

impl Ratio {
    pub const ZERO: Ratio = Ratio { numerator: 0, denominator: 1 };
    pub const ONE: Ratio = Ratio { numerator: 1, denominator: 1 };

    /// A whole number.
    pub fn whole(value: i32) -> Self {
        Ratio { numerator: value, denominator: 1 }
    }

    /// The fraction that a decimal such as `0.5` or `1.3333333333333333` stands for, if it is a
    /// simple one.
    pub fn from_decimal(value: f64) -> Option<Self> {
        let fits = |denominator: &i64| {
            let scaled = value * *denominator as f64;
            (scaled - scaled.round()).abs() <= 1e-9 * scaled.abs().max(1.0)
        };
        let denominator = (1..=LARGEST_DENOMINATOR).find(fits)?;
        Ratio::reduced((value * denominator as f64).round() as i64, denominator)
    }

    fn reduced(numerator: i64, denominator: i64) -> Option<Self> {
        let divisor = greatest_common_divisor(numerator, denominator) * denominator.signum();
        let (numerator, denominator) =
            (numerator.checked_div(divisor)?, denominator.checked_div(divisor)?);
        Some(Ratio {
            numerator: numerator.try_into().ok()?,
            denominator: denominator.try_into().ok()?,
        })
    }

    pub fn plus(self, other: Ratio) -> Option<Self> {
        let [a, b] = [self, other].map(|it| (i64::from(it.numerator), i64::from(it.denominator)));
        Ratio::reduced((a.0 * b.1).checked_add(b.0 * a.1)?, a.1 * b.1)
    }

    pub fn times(self, other: Ratio) -> Option<Self> {
        let product = |a: i32, b: i32| i64::from(a) * i64::from(b);
        Ratio::reduced(
            product(self.numerator, other.numerator),
            product(self.denominator, other.denominator),
        )
    }

    pub fn over(self, other: Ratio) -> Option<Self> {
        let turned = Ratio::reduced(i64::from(other.denominator), i64::from(other.numerator))?;
        self.times(turned)
    }

    pub fn negative(self) -> Option<Self> {
        self.times(Ratio::whole(-1))
    }

    pub fn as_whole(self) -> Option<i32> {
        (self.denominator == 1).then_some(self.numerator)
    }

    pub fn value(self) -> f64 {
        f64::from(self.numerator) / f64::from(self.denominator)
    }

    pub fn is_zero(self) -> bool {
        self.numerator == 0
    }

    pub fn is_negative(self) -> bool {
        self.numerator < 0
    }
}

/// As a power after `^`: `2`, `(1/2)`.
impl std::fmt::Display for Ratio {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.denominator {
            1 => write!(f, "{}", self.numerator),
            denominator => write!(f, "({}/{denominator})", self.numerator),
        }
    }
}

fn greatest_common_divisor(a: i64, b: i64) -> i64 {
    let (mut a, mut b) = (a.unsigned_abs(), b.unsigned_abs());
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_the_fractions_they_stand_for() {
        let cases =
            [(0.5, "(1/2)"), (-1.5, "(-3/2)"), (1.0 / 3.0, "(1/3)"), (2.0, "2"), (0.0, "0")];
        for (decimal, expected) in cases {
            assert_eq!(Ratio::from_decimal(decimal).expect("a simple one").to_string(), expected);
        }
        assert_eq!(Ratio::from_decimal(std::f64::consts::PI), None);
    }

    #[test]
    fn exponents_that_grow_beyond_all_sense_are_given_up() {
        let large = Ratio::whole(i32::MAX);
        assert_eq!(large.times(large), None);
        assert_eq!(large.plus(Ratio::ONE), None);
        assert_eq!(Ratio::ONE.over(Ratio::ZERO), None);
    }
}
