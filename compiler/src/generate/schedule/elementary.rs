//! Sine, cosine, exponential and hyperbolic tangent, written out for neighbouring points.
//!
//! Cody and Waite: subtract the nearest multiple of a constant that is held in several parts, then
//! a polynomial on the small rest. Errors, tested against the standard library: at most 2 units in
//! the last place for `exp`, 2 (and 1e-30) for `sin` and `cos`, 4 for `tanh`. Arguments too large
//! for that go to the standard library.

use super::arithmetic::Arithmetic;

/// 1.5 * 2^52: adding it rounds to a whole number, which then stands in the last bits.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// pi/2 in parts of 33 bits, the last one full: whole multiples up to 2^20 of the first two are
/// exact (fdlibm).
const HALF_PI: [f64; 3] = [
    f64::from_bits(0x3FF9_21FB_5440_0000),
    f64::from_bits(0x3DD0_B461_1A60_0000),
    2.022_266_248_795_950_6e-21,
];
const LARGEST_ANGLE: f64 = 1_048_576.0;

#[allow(clippy::excessive_precision)] // as published
/// sin(r) = r + r^3 (S1 + S2 r^2 + ...) for |r| <= pi/4 (fdlibm, k_sin.c: error below 2^-58).
const SINE: [f64; 6] = [
    -1.666_666_666_666_663_243_48e-1,
    8.333_333_333_322_489_461_24e-3,
    -1.984_126_982_985_794_931_34e-4,
    2.755_731_370_707_006_767_89e-6,
    -2.505_076_025_340_686_341_95e-8,
    1.589_690_995_211_550_102_21e-10,
];
#[allow(clippy::excessive_precision)] // as published
/// cos(r) = 1 - r^2/2 + r^4 (C1 + C2 r^2 + ...) for |r| <= pi/4 (fdlibm, k_cos.c: error below
/// 2^-58).
const COSINE: [f64; 6] = [
    4.166_666_666_666_660_190_37e-2,
    -1.388_888_888_887_410_957_49e-3,
    2.480_158_728_947_672_941_78e-5,
    -2.755_731_435_139_066_330_35e-7,
    2.087_572_321_298_174_827_90e-9,
    -1.135_964_755_778_819_482_65e-11,
];

#[allow(clippy::excessive_precision)] // as published
/// log(2) in two parts: whole multiples up to 2^20 of the first are exact (fdlibm, e_exp.c).
const LN_2: [f64; 2] = [6.931_471_803_691_238_164_90e-1, 1.908_214_929_270_587_700_02e-10];
/// Beyond, `exp` is not a normal number.
const LARGEST_EXPONENT: f64 = 708.0;
/// Beyond, `tanh` rounds to 1.
const LARGEST_TANGENT: f64 = 20.0;

/// (exp(r) - 1 - r) / r^2 = 1/2! + r/3! + ...: for |r| <= log(2)/2 the rest after r^13/13! is below
/// 2^-57.
const EXPONENTIAL: [f64; 12] = [
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
    1.0 / 6_227_020_800.0,
];

type Called = (&'static str, extern "C" fn(f64) -> f64);

/// What is called for large arguments.
pub(crate) const LIBRARY: [Called; 3] = [SIN, COS, EXP];
const SIN: Called = ("sin", library_sin);
const COS: Called = ("cos", library_cos);
const EXP: Called = ("exp", library_exp);

extern "C" fn library_sin(x: f64) -> f64 {
    x.sin()
}
extern "C" fn library_cos(x: f64) -> f64 {
    x.cos()
}
extern "C" fn library_exp(x: f64) -> f64 {
    x.exp()
}

/// Sine and cosine of the same angle: each is needed for the other's derivative anyway.
///
/// With q = round(2 x / pi) and r = x - q pi/2, the values are those of r, exchanged if q is odd,
/// and negated if bit 1 of q (sine) or of q + 1 (cosine) is set.
pub(crate) fn sine_and_cosine<A: Arithmetic>(on: &mut A, x: A::Number) -> [A::Number; 2] {
    let (quotient, r) = reduce(on, x, std::f64::consts::FRAC_2_PI, &HALF_PI);
    let square = on.multiply(r, r);
    let sine = small_sine(on, r, square);
    let cosine = small_cosine(on, square);
    let even = on.bit_is_clear(quotient, 0);
    let (first, second) = (on.select(even, sine, cosine), on.select(even, cosine, sine));
    let next = on.add_to_bits(quotient, 1);
    let fast = [on.negate_if_bit(first, quotient, 1), on.negate_if_bit(second, next, 1)];
    let magnitude = on.absolute(x);
    let limit = on.number(LARGEST_ANGLE);
    let within = on.less_or_equal(magnitude, limit);
    on.guard(within, fast, |on| [on.call1(SIN.0, SIN.1, x), on.call1(COS.0, COS.1, x)])
}

fn small_sine<A: Arithmetic>(on: &mut A, r: A::Number, square: A::Number) -> A::Number {
    let polynomial = horner(on, square, &SINE);
    let cube = on.multiply(square, r);
    on.multiply_add(cube, polynomial, r)
}

fn small_cosine<A: Arithmetic>(on: &mut A, square: A::Number) -> A::Number {
    let polynomial = horner(on, square, &COSINE);
    let (minus_half, one) = (on.number(-0.5), on.number(1.0));
    let parabola = on.multiply_add(square, minus_half, one);
    let fourth = on.multiply(square, square);
    on.multiply_add(fourth, polynomial, parabola)
}

/// exp(x) = 2^k exp(r) with k = round(x / log 2), r = x - k log 2.
pub(crate) fn exponential<A: Arithmetic>(on: &mut A, x: A::Number) -> A::Number {
    let (k, r) = reduce(on, x, std::f64::consts::LOG2_E, &LN_2);
    let power = on.power_of_two(k);
    let small = small_exponential_minus_one(on, r);
    let fast = on.multiply_add(power, small, power);
    let magnitude = on.absolute(x);
    let limit = on.number(LARGEST_EXPONENT);
    let within = on.less_or_equal(magnitude, limit);
    let [exponential] = on.guard(within, [fast], |on| [on.call1(EXP.0, EXP.1, x)]);
    exponential
}

/// tanh(|x|) = e / (e + 2) with e = exp(2 |x|) - 1 = 2^k (exp(r) - 1) + (2^k - 1), without
/// cancellation.
pub(crate) fn hyperbolic_tangent<A: Arithmetic>(on: &mut A, x: A::Number) -> A::Number {
    let magnitude = on.absolute(x);
    let limit = on.number(LARGEST_TANGENT);
    // A NaN is not beyond the limit, and so goes through.
    let beyond = on.less_or_equal(limit, magnitude);
    let clamped = on.select(beyond, limit, magnitude);
    let doubled = on.add(clamped, clamped);
    let (k, r) = reduce(on, doubled, std::f64::consts::LOG2_E, &LN_2);
    let power = on.power_of_two(k);
    let (one, two) = (on.number(1.0), on.number(2.0));
    let whole = on.subtract(power, one);
    let small = small_exponential_minus_one(on, r);
    let e = on.multiply_add(power, small, whole);
    let denominator = on.add(e, two);
    let positive = on.divide(e, denominator);
    on.copy_sign(positive, x)
}

/// exp(r) - 1 = r + r^2 (1/2! + r/3! + ...).
fn small_exponential_minus_one<A: Arithmetic>(on: &mut A, r: A::Number) -> A::Number {
    let polynomial = horner(on, r, &EXPONENTIAL);
    let square = on.multiply(r, r);
    on.multiply_add(square, polynomial, r)
}

/// The nearest whole multiple (in the last bits of the first result) and what remains of `x`.
fn reduce<A: Arithmetic>(
    on: &mut A,
    x: A::Number,
    inverse: f64,
    parts: &[f64],
) -> (A::Number, A::Number) {
    let (inverse, rounder) = (on.number(inverse), on.number(ROUNDER));
    let shifted = on.multiply_add(x, inverse, rounder);
    let multiple = on.subtract(shifted, rounder);
    let rest = parts.iter().fold(x, |rest, &part| {
        let part = on.number(part);
        on.subtract_product(multiple, part, rest)
    });
    (shifted, rest)
}

/// c0 + c1 x + c2 x^2 + ...
fn horner<A: Arithmetic>(on: &mut A, x: A::Number, coefficients: &[f64]) -> A::Number {
    let (last, others) = coefficients.split_last().expect("a polynomial has a coefficient");
    let last = on.number(*last);
    others.iter().rev().fold(last, |sum, &coefficient| {
        let coefficient = on.number(coefficient);
        on.multiply_add(sum, x, coefficient)
    })
}
