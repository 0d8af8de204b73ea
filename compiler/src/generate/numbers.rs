//! Arithmetic at once, on a few points side by side. To the last bit it is that of the machine
//! code: pair by pair, with the same roundings.

use super::schedule::arithmetic::Arithmetic;

/// A number at each of some points; also a mask or bits in the place of one.
pub(super) type Block<const POINTS: usize> = [f64; POINTS];

const SIGN: u64 = 1 << 63;

/// Computes at an even number of points.
pub(super) struct Numbers<const POINTS: usize> {
    /// Whether the machine has a fused multiply-add.
    pub(super) fused: bool,
    /// The points that count, an even number of them. What the others hold does not matter.
    pub(super) points: usize,
}

impl<const POINTS: usize> Numbers<POINTS> {
    /// What neighbouring points have in a table.
    pub(super) fn read(&self, table: &[f64]) -> Block<POINTS> {
        let mut block = [0.0; POINTS];
        block[..self.points].copy_from_slice(&table[..self.points]);
        block
    }

    /// What takes long is only done where it counts.
    fn counting(&self, function: impl Fn(usize) -> f64) -> Block<POINTS> {
        each(|i| if i < self.points { function(i) } else { 0.0 })
    }
}

/// a b + c, with one rounding.
#[cfg_attr(target_arch = "x86_64", target_feature(enable = "fma"))]
fn fused<const POINTS: usize>(
    a: &Block<POINTS>,
    b: &Block<POINTS>,
    c: &Block<POINTS>,
) -> Block<POINTS> {
    each(|i| a[i].mul_add(b[i], c[i]))
}

fn mask(holds: bool) -> f64 {
    f64::from_bits(if holds { u64::MAX } else { 0 })
}

fn each<const POINTS: usize>(function: impl Fn(usize) -> f64) -> Block<POINTS> {
    std::array::from_fn(function)
}

fn each_bits<const POINTS: usize>(function: impl Fn(usize) -> u64) -> Block<POINTS> {
    std::array::from_fn(|i| f64::from_bits(function(i)))
}

fn select(mask: f64, yes: f64, no: f64) -> u64 {
    (mask.to_bits() & yes.to_bits()) | (!mask.to_bits() & no.to_bits())
}

impl<const POINTS: usize> Arithmetic for Numbers<POINTS> {
    type Number = Block<POINTS>;

    fn number(&mut self, value: f64) -> Block<POINTS> {
        [value; POINTS]
    }
    fn add(&mut self, a: Block<POINTS>, b: Block<POINTS>) -> Block<POINTS> {
        each(|i| a[i] + b[i])
    }
    fn subtract(&mut self, a: Block<POINTS>, b: Block<POINTS>) -> Block<POINTS> {
        each(|i| a[i] - b[i])
    }
    fn multiply(&mut self, a: Block<POINTS>, b: Block<POINTS>) -> Block<POINTS> {
        each(|i| a[i] * b[i])
    }
    fn divide(&mut self, a: Block<POINTS>, b: Block<POINTS>) -> Block<POINTS> {
        each(|i| a[i] / b[i])
    }
    fn negate(&mut self, a: Block<POINTS>) -> Block<POINTS> {
        each(|i| -a[i])
    }
    fn absolute(&mut self, a: Block<POINTS>) -> Block<POINTS> {
        each(|i| a[i].abs())
    }
    fn square_root(&mut self, a: Block<POINTS>) -> Block<POINTS> {
        each(|i| a[i].sqrt())
    }
    fn multiply_add(
        &mut self,
        a: Block<POINTS>,
        b: Block<POINTS>,
        c: Block<POINTS>,
    ) -> Block<POINTS> {
        if !self.fused {
            return each(|i| a[i] * b[i] + c[i]);
        }
        // SAFETY: the machine can do it.
        #[allow(unsafe_code, unused_unsafe)]
        unsafe {
            fused(&a, &b, &c)
        }
    }

    fn less_or_equal(&mut self, a: Block<POINTS>, b: Block<POINTS>) -> Block<POINTS> {
        each(|i| mask(a[i] <= b[i]))
    }
    fn is_nan(&mut self, a: Block<POINTS>) -> Block<POINTS> {
        each(|i| mask(a[i].is_nan()))
    }
    fn select(
        &mut self,
        mask: Block<POINTS>,
        yes: Block<POINTS>,
        no: Block<POINTS>,
    ) -> Block<POINTS> {
        each_bits(|i| select(mask[i], yes[i], no[i]))
    }

    fn bit_is_clear(&mut self, a: Block<POINTS>, bit: u32) -> Block<POINTS> {
        each(|i| mask(a[i].to_bits() & (1 << bit) == 0))
    }
    fn negate_if_bit(&mut self, a: Block<POINTS>, bits: Block<POINTS>, bit: u32) -> Block<POINTS> {
        each_bits(|i| a[i].to_bits() ^ ((bits[i].to_bits() << (63 - bit)) & SIGN))
    }
    fn copy_sign(&mut self, a: Block<POINTS>, b: Block<POINTS>) -> Block<POINTS> {
        each_bits(|i| a[i].to_bits() | (b[i].to_bits() & SIGN))
    }
    fn add_to_bits(&mut self, a: Block<POINTS>, number: u64) -> Block<POINTS> {
        each_bits(|i| a[i].to_bits().wrapping_add(number))
    }
    fn power_of_two(&mut self, a: Block<POINTS>) -> Block<POINTS> {
        const BIAS: u64 = 1023;
        each_bits(|i| a[i].to_bits().wrapping_add(BIAS) << 52)
    }

    fn guard<const N: usize>(
        &mut self,
        mask: Block<POINTS>,
        fast: [Block<POINTS>; N],
        slow: impl Fn(&mut Self) -> [Block<POINTS>; N],
    ) -> [Block<POINTS>; N] {
        let is_fast = |i: usize| mask[i & !1].to_bits() & mask[i | 1].to_bits() != 0;
        if (0..POINTS).all(is_fast) {
            return fast;
        }
        let slow = slow(self);
        std::array::from_fn(|which| {
            each(|i| if is_fast(i) { fast[which][i] } else { slow[which][i] })
        })
    }
    fn call1(
        &mut self,
        _: &'static str,
        function: extern "C" fn(f64) -> f64,
        a: Block<POINTS>,
    ) -> Block<POINTS> {
        self.counting(|i| function(a[i]))
    }
    fn call2(
        &mut self,
        _: &'static str,
        function: extern "C" fn(f64, f64) -> f64,
        [a, b]: [Block<POINTS>; 2],
    ) -> Block<POINTS> {
        self.counting(|i| function(a[i], b[i]))
    }
}
