//! One number of each of four neighbouring intervals, which share a register of machines with fused
//! multiply-add.

/// One number of each of several neighbouring intervals.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Lanes(pub(crate) [f64; Lanes::COUNT]);

impl Lanes {
    /// So many numbers share a register of machines with fused multiply-add.
    pub(crate) const COUNT: usize = 4;
    pub(crate) const ZERO: Lanes = Lanes([0.0; Lanes::COUNT]);
    pub(crate) const ONE: Lanes = Lanes([1.0; Lanes::COUNT]);

    /// One number for each interval, by its number.
    #[inline(always)]
    pub(crate) fn from(value: impl Fn(usize) -> f64) -> Self {
        let mut lanes = Lanes::ZERO;
        for l in 0..Lanes::COUNT {
            lanes.0[l] = value(l);
        }
        lanes
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, other: Lanes) {
        for l in 0..Lanes::COUNT {
            self.0[l] += other.0[l];
        }
    }

    #[inline(always)]
    pub(crate) fn times(self, other: Lanes) -> Lanes {
        Lanes::from(|l| self.0[l] * other.0[l])
    }

    #[inline(always)]
    pub(crate) fn scaled(self, by: f64) -> Lanes {
        Lanes::from(|l| by * self.0[l])
    }

    /// `a b + c`
    #[inline(always)]
    pub(crate) fn multiply_add<const FUSED: bool>(a: Lanes, b: Lanes, c: Lanes) -> Lanes {
        Lanes::from(|l| multiply_add::<FUSED>(a.0[l], b.0[l], c.0[l]))
    }

    /// Whether some number is larger in size than that of the same interval.
    #[inline(always)]
    pub(crate) fn exceeds(self, other: Lanes) -> bool {
        let mut exceeds = false;
        for l in 0..Lanes::COUNT {
            exceeds |= self.0[l].abs() > other.0[l].abs();
        }
        exceeds
    }

    /// Whether all are one.
    #[inline(always)]
    pub(crate) fn are_one(self) -> bool {
        let mut bits = 0;
        for l in 0..Lanes::COUNT {
            bits |= self.0[l].to_bits() ^ 1.0f64.to_bits();
        }
        bits == 0
    }

    #[inline(always)]
    pub(crate) fn are_finite(self) -> bool {
        self.scaled(0.0).is_nothing()
    }

    /// Whether all are zero.
    #[inline(always)]
    pub(crate) fn is_nothing(self) -> bool {
        let mut bits = 0;
        for l in 0..Lanes::COUNT {
            bits |= self.0[l].abs().to_bits();
        }
        bits == 0
    }

    #[inline(always)]
    pub(crate) fn inverse(self) -> Lanes {
        Lanes::from(|l| 1.0 / self.0[l])
    }
}

/// Gives each interval its numbers, one after the other; `targets` has as many stretches of the
/// length of `source` as there are intervals.
#[inline(always)]
pub(crate) fn part(source: &[Lanes], targets: &mut [f64]) {
    match targets.len() / source.len().max(1) {
        Lanes::COUNT => part_among(Lanes::COUNT, source, targets),
        count => part_among(count, source, targets),
    }
}

#[inline(always)]
fn part_among(count: usize, source: &[Lanes], targets: &mut [f64]) {
    let length = source.len();
    let targets = &mut targets[..count * length];
    for i in 0..length {
        for l in 0..count {
            targets[l * length + i] = source[i].0[l];
        }
    }
}

/// `a b + c`. `FUSED` says that the machine does it in one instruction; without one `mul_add` would
/// be a call.
#[inline(always)]
pub(crate) fn multiply_add<const FUSED: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

/// Whether this machine has registers of four numbers and multiplies and adds in one instruction;
/// with the feature `portable` it counts as if it had not.
pub fn is_fused() -> bool {
    #[cfg(all(target_arch = "x86_64", not(feature = "portable")))]
    return std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma");
    #[cfg(any(not(target_arch = "x86_64"), feature = "portable"))]
    false
}
