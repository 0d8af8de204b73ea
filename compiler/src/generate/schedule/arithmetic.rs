//! What formulas are made of. They are written once, and carried out in two ways that give the same
//! bits: as machine code (`cranelift/pairs.rs`), and at once (`steps.rs`).

use super::elementary;
use crate::expressions::graph::builtins::{Builtin, Inline, Lowering};

/// Arithmetic on numbers, masks of them and their bits.
pub(crate) trait Arithmetic {
    /// A number at each of a few neighbouring points; also a mask or bits in the place of one.
    type Number: Copy;

    fn number(&mut self, value: f64) -> Self::Number;
    fn add(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    fn subtract(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    fn multiply(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    fn divide(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    fn negate(&mut self, a: Self::Number) -> Self::Number;
    fn absolute(&mut self, a: Self::Number) -> Self::Number;
    fn square_root(&mut self, a: Self::Number) -> Self::Number;
    /// a b + c, with one rounding if the machine can.
    fn multiply_add(&mut self, a: Self::Number, b: Self::Number, c: Self::Number) -> Self::Number;

    /// Mask of a <= b; false where one is not a number.
    fn less_or_equal(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    /// Mask of where `a` is not a number.
    fn is_nan(&mut self, a: Self::Number) -> Self::Number;
    fn select(&mut self, mask: Self::Number, yes: Self::Number, no: Self::Number) -> Self::Number;

    /// Mask of where a bit of `a` is 0.
    fn bit_is_clear(&mut self, a: Self::Number, bit: u32) -> Self::Number;
    /// -a where a bit of `bits` is 1.
    fn negate_if_bit(&mut self, a: Self::Number, bits: Self::Number, bit: u32) -> Self::Number;
    /// The magnitude of `a` (not negative) with the sign of `b`.
    fn copy_sign(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;
    /// `a` read as whole numbers, plus a whole number.
    fn add_to_bits(&mut self, a: Self::Number, number: u64) -> Self::Number;
    /// 2^k for the whole number k in the last bits of `a`.
    fn power_of_two(&mut self, a: Self::Number) -> Self::Number;

    /// `fast` if `mask` holds at both points of a pair, else what `slow` computes.
    fn guard<const N: usize>(
        &mut self,
        mask: Self::Number,
        fast: [Self::Number; N],
        slow: impl Fn(&mut Self) -> [Self::Number; N],
    ) -> [Self::Number; N];
    /// A function of the library, point by point.
    fn call1(
        &mut self,
        name: &'static str,
        function: extern "C" fn(f64) -> f64,
        a: Self::Number,
    ) -> Self::Number;
    /// The same with two operands.
    fn call2(
        &mut self,
        name: &'static str,
        function: extern "C" fn(f64, f64) -> f64,
        operands: [Self::Number; 2],
    ) -> Self::Number;

    /// a b - c
    fn multiply_subtract(
        &mut self,
        a: Self::Number,
        b: Self::Number,
        c: Self::Number,
    ) -> Self::Number {
        let minus = self.negate(c);
        self.multiply_add(a, b, minus)
    }
    /// c - a b
    fn subtract_product(
        &mut self,
        a: Self::Number,
        b: Self::Number,
        c: Self::Number,
    ) -> Self::Number {
        let minus = self.negate(a);
        self.multiply_add(minus, b, c)
    }
}

/// A builtin of these operands.
pub(crate) fn call<A: Arithmetic>(
    on: &mut A,
    builtin: Builtin,
    operands: &[A::Number],
) -> A::Number {
    let row = builtin.row();
    match row.lowering {
        Lowering::Inline(inline) => instructions(on, inline, operands),
        Lowering::Call1(function) => on.call1(row.name, function, operands[0]),
        Lowering::Call2(function) => on.call2(row.name, function, [operands[0], operands[1]]),
    }
}

fn instructions<A: Arithmetic>(on: &mut A, inline: Inline, a: &[A::Number]) -> A::Number {
    match inline {
        Inline::Add => on.add(a[0], a[1]),
        Inline::Sub => on.subtract(a[0], a[1]),
        Inline::Mul => on.multiply(a[0], a[1]),
        Inline::Div => on.divide(a[0], a[1]),
        Inline::Neg => on.negate(a[0]),
        Inline::Sqrt => on.square_root(a[0]),
        Inline::Abs => on.absolute(a[0]),
        Inline::Min => extremum(on, a[0], a[1], [a[0], a[1]]),
        Inline::Max => extremum(on, a[0], a[1], [a[1], a[0]]),
        Inline::SelectLe => {
            let mask = on.less_or_equal(a[0], a[1]);
            on.select(mask, a[2], a[3])
        }
        Inline::Sin => elementary::sine_and_cosine(on, a[0])[0],
        Inline::Cos => elementary::sine_and_cosine(on, a[0])[1],
        Inline::Exp => elementary::exponential(on, a[0]),
        Inline::Tanh => elementary::hyperbolic_tangent(on, a[0]),
    }
}

/// `a` if the first of `order` is at most the second, else `b`; but what is not a number goes
/// through.
fn extremum<A: Arithmetic>(
    on: &mut A,
    a: A::Number,
    b: A::Number,
    order: [A::Number; 2],
) -> A::Number {
    let first = on.less_or_equal(order[0], order[1]);
    let chosen = on.select(first, a, b);
    let undefined = on.is_nan(a);
    on.select(undefined, a, chosen)
}
